// The command line of linefeed. CLI11 stays in this file.
#include "cli/check_config_command.hpp"
#include "cli/distrust_command.hpp"
#include "cli/drop_command.hpp"
#include "cli/ledger_command.hpp"
#include "cli/print_command.hpp"
#include "cli/token_command.hpp"
#include "daemon/record_ranges.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdlib>
#include <iostream>

namespace {

using linefeed::cli::CheckConfigOptions;
using linefeed::cli::DistrustOptions;
using linefeed::cli::DropOptions;
using linefeed::cli::ExitCode;
using linefeed::daemon::InDoubtPolicy;
using linefeed::cli::JobsOptions;
using linefeed::cli::LedgerOptions;
using linefeed::cli::PrintOptions;
using linefeed::cli::TokenOptions;
using linefeed::intake::Layout;

std::filesystem::path default_spool() {
    if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state != '\0') {
        return std::filesystem::path{state} / "linefeed" / "spool.db";
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
        return std::filesystem::path{home} / ".local" / "state" / "linefeed" / "spool.db";
    }
    return "linefeed-spool.db";
}

std::string profile_names() {
    std::string names;
    for (const auto& profile : linefeed::protocol::profiles) {
        names += (names.empty() ? "" : ", ") + std::string{profile.name};
    }
    return names;
}

/// Texts of options that need more than CLI11's conversion.
struct RawLayout {
    std::string delimiter;
    std::string profile{linefeed::protocol::profiles.front().name};
    bool no_header = false;
    std::optional<int> orientation;
};

struct RawPrintOptions {
    RawLayout layout;
    std::string output{"text"};
    std::string in_doubt{"ask"};
};

/// The options that decide which records a file gives: the same for every command that reads files.
void add_layout(CLI::App& command, Layout& layout, RawLayout& raw) {
    command
        .add_option("--columns", layout.columns,
                    "Columns to print, by name or number from 1, separated by commas; default: all")
        ->allow_extra_args(false)
        ->delimiter(',');
    command.add_option("--table", layout.table, "Table or view of the SQLite database");
    command.add_option("--query", layout.query, "SELECT statement that gives the records of the SQLite database");
    command.add_option("--delimiter", raw.delimiter,
                       "Separator of the CSV file: one character, or tab; default: found out from the first line");
    command.add_flag("--no-header", raw.no_header, "The first line of the CSV file is a record, not column names");
    command.add_flag("--skip-bad", layout.skip_bad,
                     "Leave rows out that cannot be printed, instead of refusing the file");
    command
        .add_option("--encoding", layout.encodings,
                    "What the printer's font wants: latin1 (default), windows-1252 or unicode-hex; COLUMN=ENCODING for "
                    "one column")
        ->allow_extra_args(false)
        ->delimiter(',');
    command.add_option("--profile", raw.profile, "Firmware profile: " + profile_names())->capture_default_str();
    command.add_option("--base", layout.base, "Record k has number BASE + k")->capture_default_str();
    command.add_flag("--mirrored", layout.properties.mirrored, "Print every record mirrored");
    command.add_option("--orientation", raw.orientation, "Turn every record by 0, 90, 180 or 270 degrees")
        ->check(CLI::IsMember({0, 90, 180, 270}));
}

/// What is wrong with them, or nothing.
std::string finish_layout(Layout& layout, const RawLayout& raw) {
    layout.header = !raw.no_header;
    if (raw.delimiter == "tab" || raw.delimiter == "\\t") {
        layout.delimiter = '\t';
    } else if (raw.delimiter.size() == 1) {
        layout.delimiter = raw.delimiter.front();
    } else if (!raw.delimiter.empty()) {
        return "--delimiter: expected one character, or tab";
    }
    const auto profile = linefeed::protocol::profile_by_name(raw.profile);
    if (!profile) {
        return "--profile: \"" + raw.profile + "\" is not known; one of: " + profile_names();
    }
    layout.profile = *profile;
    if (raw.orientation) {
        layout.properties.orientation = static_cast<linefeed::protocol::Orientation>(*raw.orientation / 90);
    }
    if (layout.table && layout.query) {
        return "--table and --query exclude each other";
    }
    return {};
}

void add_print(CLI::App& app, PrintOptions& options, RawPrintOptions& raw) {
    CLI::App& print =
        *app.add_subcommand("print", "Print a CSV file or an SQLite database, record by record, in the foreground");
    print.footer("The same command again continues after the last printed record. Ctrl-C stops the line cleanly.\n"
                 "Exit codes: 0 done, 2 usage, 3 printer not reachable, 4 stopped before the end (can be resumed),\n"
                 "5 input rejected, 6 records in doubt (an operator must decide), 1 anything else.");
    print.add_option("FILE", options.file, "CSV file or SQLite database")->required();
    print.add_option("--printer", options.printer, "Address of the printer, tcp://HOST:PORT");
    add_layout(print, options.layout, raw.layout);
    print.add_option("--from", options.from, "Number of the first record to print; default: the first of the file");
    print.add_option("--to", options.to, "Number of the last record to print; default: the last of the file");
    print.add_option("--spool", options.spool, "Database of jobs and the print ledger")->capture_default_str();
    print.add_flag("--dry-run", options.dry_run, "Check everything and show the first frames; print nothing");
    print.add_flag("--new-job", options.new_job, "Print the file as a new job, even if it was printed before");
    print.add_flag("--while-importing", options.while_importing,
                   "Begin to print before the file is read to its end. At a row that cannot be printed the line stops "
                   "behind the record before it (exit code 5), and the mended file continues there; where the file is "
                   "read more slowly than the line prints, the line stops too (exit code 4)");
    print.add_flag("--open-nozzle", options.open_nozzle, "Open the nozzle if it is closed (takes 30 to 60 s)");
    print
        .add_option("--acknowledge", options.acknowledge,
                    "Error numbers that may be acknowledged before the start, separated by commas")
        ->allow_extra_args(false)
        ->delimiter(',')
        ->expected(0, 16);
    print
        .add_option("--realtime-priority", options.real_time.priority,
                    "Schedule the feed thread as SCHED_FIFO with this priority, if permitted")
        ->check(CLI::Range(1, 99));
    print.add_option("--processor", options.real_time.processor, "Run the feed thread on this processor only, 0 ...")
        ->check(CLI::NonNegativeNumber);
    print.add_flag("--lock-memory", options.real_time.lock_memory, "Keep all memory in RAM, if permitted");
    print.add_option("--last-printed", options.operator_word.last_printed,
                     "Number or text of the record on the last product: settles records in doubt, where that tells");
    print.add_option(
        "--printed", options.operator_word.printed,
        "The records in doubt that are on products, all of them: N-M,N or none; the others will be printed");
    print
        .add_option("--in-doubt", raw.in_doubt,
                    "Records in doubt: ask (stop with exit code 6), skip (do not print them again) or reprint")
        ->capture_default_str()
        ->check(CLI::IsMember({"ask", "skip", "reprint"}));
    print.add_option("--connect-timeout", options.connect_timeout_ms, "Milliseconds to wait for a connection")
        ->capture_default_str()
        ->check(CLI::Range(1, 600000));
    print.add_option("--reply-timeout", options.reply_timeout_ms, "Milliseconds to wait for an answer of the printer")
        ->capture_default_str()
        ->check(CLI::Range(1, 600000));
    print.add_option("-o,--output", raw.output, "text or json")
        ->capture_default_str()
        ->check(CLI::IsMember({"text", "json"}));
}

/// What is wrong with the options, or nothing.
std::string finish_options(PrintOptions& options, const RawPrintOptions& raw) {
    options.json = raw.output == "json";
    if (std::string problem = finish_layout(options.layout, raw.layout); !problem.empty()) {
        return problem;
    }
    options.operator_word.policy = raw.in_doubt == "skip"      ? InDoubtPolicy::skip
                                   : raw.in_doubt == "reprint" ? InDoubtPolicy::reprint
                                                               : InDoubtPolicy::ask;
    const bool last_printed = !options.operator_word.last_printed.empty();
    if (last_printed && options.operator_word.printed) {
        return "--last-printed and --printed exclude each other";
    }
    if (options.operator_word.policy != InDoubtPolicy::ask && (last_printed || options.operator_word.printed)) {
        return "--in-doubt " + raw.in_doubt + (last_printed ? " and --last-printed" : " and --printed") +
               " exclude each other";
    }
    if (options.printer.empty() && !options.dry_run) {
        return "--printer tcp://HOST:PORT is required";
    }
    return {};
}

struct RawLedgerOptions {
    std::string records;
    std::string output{"text"};
};

void add_output(CLI::App& command, std::string& output) {
    command.add_option("-o,--output", output, "text or json")
        ->capture_default_str()
        ->check(CLI::IsMember({"text", "json"}));
}

struct RawDropOptions {
    RawLayout layout;
    std::string mode{"auto"};
    std::string settle{"quiet=2s"};
    std::optional<double> rescan_s;
    std::string output{"text"};
};

CLI::App& add_drop(CLI::App& app, DropOptions& options, RawDropOptions& raw) {
    CLI::App& drop = *app.add_subcommand("drop", "Import what is dropped into a folder into jobs, until Ctrl-C");
    drop.footer("A file is claimed into processing/, imported, and ends in done/ or failed/, with a report beside it.\n"
                "Nothing is printed. Exit codes: 0 ended, 4 an import was broken off (the next start takes it up),\n"
                "5 with --once: a file was rejected, 2 usage, 1 anything else.");
    drop.add_option("FOLDER", options.settings.folder, "The folder")->required();
    drop.add_option("--pattern", options.settings.pattern, "Names of the files to take, as in the shell")
        ->capture_default_str();
    drop.add_option("--settle", raw.settle,
                    "When a file is complete: quiet=TIME (unchanged for that time, in ms, s or min), rename (at once: "
                    "files are renamed into the folder) or done (when NAME.done lies beside NAME)")
        ->capture_default_str();
    drop.add_option("--mode", raw.mode, "inotify, poll, or auto: poll on network file systems only")
        ->capture_default_str()
        ->check(CLI::IsMember({"auto", "inotify", "poll"}));
    drop.add_option("--rescan", raw.rescan_s, "Seconds between two looks at the whole folder; inotify 30, poll 1")
        ->check(CLI::Range(0.05, 86400.0));
    drop.add_option("--max-bytes", options.settings.max_bytes, "Larger files are rejected unread")
        ->capture_default_str();
    drop.add_flag("--once", options.once, "Import what is there now, and end");
    add_layout(drop, options.settings.layout, raw.layout);
    drop.add_option("--spool", options.spool, "Database of jobs and the print ledger")->capture_default_str();
    add_output(drop, raw.output);
    return drop;
}

/// What is wrong with the options, or nothing.
std::string finish_options(DropOptions& options, const RawDropOptions& raw) {
    options.json = raw.output == "json";
    if (raw.mode != "auto") {
        options.settings.mode =
            raw.mode == "poll" ? linefeed::intake::WatchMode::poll : linefeed::intake::WatchMode::inotify;
    }
    if (raw.rescan_s) {
        options.settings.rescan =
            std::chrono::duration_cast<linefeed::Duration>(std::chrono::duration<double>{*raw.rescan_s});
    }
    const auto settle = linefeed::intake::parse_settle_rule(raw.settle);
    if (!settle) {
        return "--settle " + raw.settle + ": expected rename, done or quiet=TIME, for example quiet=2s";
    }
    options.settings.settle = *settle;
    return finish_layout(options.settings.layout, raw.layout);
}

CLI::App& add_jobs(CLI::App& app, JobsOptions& options, std::string& output) {
    CLI::App& jobs = *app.add_subcommand("jobs", "List the jobs in the spool and how far they are");
    jobs.add_option("--spool", options.spool, "Database of jobs and the print ledger")->capture_default_str();
    add_output(jobs, output);
    return jobs;
}

CLI::App& add_ledger(CLI::App& app, LedgerOptions& options, RawLedgerOptions& raw) {
    CLI::App& ledger =
        *app.add_subcommand("ledger", "Show what is known about the records of a job, and on whose word");
    ledger.add_option("JOB", options.job, "Number of the job, see linefeed jobs")->required();
    CLI::Option* const records =
        ledger.add_option("--records", raw.records, "One line for each of these records: N or N-M");
    CLI::Option* const verify = ledger.add_flag("--verify", options.verify, "Check the hash chain of the ledger");
    verify->excludes(records);
    ledger
        .add_option("--export", options.export_format,
                    "Every issued record with fields, state, time, run and evidence: csv or json (lines)")
        ->check(CLI::IsMember({"csv", "json"}))
        ->excludes(verify);
    ledger.add_option("--spool", options.spool, "Database of jobs and the print ledger")->capture_default_str();
    add_output(ledger, raw.output);
    return ledger;
}

CLI::App& add_token(CLI::App& app, TokenOptions& options, std::string& output) {
    CLI::App& token = *app.add_subcommand("token", "Tokens for programs that use the service over TCP");
    token.require_subcommand(1);
    CLI::App& made = *token.add_subcommand("new", "Make a token, and the line for http.tokens_file");
    made.add_option("NAME", options.name, "Whose it is: letters, digits and ._-; stands in the audit log")->required();
    made.add_option("--role", options.role, "viewer (looks at everything) or operator (and changes things)")
        ->capture_default_str()
        ->check(CLI::IsMember({"viewer", "operator"}));
    add_output(made, output);
    return token;
}

CLI::App& add_check_config(CLI::App& app, CheckConfigOptions& options, std::string& output) {
    CLI::App& check = *app.add_subcommand("check-config",
                                          "Check the configuration of the service and show the settings that it gives");
    check.footer("Variables of the environment go before the file: LINEFEED_HTTP_PORT is http.port.\n"
                 "Exit codes: 0 good, 2 refused: each problem with file, line and column on stderr.");
    check.add_option("FILE", options.file, "The configuration, YAML; see config/linefeed.yaml")->required();
    check.add_option("-o,--output", output, "text (YAML) or json")
        ->capture_default_str()
        ->check(CLI::IsMember({"text", "json"}));
    return check;
}

CLI::App& add_distrust(CLI::App& app, DistrustOptions& options, std::string& output) {
    CLI::App& distrust = *app.add_subcommand(
        "distrust", "Put every record in doubt that a spool from a backup does not know as printed");
    distrust.footer(
        "linefeed-restore does so: what was printed after the backup is not known to it. Then an operator says "
        "from the\nproducts how far each job came.");
    distrust.add_option("--spool", options.spool, "Database of jobs and the print ledger")->required();
    distrust.add_option("--reason", options.reason, "Stands in the ledger with the name of the user")
        ->required()
        ->check(
            [](const std::string& text) { return text.empty() ? std::string{"must not be empty"} : std::string{}; });
    add_output(distrust, output);
    return distrust;
}

ExitCode usage_error(const std::string& problem) {
    std::cerr << "linefeed: " << problem << '\n';
    return ExitCode::usage;
}

ExitCode run(int argc, char** argv) {
    CLI::App app{"linefeed streams the records of a database into the mailing FIFO of Leibinger JET printers: every "
                 "record once, in order."};
    app.set_version_flag("--version", "linefeed " LINEFEED_VERSION);
    app.require_subcommand(1);
    PrintOptions print;
    JobsOptions jobs;
    LedgerOptions ledger;
    CheckConfigOptions check_config;
    DropOptions drop;
    DistrustOptions distrust;
    print.spool = jobs.spool = ledger.spool = drop.spool = default_spool();
    RawPrintOptions raw_print;
    RawLedgerOptions raw_ledger;
    RawDropOptions raw_drop;
    std::string jobs_output{"text"};
    TokenOptions token;
    std::string token_output{"text"};
    std::string check_config_output{"text"};
    std::string distrust_output{"text"};
    add_print(app, print, raw_print);
    const CLI::App& drop_command = add_drop(app, drop, raw_drop);
    const CLI::App& jobs_command = add_jobs(app, jobs, jobs_output);
    const CLI::App& ledger_command = add_ledger(app, ledger, raw_ledger);
    const CLI::App& token_command = add_token(app, token, token_output);
    const CLI::App& check_config_command = add_check_config(app, check_config, check_config_output);
    const CLI::App& distrust_command = add_distrust(app, distrust, distrust_output);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return static_cast<ExitCode>(app.exit(success));
    } catch (const CLI::ParseError& error) {
        return usage_error(std::string{error.what()} +
                           " (linefeed --help, or linefeed COMMAND --help, shows the options)");
    }
    if (drop_command.parsed()) {
        const std::string problem = finish_options(drop, raw_drop);
        return problem.empty() ? linefeed::cli::run_drop(drop) : usage_error(problem);
    }
    if (jobs_command.parsed()) {
        jobs.json = jobs_output == "json";
        return linefeed::cli::run_jobs(jobs);
    }
    if (ledger_command.parsed()) {
        ledger.json = raw_ledger.output == "json";
        if (!raw_ledger.records.empty()) {
            ledger.records = linefeed::daemon::parse_record_range(raw_ledger.records);
            if (!ledger.records) {
                return usage_error("--records " + raw_ledger.records + ": expected N or N-M");
            }
        }
        return linefeed::cli::run_ledger(ledger);
    }
    if (token_command.parsed()) {
        token.json = token_output == "json";
        return linefeed::cli::run_token(token);
    }
    if (check_config_command.parsed()) {
        check_config.json = check_config_output == "json";
        return linefeed::cli::run_check_config(check_config);
    }
    if (distrust_command.parsed()) {
        distrust.json = distrust_output == "json";
        return linefeed::cli::run_distrust(distrust);
    }
    if (const std::string problem = finish_options(print, raw_print); !problem.empty()) {
        return usage_error(problem);
    }
    return linefeed::cli::run_print(print);
}

} // namespace

int main(int argc, char** argv) {
    try {
        return static_cast<int>(run(argc, argv));
    } catch (const std::exception& exception) {
        std::cerr << "linefeed: " << exception.what() << '\n';
        return static_cast<int>(ExitCode::other);
    }
}
