#include "client/ledger_command.hpp"

#include "client/command.hpp"
#include "client/job_text.hpp"
#include "client/ledger_text.hpp"

#include <iostream>

namespace linefeed::client {

namespace {

RecordFormat format_of(const LedgerOptions& options) {
    if (options.export_format == "csv") {
        return RecordFormat::csv;
    }
    return options.export_format == "json" || options.json ? RecordFormat::json : RecordFormat::table;
}

/// One line per issued record.
Result<void> show_records(JobSource& source, const LedgerOptions& options) {
    const RecordFormat format = format_of(options);
    const auto history = source.history(options.job, options.records);
    if (!history) {
        return history.error();
    }
    std::cout << record_head(format);
    for (const Json& stretch : *history) {
        const RecordRange range =
            RecordRange::closed(RecordNumber{static_cast<std::uint32_t>(number(stretch, "first"))},
                                RecordNumber{static_cast<std::uint32_t>(number(stretch, "last"))});
        const auto shown = source.records(options.job, range, [&](const Json& record) {
            std::cout << record_line(record, stretch, format);
            return std::cout.good();
        });
        if (!shown) {
            return shown.error();
        }
    }
    std::cout.flush();
    return {};
}

Result<ExitCode> ledger(const LedgerOptions& options) {
    const auto source = open_job_source(options.source);
    if (!source) {
        return source.error();
    }
    const auto job = (*source)->job(options.job);
    if (!job) {
        return job.error();
    }
    if (options.verify) {
        const auto rows = (*source)->verify();
        if (!rows) {
            return rows.error();
        }
        if (options.json) {
            show_json({{"rows", *rows}});
        } else {
            show("the print ledger is whole: " + std::to_string(*rows) + " rows, every hash right\n");
        }
        return ExitCode::done;
    }
    if (options.records || !options.export_format.empty()) {
        const auto shown = show_records(**source, options);
        return shown ? Result<ExitCode>{ExitCode::done} : shown.error();
    }
    const auto history = (*source)->history(options.job, std::nullopt);
    if (!history) {
        return history.error();
    }
    if (options.json) {
        show_json(ledger_json(*job, *history));
    } else {
        show(ledger_text(*job, *history));
    }
    return ExitCode::done;
}

Result<ExitCode> jobs(const JobsOptions& options) {
    const auto source = open_job_source(options.source);
    if (!source) {
        return source.error();
    }
    JobQuery query = options.query;
    ++query.limit; // whether there are more
    auto jobs = (*source)->jobs(query);
    if (!jobs) {
        return jobs.error();
    }
    const bool more = jobs->size() > options.query.limit;
    jobs->resize(std::min(jobs->size(), options.query.limit));
    if (options.json) {
        show_json(*jobs);
    } else {
        show(jobs_text(*jobs, stdout_screen()));
    }
    if (more) {
        say("there are older ones: --limit N shows more than " + std::to_string(options.query.limit));
    }
    return ExitCode::done;
}

} // namespace

ExitCode run_jobs(const JobsOptions& options) {
    return run_command(options.json, [&] { return jobs(options); });
}

ExitCode run_ledger(const LedgerOptions& options) {
    return run_command(options.json, [&] { return ledger(options); });
}

} // namespace linefeed::client
