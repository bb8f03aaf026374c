#include "client/watch_command.hpp"

#include "cli/signals.hpp"
#include "cli/wall_time.hpp"
#include "client/watch_text.hpp"
#include "daemon/wall_clock.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <limits>
#include <poll.h>

namespace linefeed::client {

namespace {

constexpr std::size_t max_events = 100;

/// The terminal's second page, without cursor; given back at the end.
class FullScreen {
public:
    explicit FullScreen(bool wanted)
        : wanted_(wanted) {
        show(wanted_ ? "\033[?1049h\033[?25l" : "");
    }
    ~FullScreen() { show(wanted_ ? "\033[?25h\033[?1049l" : ""); }
    FullScreen(const FullScreen&) = delete;
    FullScreen& operator=(const FullScreen&) = delete;

    /// Draws over what is there, so that nothing flickers.
    static void draw(const std::string& text) {
        std::string out = "\033[H";
        for (const char c : text) {
            out += c == '\n' ? std::string{"\033[K\r\n"} : std::string(1, c);
        }
        show(out + "\033[K\033[J");
    }

private:
    bool wanted_;
};

/// Flow: construct, run().
class Watch {
public:
    Watch(const Service& service, const WatchOptions& options)
        : service_(service.impatient())
        , options_(options) {}

    Result<ExitCode> run();

private:
    Result<void> look();
    Result<void> look_at_events();
    void show_picture(const Screen& screen);
    void tell_trouble();
    void show_changes();
    bool sleep();

    Service service_;
    const WatchOptions& options_;
    cli::SignalWatch signals_;
    WatchPicture picture_;
    std::optional<std::uint64_t> last_event_;
    std::vector<std::string> shown_; ///< lines, without a terminal
    bool told_ = false;              ///< that the service is away
};

Result<void> Watch::look_at_events() {
    if (!last_event_) {
        const auto page = service_.get("/api/v1/events?limit=1");
        if (!page) {
            return page.error();
        }
        const auto newest = static_cast<std::uint64_t>(std::max<std::int64_t>(0, number(*page, "last_id")));
        last_event_ = newest - std::min<std::uint64_t>(newest, max_events);
    }
    return service_.each("/api/v1/events?limit=1000&after=" + std::to_string(*last_event_), [&](const Json& event) {
        last_event_ =
            std::max(*last_event_, static_cast<std::uint64_t>(std::max<std::int64_t>(0, number(event, "id"))));
        picture_.events.push_back(event);
        if (picture_.events.size() > max_events) {
            picture_.events.pop_front();
        }
        return true;
    });
}

/// Everything new, or the old picture and why it is old.
Result<void> Watch::look() {
    auto printers = service_.list("/api/v1/printers", std::numeric_limits<std::size_t>::max());
    if (!printers) {
        return printers.error();
    }
    std::map<std::int64_t, Json> jobs;
    for (const Json& printer : *printers) {
        const auto id = whole(printer, "job");
        if (!id) {
            continue;
        }
        if (auto job = service_.get(job_path(*id))) {
            jobs.emplace(*id, std::move(*job));
        } else if (job.error().kind == FailureKind::unreachable) {
            return job.error();
        }
    }
    picture_.printers = std::move(*printers);
    picture_.jobs = std::move(jobs);
    return look_at_events();
}

void Watch::tell_trouble() {
    if (picture_.trouble.empty() == told_) {
        say(told_ ? "the service is there again" : picture_.trouble + "; waiting for it");
        told_ = !told_;
    }
}

void Watch::show_changes() {
    std::vector<std::string> lines = watch_lines(picture_);
    for (const std::string& line : lines) {
        if (std::find(shown_.begin(), shown_.end(), line) == shown_.end()) {
            show(cli::format_local_time(picture_.now_ns) + "  " + line + '\n');
        }
    }
    shown_ = std::move(lines);
}

void Watch::show_picture(const Screen& screen) {
    if (screen.columns && !options_.common.json) {
        FullScreen::draw(watch_text(picture_, screen));
        return;
    }
    tell_trouble();
    if (told_) {
        return;
    }
    if (options_.common.json) {
        show_json_line(watch_json(picture_));
    } else {
        show_changes();
    }
}

/// False when Ctrl-C has come.
bool Watch::sleep() {
    std::array<pollfd, 1> waiting{{{signals_.descriptor(), POLLIN, 0}}};
    ::poll(waiting.data(), waiting.size(), static_cast<int>(options_.interval.count()));
    return signals_.take() == 0;
}

Result<ExitCode> Watch::run() {
    picture_.service = to_string(service_.address());
    if (const auto first = look(); !first) {
        return first.error();
    }
    const FullScreen full{!options_.common.json && stdout_screen().columns.has_value()};
    do {
        picture_.now_ns = daemon::wall_clock_ns();
        show_picture(stdout_screen());
        if (!sleep()) {
            break;
        }
        const auto looked = look();
        if (!looked && looked.error().kind != FailureKind::unreachable) {
            return looked.error();
        }
        picture_.trouble = looked ? std::string{} : looked.error().message;
    } while (std::cout);
    return ExitCode::done;
}

} // namespace

ExitCode run_watch(const WatchOptions& options) {
    return run_with_service(options.common, [&](Service& service) { return Watch{service, options}.run(); });
}

} // namespace linefeed::client
