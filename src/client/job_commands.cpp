#include "client/job_commands.hpp"

#include "client/job_text.hpp"
#include "daemon/record_ranges.hpp"

namespace linefeed::client {

namespace {

/// Asks the service to do it, and shows the job as it is then.
Result<ExitCode> change(Service& service, std::int64_t job, std::string_view what, const Json& body, bool json) {
    const auto changed = service.post(job_path(job, what), body);
    if (!changed) {
        return changed.error();
    }
    const auto now = service.get(job_path(job));
    if (!now) {
        return now.error();
    }
    if (json) {
        show_json(*now);
    } else {
        show(job_line(*now) + '\n');
    }
    return ExitCode::done;
}

Result<ExitCode> show_job(Service& service, const JobOptions& options) {
    const auto job = service.get(job_path(options.job));
    if (!job) {
        return job.error();
    }
    if (options.common.json) {
        show_json(*job);
        return ExitCode::done;
    }
    const Screen screen = stdout_screen();
    show(job_text(*job, screen));
    if (number(*job, "in_doubt") > 0) {
        const auto doubt = service.get(job_path(options.job, "/doubt"));
        if (!doubt) {
            return doubt.error();
        }
        show('\n' + doubt_text(*doubt, options.job, screen));
    }
    return ExitCode::done;
}

/// "job 12 (names.csv), 500 of 1000 records printed", for a question.
Result<std::string> name_of(Service& service, std::int64_t id) {
    const auto job = service.get(job_path(id));
    if (!job) {
        return job.error();
    }
    return "job " + std::to_string(id) + " (" + text(*job, "name") + "), " + number_text(*job, "printed") + " of " +
           std::to_string(number(member(*job, "records"), "count")) + " records printed";
}

Result<bool> confirm_cancel(Service& service, const CancelOptions& options) {
    const auto name = name_of(service, options.job);
    return name ? confirm("give up " + *name, options.yes, options.common.json) : name.error();
}

Result<bool> confirm_reprint(Service& service, const ReprintOptions& options) {
    const auto ranges = daemon::parse_record_ranges(options.records);
    if (!ranges) {
        return Failure{FailureKind::usage, "--records: " + ranges.error().message};
    }
    RecordCount count;
    for (const RecordRange& range : *ranges) {
        count += range.count();
    }
    if (count == RecordCount{0}) {
        return Failure{FailureKind::usage, "--records " + options.records + ": no record is named"};
    }
    const auto name = name_of(service, options.job);
    if (!name) {
        return name.error();
    }
    return confirm("print " + std::to_string(count.value()) + (count == RecordCount{1} ? " record" : " records") +
                       " once more (" + daemon::to_text(*ranges) + ") of " + *name,
                   options.yes, options.common.json);
}

} // namespace

ExitCode run_job(const JobOptions& options) {
    return run_with_service(options.common, [&](Service& service) { return show_job(service, options); });
}

ExitCode run_queue(const QueueOptions& options) {
    return run_with_service(options.common, [&](Service& service) {
        return change(service, options.job, "/queue", {{"printer", options.printer}}, options.common.json);
    });
}

ExitCode run_cancel(const CancelOptions& options) {
    return run_with_service(options.common, [&](Service& service) -> Result<ExitCode> {
        const auto sure = confirm_cancel(service, options);
        if (!sure || !*sure) {
            return sure ? Result<ExitCode>{ExitCode::other} : sure.error();
        }
        return change(service, options.job, "/cancel", nullptr, options.common.json);
    });
}

ExitCode run_reprint(const ReprintOptions& options) {
    return run_with_service(options.common, [&](Service& service) -> Result<ExitCode> {
        const auto sure = confirm_reprint(service, options);
        if (!sure || !*sure) {
            return sure ? Result<ExitCode>{ExitCode::other} : sure.error();
        }
        return change(service, options.job, "/reprint", {{"records", options.records}, {"reason", options.reason}},
                      options.common.json);
    });
}

} // namespace linefeed::client
