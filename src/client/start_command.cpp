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

/// When a printer was heard last, ns; absent = never, or nobody knows.
std::optional<std::int64_t> last_heard(Service& service, const std::string& printer) {
    const auto view = service.get(printer_path(printer));
    return view ? whole(*view, "heard_ns") : std::nullopt;
}

/// The same of the printer of a job.
std::optional<std::int64_t> last_heard_for(Service& service, std::int64_t job) {
    const auto view = service.get(job_path(job));
    return view ? last_heard(service, text(*view, "printer")) : std::nullopt;
}

Result<ExitCode> follow(Service& service, std::int64_t job, std::optional<std::int64_t> heard_before, bool json) {
    const auto end = wait_for_job(service, job, json);
    if (!end) {
        return end.error();
    }
    const std::string printer = text(end->job, "printer");
    if (end->interrupted) {
        say("job " + std::to_string(job) + " goes on without you looking: linefeed job " + std::to_string(job) +
            " shows it, linefeed stop " + printer + " stops it");
        return ExitCode::other;
    }
    if (json) {
        show_json(end->job);
    } else {
        show(job_line(end->job) + '\n');
    }
    const ExitCode code = exit_code_of_phase(text(end->job, "phase"));
    const bool never_reached = code == ExitCode::stopped && !end->lost && last_heard(service, printer) == heard_before;
    return never_reached ? ExitCode::unreachable : code;
}

/// The records in doubt, if they are what keeps a job from starting.
void show_doubt(Service& service, const Failure& failure, std::optional<std::int64_t> job, bool json) {
    if (failure.kind != FailureKind::in_doubt || !job || json) {
        return;
    }
    if (const auto doubt = service.get(job_path(*job, "/doubt"))) {
        show(doubt_text(*doubt, *job, stdout_screen()));
    }
}

struct StartRequest {
    std::string target;
    Json body{};
    std::optional<std::int64_t> job{}; ///< absent = the printer's next
    std::string printer{};             ///< empty = the job's
    bool wait = false;
    bool json = false;
};

/// Starts it, and shows the job as it is then, or as it is at last.
Result<ExitCode> start(Service& service, const StartRequest& request) {
    std::optional<std::int64_t> heard_before;
    if (request.wait) {
        heard_before =
            request.printer.empty() ? last_heard_for(service, *request.job) : last_heard(service, request.printer);
    }
    const auto started = service.post(request.target, request.body);
    if (!started) {
        show_doubt(service, started.error(), request.job, request.json);
        return started.error();
    }
    const std::int64_t id = number(*started, "job");
    if (request.wait) {
        return follow(service, id, heard_before, request.json);
    }
    const auto now = show_job_now(service, id, request.json);
    return now ? Result<ExitCode>{ExitCode::done} : now.error();
}

/// `as_of` = what the operator has been shown: his word holds for that only. Absent = he speaks of what he knows
/// himself.
Result<void> settle(Service& service, std::int64_t job, const OperatorWord& word, std::optional<std::int64_t> as_of) {
    Json request = settle_request(word);
    if (as_of) {
        request["as_of"] = *as_of;
    }
    const auto settled = service.post(job_path(job, "/settle"), request);
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
    std::optional<std::int64_t> as_of;
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
        as_of = number(*doubt, "as_of");
    }
    if (const auto settled = settle(service, options.job, *word, as_of); !settled) {
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
        StartRequest request{.target = options.printer.empty() ? job_path(*options.job, "/start")
                                                               : printer_path(options.printer, "/start"),
                             .job = options.job,
                             .printer = options.printer,
                             .wait = options.wait,
                             .json = options.common.json};
        if (!options.printer.empty() && options.job) {
            request.body = {{"job", *options.job}};
        }
        return start(service, request);
    });
}

ExitCode run_resume(const ResumeOptions& options) {
    return run_with_service(options.common, [&](Service& service) -> Result<ExitCode> {
        if (options.word.given()) {
            if (const auto settled = settle(service, options.job, options.word, std::nullopt); !settled) {
                return settled.error();
            }
        }
        return start(service, {.target = job_path(options.job, "/resume"),
                               .job = options.job,
                               .wait = options.wait,
                               .json = options.common.json});
    });
}

ExitCode run_settle(const SettleOptions& options) {
    return run_with_service(options.common, [&](Service& service) { return settle_job(service, options); });
}

} // namespace linefeed::client
