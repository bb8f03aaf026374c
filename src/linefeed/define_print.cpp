#include "cli/print_command.hpp"
#include "linefeed/definitions.hpp"

#include <memory>

namespace linefeed {

namespace {

using cli::PrintOptions;

struct RawPrintOptions {
    RawLayout layout;
    RawWord word;
};

CLI::App& add_print(CLI::App& app, PrintOptions& options, RawPrintOptions& raw) {
    CLI::App& print =
        *app.add_subcommand("print", "Print a CSV file or an SQLite database, record by record, in the foreground");
    print.footer("The same command again continues after the last printed record. Ctrl-C stops the line cleanly.\n"
                 "Exit codes: 0 done, 2 usage, 3 printer not reachable, 4 stopped before the end (can be resumed),\n"
                 "5 input rejected, 6 records in doubt (an operator must decide), 1 anything else.");
    print.add_option("FILE", options.file, "CSV file or SQLite database")->required();
    print.add_option("--printer", options.printer,
                     "Address of the printer, tcp://HOST:PORT or serial:///DEVICE?baud=115200&flow=rtscts; crc=on "
                     "behind ? secures a noisy line");
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
        .add_option("--expected-rate", options.expected_rate,
                    "Products a second that the conveyor is to bring: a warning before the start where a serial line "
                    "carries less")
        ->check(CLI::Range(1, 10000));
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
    add_word(print, options.operator_word, raw.word);
    print.add_option("--connect-timeout", options.connect_timeout_ms, "Milliseconds to wait for a connection")
        ->capture_default_str()
        ->check(CLI::Range(1, 600000));
    print.add_option("--reply-timeout", options.reply_timeout_ms, "Milliseconds to wait for an answer of the printer")
        ->capture_default_str()
        ->check(CLI::Range(1, 600000));
    add_output(print, options.json);
    return print;
}

/// What is wrong with the options, or nothing.
std::string finish_options(PrintOptions& options, const RawPrintOptions& raw) {
    if (std::string problem = finish_layout(options.layout, raw.layout); !problem.empty()) {
        return problem;
    }
    if (std::string problem = finish_word(options.operator_word, raw.word); !problem.empty()) {
        return problem;
    }
    if (options.printer.empty() && !options.dry_run) {
        return "--printer tcp://HOST:PORT or serial:///DEVICE is required";
    }
    return {};
}

} // namespace

void define_print(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<PrintOptions>();
    const auto raw = std::make_shared<RawPrintOptions>();
    options->spool = default_spool();
    CLI::App& print = add_print(app, *options, *raw);
    commands.push_back({&print, [options, raw] {
                            const std::string problem = finish_options(*options, *raw);
                            return problem.empty() ? cli::run_print(*options) : usage_error(problem);
                        }});
}

} // namespace linefeed
