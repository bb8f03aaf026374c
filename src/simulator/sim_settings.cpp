// From what was typed to the settings of the simulator, see sim_options.hpp.
#include "protocol/decimal.hpp"
#include "simulator/sim_options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <utility>

namespace linefeed::simulator {
namespace {

Duration from_ms(double ms) {
    return std::chrono::duration_cast<Duration>(std::chrono::duration<double, std::milli>{ms});
}

/// Throws what CLI11 reports as a usage error.
[[noreturn]] void refuse(const std::string& option, const std::string& reason) {
    throw CLI::ValidationError(option, reason);
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
    std::ifstream file{path, std::ios::binary};
    std::string text;
    std::array<char, 4096> buffer{};
    while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    }
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

void set_profile(PrinterSettings& printer, const SimOptions& typed) {
    const auto profile = protocol::parse_profile(typed.profile);
    if (!profile || protocol::is_automatic(*profile)) {
        refuse("--profile", profile ? "jet3, jet3up, jet2neo or jet2neo-v71 expected: it is the printer that tells"
                                    : profile.error().message);
    }
    printer.profile = *profile;
    if (!printer.firmware.empty()) {
        const auto of_version = protocol::profile_for(versions_of(printer).type, printer.firmware);
        if (!of_version || printer.firmware.find_first_of("\t\r\n^\\") != std::string::npos) {
            refuse("--firmware", "a version expected, e.g. V60.0.1.17, not \"" + printer.firmware + "\"");
        }
        printer.profile = with_own_properties(*of_version, profile->own);
    }
}

void set_printer(PrinterSettings& printer, const SimOptions& typed, const ConveyorSettings& conveyor,
                 bool print_ms_typed) {
    set_profile(printer, typed);
    printer.block_errors.seed = conveyor.seed;
    for (const std::string& text : typed.counters) {
        printer.counters.push_back(counter_of(text));
    }
    for (const std::string& text : typed.input_functions) {
        set_input_function(printer, text);
    }
    printer.habits = habits_of_version(printer);
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

void set_faults(std::vector<Fault>& faults, const SimOptions& typed) {
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

} // namespace

void apply_options(SimulatorSettings& settings, const SimOptions& typed, bool print_ms_typed) {
    set_address(settings, typed.listen);
    set_printer(settings.printer, typed, settings.conveyor, print_ms_typed);
    const auto charset = protocol::charset_from_name(typed.charset);
    if (!charset) {
        refuse("--charset", "latin1, windows-1252 or unicode-hex expected, not \"" + typed.charset + "\"");
    }
    settings.charset = *charset;
    settings.count_misses = settings.conveyor.keeps_grid = !typed.report.empty();
    if (typed.printers > 1 && !typed.serial.empty()) {
        refuse("--printers", "more than one exclude --serial");
    }
    if (typed.printers > 1 && (settings.tape || typed.exit_when_idle > 0)) {
        refuse("--printers", "more than one exclude --tape and --exit-when-idle");
    }
    settings.server.escapes = settings.printer.profile.escapes;
    settings.server.reply_delay = from_ms(typed.reply_delay_ms);
    if (!typed.serial.empty()) {
        settings.server.serial = SerialSettings{.link = typed.serial,
                                                .baud = typed.baud,
                                                .one_damaged_in = typed.damage,
                                                .one_lost_in = typed.loss,
                                                .seed = settings.conveyor.seed};
    }
    settings.conveyor.start_delay = from_ms(typed.start_delay_ms);
    if (typed.products > 0) {
        settings.products = typed.products;
    }
    if (typed.exit_when_idle > 0) {
        settings.exit_when_idle = std::chrono::seconds{typed.exit_when_idle};
    }
    set_faults(settings.faults, typed);
}

} // namespace linefeed::simulator
