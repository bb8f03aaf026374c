// What happens when, see simulator.hpp.
#include "simulator/simulator.hpp"

#include "simulator/steady_instant.hpp"

#include <csignal>
#include <utility>

namespace linefeed::simulator {
namespace {

/// Room for so many lead times is made before the run.
constexpr std::size_t kept_lead_times = 1U << 20U;

using boost::system::error_code;

/// What to add to the monotonic clock to get the wall clock, taken once: the tape's times never jump.
std::int64_t wall_minus_steady_ns() {
    const auto wall = std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch());
    return (wall - steady_now().time_since_epoch()).count();
}

/// The printer's clock shows local wall time in UTC: what it must show at Instant{} to be right now.
PrinterSettings with_wall_clock(PrinterSettings settings) {
    settings.clock_at_zero =
        std::chrono::floor<std::chrono::seconds>(std::chrono::sys_time<Duration>{Duration{wall_minus_steady_ns()}});
    return settings;
}

} // namespace

Simulator::Simulator(SimulatorSettings settings)
    : Simulator(std::move(settings), std::make_unique<boost::asio::io_context>(1)) {}

Simulator::Simulator(SimulatorSettings settings, std::unique_ptr<boost::asio::io_context> own_io)
    : Simulator(std::move(settings), *own_io) {
    own_io_ = std::move(own_io);
}

Simulator::Simulator(SimulatorSettings settings, boost::asio::io_context& io)
    : settings_(std::move(settings))
    , io_(io)
    , model_(with_wall_clock(settings_.printer), steady_now())
    , conveyor_(settings_.conveyor)
    , server_(io_, *this, settings_.server) {
    wall_minus_steady_ns_ = wall_minus_steady_ns();
    statistics_.depth = settings_.printer.depth;
    if (settings_.count_misses) {
        lead_times_.emplace(settings_.printer.depth, kept_lead_times);
    }
}

Result<std::string> Simulator::open() {
    const auto line = server_.open_serial();
    if (!line) {
        return line.error();
    }
    auto address = server_.listen(settings_.host, settings_.port);
    if (address && settings_.tape) {
        auto tape = Tape::open(*settings_.tape);
        if (!tape) {
            return tape.error();
        }
        tape_ = std::move(*tape);
    }
    signals_.add(SIGINT);
    signals_.add(SIGTERM);
    signals_.async_wait([this](const error_code& error, int) {
        if (!error) {
            shut_down();
        }
    });
    return address;
}

Result<void> Simulator::run() {
    start();
    io_.run();
    return finish();
}

void Simulator::start() {
    started_ = steady_now();
    wait_for_idleness();
    wait_for_fault();
    move_conveyor(started_);
}

Result<void> Simulator::finish() {
    statistics_.platform_stalls = conveyor_.stalls();
    statistics_.longest_stall = conveyor_.longest_stall();
    return tape_ ? tape_->close() : Result<void>{};
}

void Simulator::shut_down() {
    server_.close();
    conveyor_.halt();
    conveyor_timer_.cancel();
    model_timer_.cancel();
    idle_timer_.cancel();
    fault_timer_.cancel();
    signals_.cancel();
    io_.stop();
}

void Simulator::on_connected(ConnectionId) {
    ++statistics_.connections;
    idle_timer_.cancel();
}

void Simulator::on_frame(ConnectionId connection, const protocol::Frame& frame, Instant now) {
    ++frames_;
    cause_due_faults(now); // before the frame that is counted takes effect
    const bool was_empty = model_.fifo().records() == 0;
    model_.receive(connection, frame, now);
    if (lead_times_ && was_empty && model_.fifo().records() > 0) {
        lead_times_->arrived(now);
    }
    statistics_.note_fill(model_.fifo().records());
    carry_out(now);
}

void Simulator::on_damaged_bytes(ConnectionId) {
    ++statistics_.bad_frames;
}

void Simulator::on_disconnected(ConnectionId connection) {
    if (!Server::is_serial(connection)) { // a printer cannot tell who holds the other end of a serial line
        model_.disconnected(connection);
    }
    if (server_.connections() == 0) {
        wait_for_idleness();
    }
}

void Simulator::carry_out(Instant now) {
    // A fault acts on the model again, which then has more effects.
    while (!model_.effects().empty()) {
        model_.take_effects(effects_);
        for (Effect& effect : effects_) {
            carry_out_one(effect);
        }
        cause_due_faults(now);
    }
    move_conveyor(now);
    wait_for_model();
}

void Simulator::carry_out_one(Effect& effect) {
    if (auto* reply = std::get_if<Reply>(&effect)) {
        if (!muted_) {
            server_.send(reply->connection, std::move(reply->bytes));
        }
    } else if (const auto* print = std::get_if<Printed>(&effect)) {
        record(*print);
    } else if (std::holds_alternative<PrintAborted>(effect)) {
        ++statistics_.aborted;
    } else if (const auto* underrun = std::get_if<Underrun>(&effect)) {
        statistics_.add(*underrun);
    } else if (const auto* error = std::get_if<ErrorRaised>(&effect)) {
        statistics_.add(*error);
    } else if (std::holds_alternative<ConnectionsLost>(effect)) {
        server_.close_connections();
    }
}

void Simulator::record(const Printed& print) {
    statistics_.add(print);
    if (lead_times_ && print.lead_time) {
        lead_times_->printed(print.time, *print.lead_time);
    }
    if (tape_) {
        const std::int64_t time_ns = wall_minus_steady_ns_ + print.time.time_since_epoch().count();
        tape_->write(tape_line(time_ns, print.number, to_utf8(print.text, settings_.charset)));
    }
}

void Simulator::move_conveyor(Instant now) {
    const bool products_left = !settings_.products || products_ < *settings_.products;
    if (products_left && (settings_.conveyor.free_running || model_.printing())) {
        conveyor_.start(now);
    } else {
        conveyor_.halt();
    }
    if (conveyor_.due() != conveyor_timer_due_) {
        wait_for_product();
    }
}

void Simulator::wait_for_product() {
    conveyor_timer_due_ = conveyor_.due();
    if (!conveyor_timer_due_) {
        conveyor_timer_.cancel();
        return;
    }
    conveyor_timer_.expires_at(to_steady(*conveyor_timer_due_));
    conveyor_timer_.async_wait([this](const error_code& error) {
        if (!error && conveyor_timer_due_) {
            product_at_sensor();
        }
    });
}

void Simulator::product_at_sensor() {
    // What has arrived is read first: it was there before the product.
    server_.read_available();
    const Instant now = steady_now();
    const auto due = conveyor_.due();
    if (!due || *due > now) {
        return; // what was read stopped the line or started it anew; its timer is set
    }
    if (lead_times_ && counted_as_miss(now, *due)) {
        carry_out(now);
        return;
    }
    if (!lead_times_ && conveyor_.stalled(now) && model_.printing() && !model_.record_ready(now)) {
        conveyor_.postpone(now, settings_.printer.margin);
        wait_for_product();
        return;
    }
    const std::uint32_t fill = model_.fifo().records();
    const PrintGoOutcome outcome = model_.print_go(now);
    conveyor_.passed(now);
    if (outcome != PrintGoOutcome::printed) {
        ++statistics_.unprinted_products;
    }
    if (outcome != PrintGoOutcome::not_printing) {
        ++products_;
        statistics_.note_fill_at_print_go(fill);
    }
    carry_out(now);
}

/// Whether the product passes unprinted because no record is there in time.
bool Simulator::counted_as_miss(Instant now, Instant due) {
    if (conveyor_.stalled(now)) {
        lead_times_->late(due, now);
    }
    model_.advance(now); // the print before it may end the printing
    if (!model_.printing() || model_.record_ready(now)) {
        return false;
    }
    const MailSlot* loaded = model_.fifo().loaded();
    lead_times_->missed(now, now - due, loaded == nullptr ? std::nullopt : std::optional{loaded->arrived});
    ++statistics_.unprinted_products;
    ++products_;
    conveyor_.passed(now);
    return true;
}

void Simulator::wait_for_model() {
    const auto due = model_.next_event();
    if (due == model_timer_due_) {
        return;
    }
    model_timer_due_ = due;
    if (!due) {
        model_timer_.cancel();
        return;
    }
    model_timer_.expires_at(to_steady(*due));
    model_timer_.async_wait([this](const error_code& error) {
        if (error) {
            return;
        }
        model_timer_due_.reset();
        const Instant now = steady_now();
        model_.advance(now);
        carry_out(now);
        wait_for_model();
    });
}

void Simulator::wait_for_idleness() {
    if (!settings_.exit_when_idle) {
        return;
    }
    idle_timer_.expires_after(*settings_.exit_when_idle);
    idle_timer_.async_wait([this](const error_code& error) {
        if (!error && server_.connections() == 0) {
            shut_down();
        }
    });
}

} // namespace linefeed::simulator
