// Several printers, each with its conveyor, on consecutive ports in one thread of one process: what a service with many
// printers is measured against. One printer is a fleet of one.
#pragma once

#include "simulator/hiccup_watch.hpp"
#include "simulator/simulator.hpp"

#include <memory>
#include <string>
#include <vector>

namespace linefeed::simulator {

/// What a fleet has besides its printers.
struct FleetSettings {
    unsigned printers = 1;             ///< on consecutive ports from the port set (0: any free ones)
    std::optional<std::string> report; ///< JSON file of lead times, misses and stalls
};

/// Flow: open(), announce the addresses, run() until a signal (or idleness) ends it, then statistics(), write_report().
class Fleet {
public:
    Fleet(const SimulatorSettings& settings, FleetSettings fleet);

    /// The addresses, in the order of the printers.
    [[nodiscard]] Result<std::vector<std::string>> open();
    /// SIGUSR1 writes how far it is to stdout, as one line of JSON: prints, misses.
    [[nodiscard]] Result<void> run();
    [[nodiscard]] std::vector<const RunStatistics*> statistics() const;
    /// Writes the report, if one is wanted.
    [[nodiscard]] Result<void> write_report();

private:
    void wait_for_question();

    FleetSettings settings_;
    boost::asio::io_context io_{1};
    boost::asio::signal_set questions_{io_};
    std::vector<std::unique_ptr<Simulator>> simulators_;
    HiccupWatch hiccups_;
};

} // namespace linefeed::simulator
