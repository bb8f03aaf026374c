#include "printer/job_commands.hpp"

#include "printer/exchange.hpp"
#include "printer/file_transfer.hpp"
#include "printer/printer_path.hpp"
#include "protocol/frame.hpp"

#include <algorithm>
#include <thread>

namespace linefeed::printer {

using protocol::Message;
using protocol::Parameter;
using protocol::ScriptLine;
using Clock = std::chrono::steady_clock;
using Heard = PrinterClient::Heard;

namespace {

constexpr auto loading = std::chrono::milliseconds{150}; ///< takes no longer, says the manual
constexpr auto look_again = std::chrono::milliseconds{50};
/// With escapes a line may become twice as long.
constexpr std::size_t max_line = protocol::max_frame_bytes / 2 - 8;
constexpr std::size_t max_lines = 100'000;

/// The name that `?JL` tells when it is `path`, or after `patience`. Where the job was loaded before, the printer tells
/// its name at once: so it is given the time that loading takes.
Result<std::string> wait_for_job(PrinterClient& printer, const std::string& path, Duration patience) {
    const auto deadline = Clock::now() + patience;
    std::this_thread::sleep_for(loading);
    while (true) {
        const auto job = printer.ask<protocol::JobName>(Parameter::JL);
        if (!job) {
            return no_answer(printer, Parameter::JL);
        }
        if (same_path(job->path, path)) {
            return job->path;
        }
        if (Clock::now() >= deadline) {
            return Failure{FailureKind::stopped,
                           "the printer has not loaded " + path_text(path) + ": its job is " + path_text(job->path)};
        }
        std::this_thread::sleep_for(look_again);
    }
}

} // namespace

Result<void> check_not_printing(PrinterClient& printer) {
    const auto status = printer.ask<protocol::MachineStatus>(Parameter::RS);
    if (!status) {
        return no_answer(printer, Parameter::RS);
    }
    if (status->machine == protocol::MachineState::printing) {
        return Failure{FailureKind::stopped, printer.settings().address + ": it is print-ready: stop the line first"};
    }
    return {};
}

Result<std::string> load_job(PrinterClient& printer, const std::string& path, Duration patience) {
    if (auto checked = check_not_printing(printer); !checked) {
        return checked.error();
    }
    const auto there = list_files(printer, path);
    if (!there) {
        return there.error();
    }
    if (there->empty() || there->front().is_directory) {
        return Failure{FailureKind::input, path_text(path) + ": there is no such job"};
    }
    printer.send(Message{protocol::JobName{path}});
    return wait_for_job(printer, path, patience);
}

Result<std::vector<std::string>> read_script(PrinterClient& printer) {
    std::vector<std::string> lines;
    bool begun = false;
    const bool complete = printer.converse(printer.frame_of(protocol::InquiryMessage{Parameter::JB, {}}),
                                           [&](const Message& message, std::string_view) {
                                               const auto* const line = std::get_if<ScriptLine>(&message);
                                               if (line == nullptr) {
                                                   return Heard::ignored;
                                               }
                                               if (line->is_end()) {
                                                   return Heard::done;
                                               }
                                               if (line->is_begin()) {
                                                   begun = true;
                                                   lines.clear();
                                               } else if (lines.size() < max_lines) {
                                                   lines.push_back(line->text);
                                               }
                                               return Heard::more;
                                           });
    if (!complete) {
        return begun ? Failure{FailureKind::unreachable, printer.settings().address + ": the script ends early"}
                     : no_answer(printer, Parameter::JB);
    }
    return lines;
}

Result<std::vector<std::string>> script_lines(std::string_view text, protocol::EscapeMode escapes) {
    std::vector<std::string> lines;
    const auto refused = [](std::size_t number, const std::string& why) {
        return Failure{FailureKind::input, "line " + std::to_string(number) + " of the script " + why};
    };
    bool ended = false;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        const ScriptLine line{std::string{text.substr(0, end)}};
        text.remove_prefix(std::min(text.size(), end + (text.substr(end).starts_with("\r\n") ? 2 : 1)));
        if (line.text.empty()) {
            continue;
        }
        if (ended || (line.is_begin() && !lines.empty())) {
            return refused(number, "has no place there: one script begins and ends once");
        }
        if (line.text.size() > max_line) {
            return refused(number, "is longer than " + std::to_string(max_line) + " bytes");
        }
        if (line.text.find('\0') != std::string::npos) {
            return refused(number, "has a NUL");
        }
        if (escapes == protocol::EscapeMode::none && line.text.find_first_of("^\\") != std::string::npos) {
            return refused(number, "has ^ or \\, which firmware without escapes cannot be told");
        }
        ended = line.is_end();
        if (!line.is_begin() && !ended) {
            lines.push_back(line.text);
        }
    }
    if (lines.empty() || lines.size() > max_lines) {
        return Failure{FailureKind::input, lines.empty() ? "the script has no line" : "the script has too many lines"};
    }
    return lines;
}

namespace {

/// The name of a job that came as a script.
constexpr const char* scripted_job = "EXTERN";

/// The lines of the job that is loaded, if that came as a script too: its name will not tell the new one from it.
Result<std::vector<std::string>> script_under_that_name(PrinterClient& printer) {
    const auto job = printer.ask<protocol::JobName>(Parameter::JL);
    if (!job) {
        return no_answer(printer, Parameter::JL);
    }
    return same_path(job->path, scripted_job) ? read_script(printer) : Result<std::vector<std::string>>{};
}

} // namespace

Result<ScriptSent> send_script(PrinterClient& printer, const std::vector<std::string>& lines, Duration patience) {
    if (auto checked = check_not_printing(printer); !checked) {
        return checked.error();
    }
    const auto before = script_under_that_name(printer);
    if (!before) {
        return before.error();
    }
    bool sent = printer.send(Message{ScriptLine{"BEGINLJSCRIPT"}});
    for (const std::string& line : lines) {
        sent = sent && printer.send(Message{ScriptLine{line}});
    }
    if (!sent || !printer.send(Message{ScriptLine{"ENDLJSCRIPT"}})) {
        return Failure{FailureKind::unreachable, printer.settings().address +
                                                     ": the connection broke within the script, and the job that was "
                                                     "loaded may be gone: send it again"};
    }
    auto job = wait_for_job(printer, scripted_job, patience);
    if (!job) {
        return job.error();
    }
    const auto deadline = Clock::now() + patience;
    bool changed = false;
    while (true) {
        const auto status = printer.ask<protocol::MachineStatus>(Parameter::RS);
        changed = changed || (status && status->job_changed == true);
        const auto read_back = read_script(printer);
        if (!read_back) {
            return read_back.error();
        }
        if (*read_back == lines || *read_back != *before || changed) {
            return ScriptSent{*std::move(job), *read_back == lines};
        }
        if (Clock::now() >= deadline) {
            return Failure{FailureKind::stopped,
                           printer.settings().address +
                               ": the printer has not taken the script: " + "it still has the one that it had before"};
        }
        std::this_thread::sleep_for(look_again);
    }
}

} // namespace linefeed::printer
