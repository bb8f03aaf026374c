// linefeed-sim: a JET printer with a conveyor, for training, tests and acceptance without hardware. Reads the command
// line, runs the simulator, tells the summary. Exit codes: 0 done, 1 cannot run, 2 usage.
#include "protocol/command_help.hpp"
#include "simulator/fleet.hpp"
#include "simulator/sim_options.hpp"

#include <CLI/CLI.hpp>

#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace linefeed;
using namespace linefeed::simulator;

constexpr int exit_failed = 1;
constexpr int exit_usage = 2;

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

int run(const SimulatorSettings& settings, const SimOptions& typed, bool json_wanted) {
    Fleet fleet{settings, {typed.printers, typed.report.empty() ? std::nullopt : std::optional{typed.report}}};
    const auto addresses = fleet.open();
    if (!addresses) {
        return fail(addresses.error().message);
    }
    for (const std::string& address : *addresses) {
        std::cout << "linefeed-sim: listening on " << address << std::endl;
    }
    if (settings.server.serial) {
        std::cout << "linefeed-sim: serial line at " << settings.server.serial->link << ", "
                  << settings.server.serial->baud << " baud" << std::endl;
    }
    const auto ended = fleet.run();
    const int told = tell(fleet.statistics(), json_wanted, typed.summary_json.empty() ? "-" : typed.summary_json);
    const auto reported = fleet.write_report();
    return !ended ? fail(ended.error().message) : !reported ? fail(reported.error().message) : told;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"A JET printer with a conveyor: listens like a printer, prints onto a tape.", "linefeed-sim"};
    SimOptions typed;
    SimulatorSettings settings;
    add_options(app, typed, settings);
    app.add_flag("--commands", typed.commands, "List every command that the printer knows, as Markdown, and end");
    app.set_version_flag("--version", "linefeed-sim " LINEFEED_VERSION);
    try {
        app.parse(argc, argv);
        apply_options(settings, typed, app.count("--print-ms") > 0);
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
