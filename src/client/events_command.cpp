#include "client/events_command.hpp"

#include "client/service_text.hpp"

#include <algorithm>
#include <deque>
#include <limits>

namespace linefeed::client {

namespace {

/// Flow: construct, run().
class Events {
public:
    Events(Service& service, const EventsOptions& options)
        : service_(service)
        , options_(options)
        , screen_(stdout_screen()) {}

    Result<ExitCode> run();

private:
    Result<void> show_newest();
    Result<void> show_behind(std::uint64_t after);
    Result<void> follow();
    void show_event(const Json& event);
    void tell_gap(std::uint64_t before, std::uint64_t next) const;
    [[nodiscard]] bool wanted(const Json& event) const;

    Service& service_;
    const EventsOptions& options_;
    Screen screen_;
    std::uint64_t last_id_ = 0; ///< of all that were read
};

std::uint64_t id_of(const Json& event) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(0, number(event, "id")));
}

std::string behind(std::uint64_t after) {
    return "/api/v1/events?limit=1000&after=" + std::to_string(after);
}

bool Events::wanted(const Json& event) const {
    return (options_.printer.empty() || text(event, "printer") == options_.printer) &&
           (!options_.job || whole(event, "job") == options_.job);
}

void Events::show_event(const Json& event) {
    if (options_.common.json) {
        show_json_line(event);
    } else {
        show(event_text(event, screen_));
    }
}

/// Numbers have no holes: what is missing is not kept any more. From the very first on nobody has missed anything.
void Events::tell_gap(std::uint64_t before, std::uint64_t next) const {
    if (before > 0 && next > before + 1) {
        say("the events " + std::to_string(before + 1) + " to " + std::to_string(next - 1) + " are not kept any more");
    }
}

Result<void> Events::show_behind(std::uint64_t after) {
    last_id_ = after;
    return service_.each(behind(after), [&](const Json& event) {
        tell_gap(last_id_, id_of(event));
        last_id_ = id_of(event);
        if (wanted(event)) {
            show_event(event);
        }
        return true;
    });
}

/// The newest ones that are wanted. Without a filter only those are read.
Result<void> Events::show_newest() {
    const auto page = service_.get("/api/v1/events?limit=1");
    if (!page) {
        return page.error();
    }
    const auto newest = static_cast<std::uint64_t>(std::max<std::int64_t>(0, number(*page, "last_id")));
    const bool filtered = !options_.printer.empty() || options_.job;
    last_id_ = newest;
    std::deque<Json> kept;
    const auto read = service_.each(behind(filtered || newest < options_.limit ? 0 : newest - options_.limit),
                                    [&](const Json& event) {
                                        last_id_ = std::max(last_id_, id_of(event));
                                        if (wanted(event)) {
                                            kept.push_back(event);
                                        }
                                        if (kept.size() > options_.limit) {
                                            kept.pop_front();
                                        }
                                        return true;
                                    });
    if (!read) {
        return read.error();
    }
    for (const Json& event : kept) {
        show_event(event);
    }
    return {};
}

Result<void> Events::follow() {
    bool lost = false;
    return service_.follow(
        last_id_,
        [&](const Json& event) {
            const bool missed = last_id_ > 0 && id_of(event) > last_id_ + 1;
            if (lost) {
                say(missed ? "the service is there again" : "the service is there again; nothing was missed");
                lost = false;
            }
            tell_gap(last_id_, id_of(event));
            if (id_of(event) > last_id_) { // whatever the service repeats
                last_id_ = id_of(event);
                if (wanted(event)) {
                    show_event(event);
                }
            }
            return true;
        },
        [&](const Failure& failure) {
            if (!lost) {
                say(failure.message + "; waiting for it");
            }
            lost = true;
            return true;
        });
}

Result<ExitCode> Events::run() {
    if (const auto shown = options_.after ? show_behind(*options_.after) : show_newest(); !shown) {
        return shown.error();
    }
    if (options_.follow) {
        if (const auto followed = follow(); !followed) {
            return followed.error();
        }
    }
    return ExitCode::done;
}

} // namespace

ExitCode run_events(const EventsOptions& options) {
    return run_with_service(options.common, [&](Service& service) { return Events{service, options}.run(); });
}

} // namespace linefeed::client
