// What one seed means: the job, the printer, the line, the network, the disk, and which faults come how often. Swarm
// testing: each seed switches most faults off and draws the weights of the rest, so that rare combinations come up.
#pragma once

#include "base/time.hpp"
#include "simulator/printer_settings.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::simulation {

/// What can go wrong.
enum class Fault : std::uint8_t {
    operator_stop,       ///< print-ready is switched off at the panel
    stop_and_go,         ///< off, and on again at once
    stop_under_refill,   ///< the same, exactly when records are about to arrive
    panel_start,         ///< somebody presses GO while linefeed does not print
    start_between_looks, ///< while linefeed finds out what an interruption has left in the FIFO
    stop_by_linefeed,    ///< Ctrl-C
    printer_error,
    cover_opened,
    nozzle_closed,
    printer_restart, ///< power off and on: FIFO, `=CM`, number lost, counter kept
    another_job,     ///< another host prints a job on it while linefeed is away
    another_printer, ///< a different one stands at the address
    second_client,   ///< asks and switches modes at the same time
    // The second client interferes:
    foreign_stop,       ///< `!ST`
    foreign_flush,      ///< `!FF` in mid-run
    foreign_stop_point, ///< `=CM`, lower or higher
    foreign_record,     ///< `=MR`, out of order or in our place
    process_kill,
    kill_in_step, ///< between two effects of one step
    host_power_loss,
    both_power_loss,
    link_cut,    ///< announced: reset
    link_silent, ///< no byte comes through any more
    link_stall,  ///< bytes come late, but come
    host_pause,  ///< the process gets no time
    slow_disk,   ///< sometimes the program is killed over it
    disk_full,
    belt_pause,
    start_under_fill, ///< started and stopped at the panel as the first records arrive; not drawn by weight
};
inline constexpr std::size_t fault_kinds = static_cast<std::size_t>(Fault::start_under_fill) + 1;
inline constexpr std::size_t weighted_faults = static_cast<std::size_t>(Fault::start_under_fill);
[[nodiscard]] std::string_view to_string(Fault fault);

/// A stretch of time to draw from.
struct Span {
    Duration low{1};
    Duration high{1};
};

/// A part of the records that is a job of its own. The records of all jobs have consecutive ids, which stand on the
/// products; the numbers begin anew with each.
struct ScenarioJob {
    std::uint32_t first = 0; ///< id
    std::uint32_t last = 0;
    std::uint32_t behind = 0; ///< number = id − behind

    [[nodiscard]] bool has(std::uint32_t id) const { return first <= id && id <= last; }
};

struct Scenario {
    std::uint64_t seed = 0;
    // The job, or several in a queue
    std::vector<ScenarioJob> jobs{};
    std::uint32_t base = 0;
    std::uint32_t records = 100;
    std::uint32_t page_records = 512;
    bool two_fields = false;
    // The line
    Duration period = std::chrono::milliseconds{10};
    Duration period_jitter{0};
    bool bursts = false;
    simulator::PrinterSettings printer;
    // The network
    Span latency{std::chrono::microseconds{100}, std::chrono::microseconds{200}};
    double split = 0; ///< probability that a piece of bytes arrives in several parts
    double slow_write = 0;
    bool crc = false;  ///< frames are secured by CRC32, and the damage is whatever it likes
    double damage = 0; ///< probability that a piece of bytes arrives with one lost or damaged (serial)
    // The disk
    Span commit{std::chrono::microseconds{100}, std::chrono::milliseconds{5}};
    Duration gather = std::chrono::milliseconds{10};
    // Faults
    std::array<std::uint32_t, weighted_faults> weights{};
    std::uint32_t faults = 0; ///< so many, then everything is repaired
    Span fault_gap{std::chrono::milliseconds{1}, std::chrono::seconds{10}};
    bool start_under_fill = false;
    // The operator
    bool open_nozzle = false;
    std::uint32_t skips_percent = 0; ///< of his decisions about records in doubt
    std::uint32_t reprints_percent = 0;

    /// The total print counter tells how many records a printer has thrown away when it goes on behind them.
    [[nodiscard]] bool prints_are_counted() const { return !printer.habits.no_total_counter; }
    /// Or the stop point, which a stop wipes out, shows that it has thrown some away.
    [[nodiscard]] bool gap_would_show() const {
        return prints_are_counted() || !(printer.habits.ignore_stop_at || printer.habits.stop_at_only_while_printing);
    }
    /// Network, disk and the beat of the feeder leave no excuse for an underrun.
    [[nodiscard]] bool supply_is_sufficient() const;
    /// The longest that a first record needs from the takeover of a printer to its PrintGo: ledger, way and margin.
    [[nodiscard]] Duration first_refill() const;
    /// What stands on the product of a record: the fields joined by TAB.
    void text_of(std::uint32_t id, std::string& out) const;
    [[nodiscard]] std::uint32_t first() const { return base + 1; }
    [[nodiscard]] std::uint32_t last() const { return base + records; }
};

/// Which family of scenarios.
enum class Profile {
    mixed,   ///< everything
    counted, ///< the same, but every printer has its total print counter
    chained, ///< everything but foreign records, with several jobs, each of which may follow without a stop
    secured, ///< everything, with CRC32, and noise that spares no byte
    line,    ///< 1 000 prints/s without faults: measures the speed of the simulation
};

[[nodiscard]] Scenario draw_scenario(std::uint64_t seed, Profile profile);

} // namespace linefeed::simulation
