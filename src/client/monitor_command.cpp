#include "client/monitor_command.hpp"

#include "cli/signals.hpp"
#include "cli/wall_time.hpp"
#include "client/direct_printer.hpp"
#include "printer/conversation.hpp"
#include "printer/job_commands.hpp"
#include "printer/local_file.hpp"
#include "printer/message_json.hpp"
#include "protocol/profile.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <poll.h>
#include <utility>

namespace linefeed::client {

using Clock = std::chrono::steady_clock;
using printer::SpokenFrame;
using printer::Utterance;

namespace {

/// How often the service is asked what was said since.
constexpr std::chrono::milliseconds service_interval{100};

std::int64_t wall_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

void show_frame(const SpokenFrame& frame, bool json) {
    if (json) {
        show_json_line(printer::to_json(frame));
        return;
    }
    const std::string command = printer::command_of(frame.message);
    const std::string words =
        frame.whole ? printer::in_words(frame.message) : "(the beginning) " + printer::escaped_bytes(frame.raw);
    show(protocol::printable(cli::format_local_clock(frame.time_ns) + (frame.sent ? " -> " : " <- ") +
                             (command.empty() ? printer::escaped_bytes(frame.raw) : command) + "  " + words) +
         '\n');
}

/// Where what is said goes: to the screen in words, or into a file.
class Listener {
public:
    Listener(const MonitorOptions& options, protocol::EscapeMode escapes)
        : finder_(escapes)
        , json_(options.printer.common.json)
        , recording_(!options.file.empty()) {}

    /// FailureKind::usage: a file would be replaced. A pipe or a terminal is written to as it is.
    [[nodiscard]] static Result<void> check_name(const MonitorOptions& options) {
        std::error_code none;
        const bool taken = !options.file.empty() && std::filesystem::is_regular_file(options.file, none);
        return taken && !options.replace ? printer::name_taken(options.file) : Result<void>{};
    }
    /// The file is made with the first thing that is heard: a printer that is away takes nothing of what is there.
    [[nodiscard]] Result<void> hear(const Utterance& utterance, const std::filesystem::path& file) {
        ++heard_;
        if (!recording_) {
            finder_.add(utterance, [this](const SpokenFrame& frame) { show_frame(frame, json_); });
            return {};
        }
        if (!out_.is_open()) {
            out_.open(file, std::ios::binary | std::ios::trunc);
        }
        out_ << to_line(utterance) << std::endl;
        return out_.fail() ? cannot_write(file) : Result<void>{};
    }
    [[nodiscard]] std::size_t heard() const { return heard_; }
    [[nodiscard]] bool recording() const { return recording_; }

private:
    static Result<void> cannot_write(const std::filesystem::path& file) {
        return Failure{FailureKind::storage, "cannot write " + file.string() + ": " + std::strerror(errno)};
    }

    printer::FrameFinder finder_;
    std::ofstream out_;
    std::size_t heard_ = 0;
    bool json_;
    bool recording_;
};

/// Ctrl-C, or the time that was given.
class Until {
public:
    explicit Until(std::optional<std::chrono::milliseconds> duration)
        : end_(duration ? std::optional{Clock::now() + *duration} : std::nullopt) {}

    /// Waits; false when it is over.
    [[nodiscard]] bool wait(std::chrono::milliseconds time) {
        if (end_) {
            time = std::min(time, std::chrono::ceil<std::chrono::milliseconds>(*end_ - Clock::now()));
        }
        pollfd signal{signals_.descriptor(), POLLIN, 0};
        const bool signalled = ::poll(&signal, 1, std::max(0, static_cast<int>(time.count()))) > 0;
        return !signalled && !(end_ && Clock::now() >= *end_);
    }

private:
    cli::SignalWatch signals_;
    std::optional<Clock::time_point> end_;
};

/// Asks the printer for its state again and again.
Result<void> listen_to_printer(const MonitorOptions& options, Listener& listener, Until& until) {
    const auto connected = connect_directly(options.printer.printer, options.printer.direct);
    if (!connected) {
        return connected.error();
    }
    printer::PrinterClient& printer = **connected;
    Result<void> heard;
    printer.observe([&](bool sent, std::string_view bytes) {
        if (heard) {
            heard = listener.hear({wall_ns(), sent, std::string{bytes}, bytes.size()}, options.file);
        }
    });
    bool answered = false;
    std::uint64_t damaged = 0;
    do {
        const auto machine = printer.ask<protocol::MachineStatus>(protocol::Parameter::RS);
        const auto mail = printer.ask<protocol::MailStatus>(protocol::Parameter::SM);
        answered = answered || machine || mail;
        if (!printer.open()) {
            return Failure{FailureKind::unreachable, printer.settings().address + ": the connection is lost"};
        }
        if (const auto bytes =
                printer.oddities().damaged_bytes - std::exchange(damaged, printer.oddities().damaged_bytes);
            bytes > 0) {
            say("<- " + std::to_string(bytes) + " bytes that are no frame");
        }
        if (!machine && !mail) {
            say("<- no answer");
        }
    } while (heard && until.wait(options.interval));
    return answered || !heard ? heard : Failure{FailureKind::unreachable, printer.silence("?RS")};
}

std::string from_hex(std::string_view hex) {
    const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
    std::string bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
        bytes.push_back(static_cast<char>(digit(hex[i]) * 16 + digit(hex[i + 1])));
    }
    return bytes;
}

/// A frame as the service has kept it: without its CR if the printer sent it.
Utterance utterance_of(const Json& frame) {
    Utterance utterance{number(frame, "time_ns"), text(frame, "direction") == "sent", from_hex(text(frame, "hex")),
                        static_cast<std::uint64_t>(number(frame, "size"))};
    if (!utterance.bytes.ends_with('\r') && utterance.bytes.size() + 1 == utterance.size) {
        utterance.bytes.push_back('\r');
    }
    return utterance;
}

/// What the service and the printer say to each other.
Result<void> listen_to_service(Service& service, const MonitorOptions& options, Listener& listener, Until& until) {
    std::optional<std::int64_t> last;
    do {
        const auto frames = service.get(printer_path(options.printer.printer, "/frames"));
        if (!frames) {
            return frames.error();
        }
        for (const Json& frame : items(*frames)) {
            const std::int64_t id = number(frame, "id");
            if (last && id <= *last) {
                continue;
            }
            if (last && id > *last + 1) {
                say("some frames went by unseen");
            }
            last = id;
            if (auto heard = listener.hear(utterance_of(frame), options.file); !heard) {
                return heard;
            }
        }
        last = last.value_or(-1);
    } while (until.wait(service_interval));
    return {};
}

Result<std::vector<SpokenFrame>> read_recording(const ReplayOptions& options, protocol::EscapeMode escapes) {
    std::ifstream in{options.file, std::ios::binary};
    if (!in) {
        return Failure{FailureKind::input, "cannot read " + options.file.string() + ": " + std::strerror(errno)};
    }
    std::vector<SpokenFrame> frames;
    printer::FrameFinder finder{escapes};
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        const auto utterance = printer::read_line(line);
        if (!utterance) {
            return Failure{FailureKind::input, options.file.string() + ", line " + std::to_string(number) + ": " +
                                                   utterance.error().message};
        }
        finder.add(*utterance, [&frames](const SpokenFrame& frame) { frames.push_back(frame); });
    }
    return frames;
}

Result<protocol::EscapeMode> escapes_of(const PrinterOptions& options) {
    const auto profile = named_profile(options.direct);
    return profile ? Result<protocol::EscapeMode>{profile->escapes} : profile.error();
}

/// Anything but inquiries: records would be printed again.
bool changes_printer(const std::vector<SpokenFrame>& frames) {
    return std::ranges::any_of(frames, [](const SpokenFrame& frame) {
        return frame.sent && !std::holds_alternative<protocol::InquiryMessage>(frame.message);
    });
}

Result<ExitCode> replay_against(const ReplayOptions& options, const std::vector<SpokenFrame>& frames) {
    if (changes_printer(frames)) {
        const auto yes = confirm("the recording holds more than inquiries, which " + options.against +
                                     " will obey: records may be printed again. Do it",
                                 options.yes, options.printer.common.json);
        if (!yes || !*yes) {
            return yes ? Result<ExitCode>{ExitCode::stopped} : yes.error();
        }
    }
    const auto connected = connect_directly(options.against, options.printer.direct);
    if (!connected) {
        return connected.error();
    }
    if (changes_printer(frames)) {
        if (const auto stands = printer::check_not_printing(**connected); !stands) {
            return stands.error();
        }
    }
    Until until{std::nullopt};
    const auto pause = [&](Duration time) {
        if (!options.fast) {
            static_cast<void>(until.wait(std::chrono::ceil<std::chrono::milliseconds>(time)));
        }
    };
    const auto rerun = say_again(**connected, frames, pause);
    if (!rerun) {
        return rerun.error();
    }
    Json differences = Json::array();
    for (const printer::Difference& difference : rerun->differences) {
        differences.push_back(
            {{"asked", printer::escaped_bytes(difference.asked)},
             {"expected", printer::escaped_bytes(difference.expected)},
             {"got", difference.got.empty() ? Json{} : Json(printer::escaped_bytes(difference.got))}});
        if (!options.printer.common.json) {
            show(protocol::printable("asked    " + text(differences.back(), "asked")) + "\n  then " +
                 protocol::printable(text(differences.back(), "expected")) + "\n  now  " +
                 (difference.got.empty() ? "nothing" : protocol::printable(text(differences.back(), "got"))) + '\n');
        }
    }
    if (options.printer.common.json) {
        show_json({{"sent", rerun->sent}, {"compared", rerun->compared}, {"differences", std::move(differences)}});
    } else {
        show(std::to_string(rerun->sent) + " frames sent, " + std::to_string(rerun->compared) + " answers compared, " +
             std::to_string(rerun->differences.size()) + " differ\n");
    }
    return rerun->differences.empty() ? ExitCode::done : ExitCode::other;
}

} // namespace

ExitCode run_monitor(const MonitorOptions& options) {
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        const auto escapes = escapes_of(options.printer);
        if (!escapes) {
            return escapes.error();
        }
        Until until{options.duration};
        Listener listener{options, *escapes};
        if (auto named = Listener::check_name(options); !named) {
            return named.error();
        }
        Result<void> listened;
        if (is_address(options.printer.printer)) {
            listened = listen_to_printer(options, listener, until);
        } else {
            const auto place = find_service(options.printer.common.service);
            if (!place) {
                return place.error();
            }
            Service service{*place};
            listened = listen_to_service(service, options, listener, until);
        }
        if (!listened) {
            return listened.error();
        }
        if (listener.recording() && !options.printer.common.json) {
            show(std::to_string(listener.heard()) + " lines in " + protocol::printable(options.file.string()) + '\n');
        } else if (listener.recording()) {
            show_json({{"file", options.file.string()}, {"lines", listener.heard()}});
        }
        return ExitCode::done;
    });
}

ExitCode run_replay(const ReplayOptions& options) {
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        const auto escapes = escapes_of(options.printer);
        const auto frames = escapes ? read_recording(options, *escapes) : escapes.error();
        if (!frames) {
            return frames.error();
        }
        if (!options.against.empty()) {
            return replay_against(options, *frames);
        }
        Until until{std::nullopt};
        std::int64_t before_ns = frames->empty() ? 0 : frames->front().time_ns;
        for (const SpokenFrame& frame : *frames) {
            const std::chrono::nanoseconds gap{std::max<std::int64_t>(0, frame.time_ns - before_ns)};
            before_ns = frame.time_ns;
            constexpr std::chrono::hours longest{1};
            if (!options.fast && !until.wait(std::min<std::chrono::milliseconds>(
                                     longest, std::chrono::ceil<std::chrono::milliseconds>(gap)))) {
                break;
            }
            show_frame(frame, options.printer.common.json);
        }
        return ExitCode::done;
    });
}

} // namespace linefeed::client
