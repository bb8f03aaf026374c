#include "client/start_command.hpp"

#include "cli/progress_view.hpp"
#include "client/job_text.hpp"
#include "client/job_wait.hpp"

#include <iostream>
#include <unistd.h>

namespace linefeed::client {

namespace {

using daemon::InDoubtPolicy;
using daemon::OperatorWord;

/// The job as it is now, on stdout.
Result<Json> show_job_now(Service& service, std::int64_t job, bool json) {
    auto now = service.get(job_path(job));
    if (!now) {
        return now.error();
    }
    if (json) {
        show_json(*now);
    } else {
        show(job_line(*now) + '\n');
    }
    return now;
}

/// Nothing was printed, because the printer could not be reached.
bool never_reached(Service& service, const Json& before, const Json& after) {
    if (text(after, "phase") != "stopped" || number(after, "printed") != number(before, "printed") ||
        number(after, "open") > 0) {
        return false;
    }
    const auto printer = service.get(printer_path(text(after, "printer")));
    return printer && text(*printer, "link") != "up";
}

Result<ExitCode> follow(Service& service, std::int64_t job, bool json) {
    const auto before = service.get(job_path(job));
    if (!before) {
        return before.error();
    }
    const auto end = wait_for_job(service, job, json);
    if (!end) {
        return end.error();
    }
    if (end->interrupted) {
        const std::string printer = text(end->job, "printer");
        say("job " + std::to_string(job) + " goes on without you looking: linefeed job " + std::to_string(job) +
            " shows it, linefeed stop " + printer + " stops it");
        return ExitCode::other;
    }
    if (json) {
        show_json(end->job);
    } else {
        show(job_line(end->job) + '\n');
    }
    return never_reached(service, *before, end->job) ? ExitCode::unreachable
                                                     : exit_code_of_phase(text(end->job, "phase"));
}

/// What comes of a request to start: the job's state, or why it does not start.
Result<ExitCode> after_start(Service& service, const Result<Json>& started, std::optional<std::int64_t> job,
                             const CommonOptions& common, bool wait) {
    if (!started) {
        if (started.error().kind == FailureKind::in_doubt && job && !common.json) {
            if (const auto doubt = service.get(job_path(*job, "/doubt"))) {
                show(doubt_text(*doubt, *job, stdout_screen()));
            }
        }
        return started.error();
    }
    const std::int64_t id = number(*started, "job");
    if (wait) {
        return follow(service, id, common.json);
    }
    const auto now = show_job_now(service, id, common.json);
    return now ? Result<ExitCode>{ExitCode::done} : now.error();
}

Result<void> settle(Service& service, std::int64_t job, const OperatorWord& word) {
    const auto settled = service.post(job_path(job, "/settle"), settle_request(word));
    return settled ? Result<void>{} : settled.error();
}

/// What the operator says on the terminal; absent = nothing, or there is nobody.
std::optional<OperatorWord> ask(const Json& doubt, bool json) {
    if (json || ::isatty(STDIN_FILENO) == 0 || ::isatty(STDERR_FILENO) == 0) {
        return std::nullopt;
    }
    const bool hole = !text(doubt, "hole").empty();
    std::cerr << (hole ? "Which of these records are on products? N-M,N or none (nothing = decide later): "
                       : "Which record is on the last product? Its number or text (nothing = decide later): ")
              << std::flush;
    std::string answer;
    if (!std::getline(std::cin, answer) || answer.empty()) {
        return std::nullopt;
    }
    OperatorWord word;
    if (hole) {
        word.printed = answer;
    } else {
        word.last_printed = answer;
    }
    return word;
}

Result<ExitCode> settle_job(Service& service, const SettleOptions& options) {
    std::optional<OperatorWord> word;
    if (options.word.given()) {
        word = options.word;
    } else {
        const auto doubt = service.get(job_path(options.job, "/doubt"));
        if (!doubt) {
            return doubt.error();
        }
        if (options.common.json) {
            show_json(*doubt);
        } else {
            show(doubt_text(*doubt, options.job, stdout_screen()));
        }
        if (number(*doubt, "count") == 0) {
            return ExitCode::done;
        }
        word = ask(*doubt, options.common.json);
        if (!word) {
            return ExitCode::in_doubt;
        }
    }
    if (const auto settled = settle(service, options.job, *word); !settled) {
        return settled.error();
    }
    const auto now = show_job_now(service, options.job, options.common.json);
    return now ? Result<ExitCode>{ExitCode::done} : now.error();
}

} // namespace

Json settle_request(const OperatorWord& word) {
    switch (word.policy) {
    case InDoubtPolicy::skip:
        return {{"in_doubt", "skip"}};
    case InDoubtPolicy::reprint:
        return {{"in_doubt", "reprint"}};
    case InDoubtPolicy::ask:
        break;
    }
    return word.printed ? Json{{"printed", *word.printed}} : Json{{"last_printed", word.last_printed}};
}

ExitCode run_start(const StartOptions& options) {
    return run_with_service(options.common, [&](Service& service) {
        const Json body = options.job ? Json{{"job", *options.job}} : Json(nullptr);
        const auto started = options.printer.empty() ? service.post(job_path(*options.job, "/start"))
                                                     : service.post(printer_path(options.printer, "/start"), body);
        return after_start(service, started, options.job, options.common, options.wait);
    });
}

ExitCode run_resume(const ResumeOptions& options) {
    return run_with_service(options.common, [&](Service& service) -> Result<ExitCode> {
        if (options.word.given()) {
            if (const auto settled = settle(service, options.job, options.word); !settled) {
                return settled.error();
            }
        }
        const auto started = service.post(job_path(options.job, "/resume"));
        return after_start(service, started, options.job, options.common, options.wait);
    });
}

ExitCode run_settle(const SettleOptions& options) {
    return run_with_service(options.common, [&](Service& service) { return settle_job(service, options); });
}

} // namespace linefeed::client
