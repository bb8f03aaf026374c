// The whole machine behind linefeed-sim: printer model, conveyor, network side, tape and the faults ordered for the
// run, in one thread of an io_context (the tape's writer has its own).
#pragma once

#include "simulator/conveyor.hpp"
#include "simulator/fault.hpp"
#include "simulator/lead_time_log.hpp"
#include "simulator/printer_model.hpp"
#include "simulator/run_statistics.hpp"
#include "simulator/server.hpp"
#include "simulator/tape.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::simulator {

/// One run of the simulator.
struct SimulatorSettings {
    PrinterSettings printer;
    ConveyorSettings conveyor;
    ServerSettings server;
    std::string host = "127.0.0.1";
    std::string port = "3000";
    protocol::Charset charset = protocol::Charset::latin1; ///< how the job's font reads the bytes, for the tape
    std::optional<std::string> tape;
    std::optional<std::uint64_t>
        products; ///< the conveyor stops after so many PrintGos that found the printer printing
    std::optional<std::chrono::seconds> exit_when_idle; ///< ends after so long without a connection
    std::vector<Fault> faults;
    /// For benchmarks: every lead time is kept, PrintGos keep to their grid whatever stalls, and a product for which no
    /// record is there in time passes unprinted and is counted, where a real line would stop with 5043.
    bool count_misses = false;
};

/// Flow: open(), announce the address, run() until a signal (or idleness) ends it, then statistics(). Several on one
/// io_context: open() and start() each, run the context, finish() each.
class Simulator : private ServerHandler {
public:
    explicit Simulator(SimulatorSettings settings);
    /// Runs in the thread of `io`, which outlives it.
    Simulator(SimulatorSettings settings, boost::asio::io_context& io);

    /// Opens tape and socket; the address it listens on. From then on SIGINT and SIGTERM end it.
    [[nodiscard]] Result<std::string> open();
    /// Serves until SIGINT or SIGTERM. The failure if the tape is not complete.
    [[nodiscard]] Result<void> run();
    /// Begins to serve; a signal (or idleness) stops the io_context.
    void start();
    /// The io_context has ended. The failure if the tape is not complete.
    [[nodiscard]] Result<void> finish();
    [[nodiscard]] const RunStatistics& statistics() const { return statistics_; }
    /// Null unless misses are counted.
    [[nodiscard]] LeadTimeLog* lead_times() { return lead_times_ ? &*lead_times_ : nullptr; }

private:
    Simulator(SimulatorSettings settings, std::unique_ptr<boost::asio::io_context> own_io);

    void on_connected(ConnectionId connection) override;
    void on_frame(ConnectionId connection, const protocol::Frame& frame, Instant now) override;
    void on_damaged_bytes(ConnectionId connection) override;
    void on_disconnected(ConnectionId connection) override;

    void carry_out(Instant now);
    void carry_out_one(Effect& effect);
    void record(const Printed& print);
    [[nodiscard]] bool is_due(const Moment& moment, Instant now) const;
    void cause_due_faults(Instant now);
    void cause(const Deed& deed, Instant now);
    void wait_for_fault();
    void move_conveyor(Instant now);
    void wait_for_product();
    void product_at_sensor();
    [[nodiscard]] bool counted_as_miss(Instant now, Instant due);
    void wait_for_model();
    void wait_for_idleness();
    void shut_down();

    SimulatorSettings settings_;
    std::unique_ptr<boost::asio::io_context> own_io_;
    boost::asio::io_context& io_;
    PrinterModel model_;
    Conveyor conveyor_;
    Server server_;
    std::unique_ptr<Tape> tape_;
    RunStatistics statistics_;
    std::optional<LeadTimeLog> lead_times_;
    std::vector<Effect> effects_;
    boost::asio::steady_timer conveyor_timer_{io_};
    boost::asio::steady_timer model_timer_{io_};
    boost::asio::steady_timer idle_timer_{io_};
    boost::asio::steady_timer fault_timer_{io_};
    boost::asio::signal_set signals_{io_};
    std::int64_t wall_minus_steady_ns_ = 0;
    std::optional<Instant> model_timer_due_;
    std::optional<Instant> conveyor_timer_due_;
    Instant started_{};
    std::uint64_t frames_ = 0;   ///< received
    std::uint64_t products_ = 0; ///< PrintGos that found the printer printing
    bool muted_ = false;
};

} // namespace linefeed::simulator
