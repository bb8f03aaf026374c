// The command line of linefeed-sim: what can be typed, and the settings that it amounts to.
#pragma once

#include "simulator/simulator.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace linefeed::simulator {

/// The options as they are typed.
struct SimOptions {
    std::string listen = "127.0.0.1:3000";
    std::string serial;
    std::uint32_t baud = 115200;
    std::uint64_t damage = 0;
    std::uint64_t loss = 0;
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

/// Declares every option. Values that need no more than a check go straight into `settings`.
void add_options(CLI::App& app, SimOptions& typed, SimulatorSettings& settings);

/// Completes `settings` from what was typed. Throws CLI::ValidationError, which names the option and what was expected.
void apply_options(SimulatorSettings& settings, const SimOptions& typed, bool print_ms_typed);

} // namespace linefeed::simulator
