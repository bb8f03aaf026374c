#include "client/start_command.hpp"
#include "linefeed/definitions.hpp"

#include <memory>

namespace linefeed {

namespace {

constexpr const char* wait_help = "Follow the job until it stands; Ctrl-C ends the following, not the job";
constexpr const char* codes = "Exit codes with --wait: 0 finished, 3 printer not reachable, 4 stopped before the end, "
                              "6 records in doubt.\nWithout it: 0 the start has begun.";

void add_start(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::StartOptions>();
    const auto job = std::make_shared<std::int64_t>(0);
    CLI::App& start = *app.add_subcommand("start", "Start a job, or the next one of a printer's queue");
    start.footer(codes);
    add_job(start, *job);
    start.add_option("--printer", options->printer,
                     "Without JOB: the first of this printer's queue that can be started or resumed");
    start.add_flag("--wait", options->wait, wait_help);
    add_common(start, options->common);
    commands.push_back({&start, [options, job] {
                            if (*job != 0) {
                                options->job = *job;
                            } else if (options->printer.empty()) {
                                return usage_error("say which JOB, or --printer NAME for the next one of its queue");
                            }
                            return client::run_start(*options);
                        }});
}

void add_resume(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::ResumeOptions>();
    const auto raw = std::make_shared<RawWord>();
    CLI::App& resume = *app.add_subcommand("resume", "Go on with a stopped job, behind the last printed record");
    resume.footer(codes);
    add_job(resume, options->job)->required();
    add_word(resume, options->word, *raw);
    resume.add_flag("--wait", options->wait, wait_help);
    add_common(resume, options->common);
    commands.push_back({&resume, [options, raw] {
                            const std::string problem = finish_word(options->word, *raw);
                            return problem.empty() ? client::run_resume(*options) : usage_error(problem);
                        }});
}

void add_settle(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::SettleOptions>();
    const auto raw = std::make_shared<RawWord>();
    CLI::App& settle =
        *app.add_subcommand("settle", "Say which records in doubt are printed, after a look at the products");
    settle.footer("Without an answer the records are shown, and on a terminal it is asked for.\n"
                  "Exit codes: 0 settled, 6 records are in doubt still.");
    add_job(settle, options->job)->required();
    add_word(settle, options->word, *raw);
    add_common(settle, options->common);
    commands.push_back({&settle, [options, raw] {
                            const std::string problem = finish_word(options->word, *raw);
                            return problem.empty() ? client::run_settle(*options) : usage_error(problem);
                        }});
}

} // namespace

void define_starts(CLI::App& app, Commands& commands) {
    add_start(app, commands);
    add_resume(app, commands);
    add_settle(app, commands);
}

} // namespace linefeed
