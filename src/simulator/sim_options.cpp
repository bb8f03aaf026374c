// The options of linefeed-sim, see sim_options.hpp.
#include "simulator/sim_options.hpp"

#include <charconv>
#include <sstream>

namespace linefeed::simulator {
namespace {

constexpr unsigned max_printers = 256;
constexpr double max_rate = 100000;
constexpr double max_milliseconds = 3600000;
constexpr double max_jitter_percent = 100;

/// A number within the limits. CLI11's own Range lets NaN pass.
CLI::Validator between(double smallest, double largest) {
    return CLI::Validator{[smallest, largest](std::string& text) -> std::string {
                              double value = 0;
                              const char* end = text.data() + text.size();
                              const auto read = std::from_chars(text.data(), end, value);
                              if (read.ec == std::errc{} && read.ptr == end && value >= smallest && value <= largest) {
                                  return {};
                              }
                              std::ostringstream reason;
                              reason << "a number from " << smallest << " to " << largest << " expected, not \"" << text
                                     << '"';
                              return reason.str();
                          },
                          ""};
}

void add_printer_options(CLI::App& app, SimOptions& typed, PrinterSettings& printer) {
    const std::string group = "Printer";
    app.add_option("--profile", typed.profile, "jet3 | jet3up | jet2neo | jet2neo-v71")->group(group);
    app.add_option("--depth", printer.depth, "Records in the printer at most")
        ->check(CLI::Range(1U, max_depth))
        ->group(group);
    const auto add_ms = [&](const char* name, double& value, const char* description) {
        app.add_option(name, value, description)->check(between(0, max_milliseconds))->group(group);
    };
    add_ms("--margin-ms", typed.margin_ms, "How long before its PrintGo a record must be there");
    add_ms("--print-ms", typed.print_ms, "How long a print takes; shorter than half the distance of PrintGos");
    add_ms("--nozzle-opening-ms", typed.nozzle_opening_ms, "From !NO to open");
    add_ms("--initialising-ms", typed.initialising_ms, "From !PO to ready");
    add_ms("--job-loading-ms", typed.job_loading_ms, "How long loading a job takes");
    app.add_option("--firmware", printer.firmware,
                   "Version in ?VS, e.g. V60.0.1.17; what the manual ties to versions follows it")
        ->group(group);
    app.add_option("--counter", typed.counters, "START-END or START-ENDxREPETITIONS: a counter of the job, repeatable")
        ->group(group);
    app.add_option("--input-function", typed.input_functions,
                   "CONTACT=NUMBER: what an input does, numbered as in =IC, e.g. X4.9=3; repeatable")
        ->group(group);
    app.add_option("--block-errors", printer.block_errors.percent,
                   "Percent of the file blocks, each way, that are damaged or asked for again")
        ->check(CLI::Range(0U, 99U))
        ->group(group);
    app.add_option("--serial-number", printer.serial_number, "In ?VS")->group(group);
    app.add_option("--total-prints", printer.total_prints, "Prints of the printer's life so far")->group(group);
    app.add_option("--job", printer.job, "Name of the loaded job with path")->group(group);
    app.add_option("--speed", printer.speed, "Speed in ?RS, dm/min")->group(group);
    app.add_option("--charset", typed.charset,
                   "How the job's font reads the bytes: latin1 | windows-1252 | unicode-hex")
        ->group(group);
    app.add_flag("--standby", typed.standby, "Begin in standby")->group(group);
    app.add_flag("--nozzle-closed", typed.nozzle_closed, "Begin with the nozzle closed")->group(group);
    app.add_flag("--cover-open", printer.cover_open, "Begin with the head cover open")->group(group);
    app.add_flag("--length-prefix", printer.length_on, "An earlier client has sent !LN")->group(group);
    app.add_flag("--echo", printer.echo_on, "An earlier client has sent !EM")->group(group);
    app.add_option("--block-length", printer.block_length, "An earlier client has sent =FL")
        ->check(CLI::Range(1U, 2048U))
        ->group(group);
    std::string names;
    for (const std::string_view name : habit_names) {
        names.append(names.empty() ? "" : " ").append(name);
    }
    app.add_option("--habit", typed.habits,
                   "Habit of a firmware or of whoever set it up, repeatable; NAME=off: "
                   "not this one of the version that it plays: " +
                       names)
        ->group(group);
}

void add_line_options(CLI::App& app, SimOptions& typed, ConveyorSettings& conveyor) {
    const std::string group = "Conveyor";
    app.add_option("--rate", conveyor.rate, "PrintGos per second; 0 = no conveyor")
        ->check(between(0, max_rate))
        ->group(group);
    app.add_option("--jitter", conveyor.jitter_percent, "Percent of the period, each way")
        ->check(between(0, max_jitter_percent))
        ->group(group);
    app.add_option("--seed", conveyor.seed, "Of the jitter, the block errors and the noise")->group(group);
    app.add_option("--products", typed.products,
                   "Stop the conveyor after so many PrintGos that found the printer printing")
        ->check(CLI::PositiveNumber)
        ->group(group);
    app.add_flag("--free-running", conveyor.free_running, "Products come even when the printer does not print")
        ->group(group);
    app.add_option("--start-delay-ms", typed.start_delay_ms, "From print start to the first product")
        ->check(between(0, max_milliseconds))
        ->group(group);
}

void add_fault_options(CLI::App& app, SimOptions& typed) {
    const std::string group = "Faults";
    app.add_option("--fault", typed.faults, std::string{"\"WHEN WHAT\", repeatable. "}.append(fault_help()))
        ->group(group);
    app.add_option("--scenario", typed.scenario, "File of such faults, one a line; # begins a comment")->group(group);
    const auto add = [&](const char* name, std::vector<std::uint64_t>& prints, const char* description) {
        app.add_option(name, prints, description)->check(CLI::PositiveNumber)->group(group);
    };
    add("--stop-at-print", typed.stops_at_print, "When so many are printed, the operator stops the printing");
    add("--cover-open-at-print", typed.covers_at_print, "… the cover is opened");
    add("--cut-at-print", typed.cuts_at_print, "… all connections are closed");
    add("--mute-at-print", typed.mutes_at_print, "… and from then on nothing is answered");
    add("--power-cycle-at-print", typed.power_cycles_at_print, "… mains off and on");
    app.add_option("--error-at-print", typed.errors_at_print, "N:CODE, the error stops the printing then")
        ->group(group);
}

void add_serial_options(CLI::App& app, SimOptions& typed) {
    const std::string group = "Serial line";
    constexpr std::uint32_t fastest = 1000000;
    auto* const serial = app.add_option("--serial", typed.serial, "Path at which a serial port to the printer appears");
    serial->group(group);
    app.add_option("--baud", typed.baud, "Speed of the serial line, 8N1")
        ->check(CLI::Range(300U, fastest))
        ->needs(serial)
        ->group(group);
    app.add_option("--damage", typed.damage, "One byte in so many is damaged, each way")->needs(serial)->group(group);
    app.add_option("--loss", typed.loss, "One byte in so many gets lost, each way")->needs(serial)->group(group);
}

void add_run_options(CLI::App& app, SimOptions& typed, SimulatorSettings& settings) {
    app.add_option("--listen", typed.listen, "HOST:PORT; port 0 picks a free one");
    app.add_option("--tape", settings.tape, "CSV file of what was printed: time_ns,number,text");
    app.add_option("--reply-delay", typed.reply_delay_ms, "Milliseconds each answer waits")
        ->check(between(0, max_milliseconds));
    app.add_option("--exit-when-idle", typed.exit_when_idle, "End after so many seconds without a connection")
        ->check(CLI::PositiveNumber);
    app.add_option("--summary-json", typed.summary_json, "The summary as JSON: to FILE, or without FILE to stdout")
        ->expected(0, 1)
        ->default_str("-");
    app.add_option("--printers", typed.printers, "So many printers, on consecutive ports")
        ->check(CLI::Range(1U, max_printers));
    app.add_option("--report", typed.report,
                   "For benchmarks: lead times, misses and stalls as JSON to FILE. PrintGos keep to their grid, and a "
                   "product without a record in time is counted and stops nothing");
}

} // namespace

void add_options(CLI::App& app, SimOptions& typed, SimulatorSettings& settings) {
    add_run_options(app, typed, settings);
    add_serial_options(app, typed);
    add_line_options(app, typed, settings.conveyor);
    add_printer_options(app, typed, settings.printer);
    add_fault_options(app, typed);
}

} // namespace linefeed::simulator
