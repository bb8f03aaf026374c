#include "cli/distrust_command.hpp"
#include "client/ledger_command.hpp"
#include "daemon/record_ranges.hpp"
#include "linefeed/definitions.hpp"

#include <memory>

namespace linefeed {

namespace {

using client::JobsOptions;
using client::LedgerOptions;

void add_source(CLI::App& command, client::JobSourceOptions& options) {
    options.default_spool = default_spool();
    command.add_option("--spool", options.spool, "Read this database of jobs and print ledger, not the service's");
    add_service(command, options.service);
    command.footer("Without --spool the service is asked if it is there, and the spool of linefeed print (" +
                   options.default_spool.string() + ") is read otherwise.");
}

void add_jobs(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<JobsOptions>();
    CLI::App& jobs = *app.add_subcommand("jobs", "List the jobs, the newest first, and how far they are");
    jobs.add_option("--printer", options->query.printer, "Only those of this printer");
    jobs.add_option("--phase", options->query.phases, "Only those in one of these states, separated by commas")
        ->allow_extra_args(false)
        ->delimiter(',')
        ->check(CLI::IsMember({"importing", "ready", "queued", "arming", "printing", "stopping", "stopped", "in_doubt",
                               "finished", "cancelled", "failed"}));
    jobs.add_option("--limit", options->query.limit, "At most so many")
        ->capture_default_str()
        ->check(CLI::Range(1, 1'000'000));
    add_output(jobs, options->json);
    add_source(jobs, options->source);
    commands.push_back({&jobs, [options] { return client::run_jobs(*options); }});
}

void add_ledger(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<LedgerOptions>();
    const auto records = std::make_shared<std::string>();
    CLI::App& ledger =
        *app.add_subcommand("ledger", "Show what is known about the records of a job, and on whose word");
    add_job(ledger, options->job)->required();
    CLI::Option* const wanted =
        ledger.add_option("--records", *records, "One line for each of these records: N or N-M");
    CLI::Option* const verify = ledger.add_flag("--verify", options->verify, "Check the hash chain of the ledger");
    verify->excludes(wanted);
    ledger
        .add_option("--export", options->export_format,
                    "Every issued record with fields, state, time, run and evidence: csv or json (lines)")
        ->check(CLI::IsMember({"csv", "json"}))
        ->excludes(verify);
    add_output(ledger, options->json);
    add_source(ledger, options->source);
    commands.push_back({&ledger, [options, records] {
                            if (!records->empty()) {
                                options->records = daemon::parse_record_range(*records);
                                if (!options->records) {
                                    return usage_error("--records " + *records + ": expected N or N-M");
                                }
                            }
                            return client::run_ledger(*options);
                        }});
}

void add_distrust(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<cli::DistrustOptions>();
    CLI::App& distrust = *app.add_subcommand(
        "distrust", "Put every record in doubt that a spool from a backup does not know as printed");
    distrust.footer(
        "linefeed-restore does so: what was printed after the backup is not known to it. Then an operator says "
        "from the\nproducts how far each job came.");
    distrust.add_option("--spool", options->spool, "Database of jobs and the print ledger")->required();
    distrust.add_option("--reason", options->reason, "Stands in the ledger with the name of the user")->required();
    add_output(distrust, options->json);
    commands.push_back({&distrust, [options] {
                            return options->reason.find_first_not_of(" \t") == std::string::npos
                                       ? usage_error("--reason: say why")
                                       : cli::run_distrust(*options);
                        }});
}

} // namespace

void define_jobs(CLI::App& app, Commands& commands) {
    add_jobs(app, commands);
    add_ledger(app, commands);
    add_distrust(app, commands);
}

} // namespace linefeed
