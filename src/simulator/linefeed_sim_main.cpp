// linefeed-sim: a JET printer with a conveyor, for training, tests and acceptance without hardware. Reads the command
// line, runs the simulator, tells the summary. Exit codes: 0 done, 1 cannot run, 2 usage.
#include "protocol/command_help.hpp"
#include "protocol/decimal.hpp"
#include "simulator/fleet.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace linefeed;
using namespace linefeed::simulator;

constexpr int exit_failed = 1;
constexpr int exit_usage = 2;
constexpr unsigned max_printers = 256;
constexpr double max_rate = 100000;
constexpr double max_milliseconds = 3600000;
constexpr double max_jitter_percent = 100;

/// The options as they are typed.
struct Options {
    std::string listen = "127.0.0.1:3000";
    std::string profile = "jet3up";
    std::string charset = "latin1";
    std::vector<std::string> habits;
    std::vector<std::string> errors_at_print;
    std::vector<std::string> faults;
    std::string scenario;
    std::vector<std::string> counters;
    std::vector<std::string> input_functions;
    bool commands = false;
    std::vector<std::uint64_t> stops_at_print, covers_at_print, cuts_at_print, mutes_at_print, power_cycles_at_print;
    std::uint64_t products = 0;
    std::uint32_t exit_when_idle = 0;
    double reply_delay_ms = 0;
    double margin_ms = 3;
    double print_ms = 1;
    double start_delay_ms = 20;
    double nozzle_opening_ms = 30000;
    double initialising_ms = 5000;
    double job_loading_ms = 100;
    bool standby = false;
    bool nozzle_closed = false;
    std::string summary_json;
    std::string report;
    unsigned printers = 1;
};

Duration from_ms(double ms) {
    return std::chrono::duration_cast<Duration>(std::chrono::duration<double, std::milli>{ms});
}

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

/// Throws what CLI11 reports as a usage error.
[[noreturn]] void refuse(const std::string& option, const std::string& reason) {
    throw CLI::ValidationError(option, reason);
}

void add_printer_options(CLI::App& app, Options& typed, PrinterSettings& printer) {
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
    app.add_option("--habit", typed.habits, "Firmware habit, repeatable: " + names)->group(group);
}

void add_line_options(CLI::App& app, Options& typed, ConveyorSettings& conveyor) {
    const std::string group = "Conveyor";
    app.add_option("--rate", conveyor.rate, "PrintGos per second; 0 = no conveyor")
        ->check(between(0, max_rate))
        ->group(group);
    app.add_option("--jitter", conveyor.jitter_percent, "Percent of the period, each way")
        ->check(between(0, max_jitter_percent))
        ->group(group);
    app.add_option("--seed", conveyor.seed, "Of the jitter and of the block errors")->group(group);
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

void add_fault_options(CLI::App& app, Options& typed) {
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

void add_run_options(CLI::App& app, Options& typed, SimulatorSettings& settings) {
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

void set_address(SimulatorSettings& settings, const std::string& listen) {
    const std::size_t colon = listen.rfind(':');
    if (colon == std::string::npos || colon == 0) {
        refuse("--listen", "HOST:PORT expected, e.g. 127.0.0.1:3000, not \"" + listen + "\"");
    }
    settings.host = listen.substr(0, colon);
    settings.port = listen.substr(colon + 1);
    if (settings.host.size() > 2 && settings.host.front() == '[' && settings.host.back() == ']') {
        settings.host = settings.host.substr(1, settings.host.size() - 2);
    }
    std::uint16_t port = 0;
    const char* end = settings.port.data() + settings.port.size();
    const auto read = std::from_chars(settings.port.data(), end, port);
    if (read.ec != std::errc{} || read.ptr != end) {
        refuse("--listen", "the port must be 0 to 65535, not \"" + settings.port + "\"");
    }
}

Fault wanted_fault(const std::string& option, const std::string& text) {
    auto fault = parse_fault(text);
    if (!fault) {
        refuse(option, fault.error().message);
    }
    return *std::move(fault);
}

/// `N:CODE`.
Fault error_fault(const std::string& typed) {
    const std::size_t colon = typed.find(':');
    auto fault = colon == std::string::npos
                     ? Result<Fault>{Failure{}}
                     : parse_fault("print " + typed.substr(0, colon) + " error " + typed.substr(colon + 1));
    if (!fault) {
        refuse("--error-at-print", "N:CODE expected, e.g. 100:12113, not \"" + typed + "\"");
    }
    return *std::move(fault);
}

void add_scenario(std::vector<Fault>& faults, const std::string& path) {
    std::ifstream file{path};
    const std::string text{std::istreambuf_iterator<char>{file}, {}};
    if (!file.is_open() || file.bad()) {
        refuse("--scenario", "cannot read " + path);
    }
    auto scenario = parse_scenario(text);
    if (!scenario) {
        refuse("--scenario", path + ", " + scenario.error().message);
    }
    faults.insert(faults.end(), std::make_move_iterator(scenario->begin()), std::make_move_iterator(scenario->end()));
}

/// `START-END` or `START-ENDxREPETITIONS`.
CounterDefinition counter_of(const std::string& typed) {
    const std::size_t dash = typed.find('-');
    const std::size_t cross = std::min(typed.find('x'), typed.size());
    if (dash != std::string::npos && dash < cross) {
        const std::string_view text{typed};
        const auto start = protocol::read_decimal<std::uint64_t>(text.substr(0, dash));
        const auto end = protocol::read_decimal<std::uint64_t>(text.substr(dash + 1, cross - dash - 1));
        const auto repetitions =
            cross == typed.size() ? std::optional{0U} : protocol::read_decimal<std::uint32_t>(text.substr(cross + 1));
        if (start && end && repetitions && *start <= protocol::max_counter_value &&
            *end <= protocol::max_counter_value) {
            return {*start, *end, *repetitions};
        }
    }
    refuse("--counter", "START-END or START-ENDxREPETITIONS expected, e.g. 1-9999x2, not \"" + typed + "\"");
}

/// `CONTACT=NUMBER`.
void set_input_function(PrinterSettings& printer, const std::string& typed) {
    constexpr std::uint32_t last_function = 12;
    const std::size_t equals = std::min(typed.find('='), typed.size());
    const auto input = protocol::input_from_contact(std::string_view{typed}.substr(0, equals));
    const auto number =
        protocol::read_decimal<std::uint32_t>(std::string_view{typed}.substr(std::min(equals + 1, typed.size())));
    if (!input || static_cast<std::size_t>(*input) >= printer.profile.configured_inputs() || !number ||
        *number > last_function) {
        refuse("--input-function", "CONTACT=NUMBER expected, a contact that the printer has and a number of 0 to 12, "
                                   "e.g. X4.9=3, not \"" +
                                       typed + "\"");
    }
    printer.inputs.functions[static_cast<std::size_t>(*input)] = protocol::InputFunction{*number};
}

void set_profile(PrinterSettings& printer, const Options& typed) {
    const auto profile = protocol::profile_by_name(typed.profile);
    if (!profile) {
        refuse("--profile", "jet3, jet3up, jet2neo or jet2neo-v71 expected, not \"" + typed.profile + "\"");
    }
    printer.profile = *profile;
    if (!printer.firmware.empty()) {
        const auto of_version = protocol::profile_for(versions_of(printer).type, printer.firmware);
        if (!of_version || printer.firmware.find_first_of("\t\r\n^\\") != std::string::npos) {
            refuse("--firmware", "a version expected, e.g. V60.0.1.17, not \"" + printer.firmware + "\"");
        }
        printer.profile = *of_version;
    }
}

void set_printer(PrinterSettings& printer, const Options& typed, const ConveyorSettings& conveyor,
                 bool print_ms_typed) {
    set_profile(printer, typed);
    printer.block_errors.seed = conveyor.seed;
    for (const std::string& text : typed.counters) {
        printer.counters.push_back(counter_of(text));
    }
    for (const std::string& text : typed.input_functions) {
        set_input_function(printer, text);
    }
    for (const std::string& name : typed.habits) {
        if (!set_habit(printer.habits, name)) {
            refuse("--habit", "there is no habit \"" + name + "\"; see --help");
        }
    }
    const auto is_sendable = [](const std::string& text) { return text.find_first_of("\t\r\n^") == std::string::npos; };
    if (!is_sendable(printer.serial_number) || !is_sendable(printer.job) || printer.job.empty()) {
        refuse("--serial-number, --job", "TAB, line ends and ^ cannot be sent");
    }
    if (typed.standby && typed.nozzle_closed) {
        refuse("--standby", "excludes --nozzle-closed");
    }
    printer.power_up = typed.standby         ? PowerUpState::standby
                       : typed.nozzle_closed ? PowerUpState::nozzle_closed
                                             : PowerUpState::ready_to_print;
    printer.margin = from_ms(typed.margin_ms);
    printer.nozzle_opening_time = from_ms(typed.nozzle_opening_ms);
    printer.initialising_time = from_ms(typed.initialising_ms);
    printer.job_loading_time = from_ms(typed.job_loading_ms);
    printer.print_duration = from_ms(typed.print_ms);
    const Duration longest = Conveyor::smallest_distance(conveyor);
    if (printer.print_duration > longest) {
        if (print_ms_typed) {
            refuse("--print-ms", "longer than the smallest distance of two PrintGos, " +
                                     std::to_string(std::chrono::duration<double, std::milli>{longest}.count()) +
                                     " ms");
        }
        printer.print_duration = longest;
    }
}

void set_faults(std::vector<Fault>& faults, const Options& typed) {
    if (!typed.scenario.empty()) {
        add_scenario(faults, typed.scenario);
    }
    for (const std::string& text : typed.faults) {
        faults.push_back(wanted_fault("--fault", text));
    }
    for (const std::string& text : typed.errors_at_print) {
        faults.push_back(error_fault(text));
    }
    const auto add = [&faults](const Deed& deed, const std::vector<std::uint64_t>& prints) {
        for (const std::uint64_t print : prints) {
            faults.push_back({{Moment::Unit::print, print, {}}, deed});
        }
    };
    add(PressKey{protocol::Action::stop_print}, typed.stops_at_print);
    add(MoveCover{true}, typed.covers_at_print);
    add(CutConnections{}, typed.cuts_at_print);
    add(Mute{true}, typed.mutes_at_print);
    add(PowerCycle{}, typed.power_cycles_at_print);
}

void set_everything(SimulatorSettings& settings, const Options& typed, bool print_ms_typed) {
    set_address(settings, typed.listen);
    set_printer(settings.printer, typed, settings.conveyor, print_ms_typed);
    const auto charset = protocol::charset_from_name(typed.charset);
    if (!charset) {
        refuse("--charset", "latin1, windows-1252 or unicode-hex expected, not \"" + typed.charset + "\"");
    }
    settings.charset = *charset;
    settings.count_misses = settings.conveyor.keeps_grid = !typed.report.empty();
    if (typed.printers > 1 && (settings.tape || typed.exit_when_idle > 0)) {
        refuse("--printers", "more than one exclude --tape and --exit-when-idle");
    }
    settings.server.escapes = settings.printer.profile.escapes;
    settings.server.reply_delay = from_ms(typed.reply_delay_ms);
    settings.conveyor.start_delay = from_ms(typed.start_delay_ms);
    if (typed.products > 0) {
        settings.products = typed.products;
    }
    if (typed.exit_when_idle > 0) {
        settings.exit_when_idle = std::chrono::seconds{typed.exit_when_idle};
    }
    set_faults(settings.faults, typed);
}

int fail(const std::string& message) {
    std::cerr << "linefeed-sim: " << message << '\n';
    return exit_failed;
}

/// The summaries on stdout; as JSON too or instead, as ordered: an object, of several printers an array.
int tell(const std::vector<const RunStatistics*>& runs, bool json_wanted, const std::string& json_file) {
    std::string all;
    for (const RunStatistics* one : runs) {
        all.append(all.empty() ? "" : ",\n").append(summary_json(*one));
    }
    if (runs.size() > 1) {
        all = "[" + all + "]";
    }
    if (json_wanted && json_file == "-") {
        std::cout << all << std::endl;
        return 0;
    }
    for (const RunStatistics* one : runs) {
        write_summary(std::cout, *one);
    }
    std::cout.flush();
    if (json_wanted) {
        std::ofstream file{json_file};
        file << all << '\n';
        if (!file.flush()) {
            return fail("cannot write the summary " + json_file);
        }
    }
    return 0;
}

int run(const SimulatorSettings& settings, const Options& typed, bool json_wanted) {
    Fleet fleet{settings, {typed.printers, typed.report.empty() ? std::nullopt : std::optional{typed.report}}};
    const auto addresses = fleet.open();
    if (!addresses) {
        return fail(addresses.error().message);
    }
    for (const std::string& address : *addresses) {
        std::cout << "linefeed-sim: listening on " << address << std::endl;
    }
    const auto ended = fleet.run();
    const int told = tell(fleet.statistics(), json_wanted, typed.summary_json.empty() ? "-" : typed.summary_json);
    const auto reported = fleet.write_report();
    return !ended ? fail(ended.error().message) : !reported ? fail(reported.error().message) : told;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"A JET printer with a conveyor: listens like a printer, prints onto a tape.", "linefeed-sim"};
    Options typed;
    SimulatorSettings settings;
    add_run_options(app, typed, settings);
    add_line_options(app, typed, settings.conveyor);
    add_printer_options(app, typed, settings.printer);
    add_fault_options(app, typed);
    app.add_flag("--commands", typed.commands, "List every command that the printer knows, as Markdown, and end");
    app.set_version_flag("--version", "linefeed-sim " LINEFEED_VERSION);
    try {
        app.parse(argc, argv);
        set_everything(settings, typed, app.count("--print-ms") > 0);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);
        }
        std::cerr << "linefeed-sim: " << error.what() << '\n';
        return exit_usage;
    }
    if (typed.commands) {
        std::cout << protocol::commands_as_markdown();
        return 0;
    }
    try {
        const bool json_wanted = app.count("--summary-json") > 0;
        return run(settings, typed, json_wanted);
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}
