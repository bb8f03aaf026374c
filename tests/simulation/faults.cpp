#include "faults.hpp"

#include <algorithm>
#include <numeric>
#include <string>

namespace linefeed::simulation {

using namespace std::chrono_literals;
using protocol::Action;
using protocol::MachineState;
using simulator::PrinterModel;

Faults::Faults(Context& context, Judge& judge, Line& line, Wire& wire, Host& host, Operator& person, Random random)
    : context_(context)
    , judge_(judge)
    , line_(line)
    , wire_(wire)
    , host_(host)
    , operator_(person)
    , random_(random)
    , left_(context.scenario.faults) {
    if (context.scenario.start_under_fill) {
        start_under_fill();
    }
    schedule();
}

void Faults::schedule() {
    if (left_ > 0) {
        context_.after(random_.spread(context_.scenario.fault_gap.low, context_.scenario.fault_gap.high),
                       EventKind::next_fault);
    }
}

Fault Faults::draw() {
    const auto& weights = context_.scenario.weights;
    std::uint64_t dice = random_.below(std::accumulate(weights.begin(), weights.end(), std::uint64_t{0}));
    std::size_t kind = 0;
    while (dice >= weights[kind]) {
        dice -= weights[kind++];
    }
    return static_cast<Fault>(kind);
}

void Faults::cause_next() {
    const Fault fault = draw();
    --left_;
    if (!operator_.done() && cause(fault)) {
        count(fault);
    }
    schedule();
}

void Faults::count(Fault fault) {
    ++context_.counts.faults[static_cast<std::size_t>(fault)];
    context_.trace.note(context_.now, "fault", static_cast<std::uint64_t>(fault));
    context_.trace.say(context_.now, "fault", to_string(fault));
}

/// Behind a gap, the number tells where the printer is and the counter how much of that it has printed. When the number
/// is lost before linefeed has settled the records, or put down that it has seen a gap, the counter alone would have to
/// tell both: nobody can know.
bool Faults::memory_may_go() {
    gap_ = gap_ && (host_.running() || host_.records_open());
    return !gap_ || (!host_.running() && host_.knows_of_gap());
}

void Faults::excuse_for(Duration duration) {
    excused_until_ = std::max(excused_until_, context_.now + duration + 2s);
}

void Faults::repair_later(Fault fault, Duration low, Duration high, std::uint64_t detail) {
    ++under_repair_;
    context_.after(random_.spread(low, high), EventKind::fault_ends, static_cast<std::uint64_t>(fault), detail);
}

bool Faults::cause(Fault fault) {
    switch (fault) {
    case Fault::operator_stop:
    case Fault::stop_and_go:
    case Fault::stop_under_refill:
    case Fault::panel_start:
    case Fault::start_between_looks:
    case Fault::printer_error:
    case Fault::cover_opened:
    case Fault::nozzle_closed:
    case Fault::printer_restart:
    case Fault::another_printer:
    case Fault::belt_pause:
    case Fault::start_under_fill:
        return cause_at_printer(fault);
    case Fault::another_job:
    case Fault::second_client:
    case Fault::foreign_stop:
    case Fault::foreign_flush:
    case Fault::foreign_stop_point:
    case Fault::foreign_record:
        return cause_by_others(fault);
    case Fault::stop_by_linefeed:
    case Fault::process_kill:
    case Fault::kill_in_step:
    case Fault::host_power_loss:
    case Fault::both_power_loss:
    case Fault::host_pause:
    case Fault::slow_disk:
    case Fault::disk_full:
        return cause_at_host(fault);
    case Fault::link_cut:
    case Fault::link_silent:
    case Fault::link_stall:
        return cause_on_the_way(fault);
    }
    return false;
}

bool Faults::cause_at_printer(Fault fault) {
    const PrinterModel& printer = line_.look();
    const bool printing = printer.printing();
    const auto press = [this](Action action) {
        line_.act([action](PrinterModel& model, Instant now) { model.press(action, now); });
    };
    switch (fault) {
    case Fault::operator_stop:
        press(Action::stop_print);
        return printing;
    case Fault::stop_and_go:
        if (printing) {
            press(Action::stop_print);
            stopped_at_ = context_.now;
            repair_later(fault, 1ms, 2s);
            gap_ = true;
        }
        return printing;
    case Fault::stop_under_refill:
        stop_under_refill();
        return false; // counted when it happens
    case Fault::start_between_looks:
        start_between_looks();
        return false; // counted when it happens
    case Fault::panel_start: {
        // Nobody starts the line while the operator is asked what is on the last product.
        const bool may = !printing && host_.ending().in_doubt.empty();
        if (may) {
            press(Action::start_print);
            excuse_for(5s);
            gap_ = gap_ || host_.running();
        }
        return may;
    }
    case Fault::printer_error:
        line_.act([](PrinterModel& model, Instant now) { model.raise_error(10202, now); });
        return true;
    case Fault::cover_opened:
        line_.act([](PrinterModel& model, Instant now) { model.open_cover(now); });
        return true;
    case Fault::nozzle_closed:
        press(Action::nozzle_close);
        return true;
    case Fault::printer_restart:
        if (!memory_may_go()) {
            return false;
        }
        line_.act([](PrinterModel& model, Instant now) { model.power_cycle(now); });
        return true;
    case Fault::another_printer:
        if (!memory_may_go()) {
            return false;
        }
        line_.exchange_printer();
        if (random_.chance(0.5)) {
            repair_later(fault, 1s, 200s);
        }
        return true;
    case Fault::belt_pause:
        line_.pause_belt(random_.spread(Duration{10ms}, Duration{60s}));
        return true;
    default:
        return false;
    }
}

/// Stop, and GO again, with records on the way between the two: the printer goes on behind those that it has thrown
/// away.
void Faults::stop_under_refill() {
    line_.at(Line::Moment::record_while_printing, some_records(), context_.now + 10s, [this] {
        count(Fault::stop_under_refill);
        gap_ = true;
        line_.act([](PrinterModel& model, Instant now) { model.press(Action::stop_print, now); });
        stopped_at_ = context_.now;
        repair_later(Fault::stop_under_refill, 1ms, 600ms);
    });
}

/// A part of the first fill is thrown away before linefeed starts the printer.
void Faults::start_under_fill() {
    line_.at(Line::Moment::record, some_records(), context_.now + 300s, [this] {
        if (!line_.look().printing()) {
            count(Fault::start_under_fill);
            gap_ = true;
            line_.act([](PrinterModel& model, Instant now) {
                model.press(Action::start_print, now);
                model.press(Action::stop_print, now);
            });
        }
    });
}

/// While linefeed looks at what an interruption has left in the FIFO, somebody starts the printer, and stops it again.
void Faults::start_between_looks() {
    line_.at(Line::Moment::count_over_records, 0, context_.now + 120s, [this] {
        count(Fault::start_between_looks);
        gap_ = true;
        line_.act([](PrinterModel& model, Instant now) { model.press(Action::start_print, now); });
        excuse_for(5s);
        const Duration first_product = std::max<Duration>(20ms, context_.scenario.period);
        repair_later(Fault::start_between_looks, first_product, first_product * 3);
    });
}

std::uint64_t Faults::some_records() {
    return random_.chance(0.5) ? 0 : random_.below(context_.scenario.printer.depth);
}

/// Stop and GO behind each other take a hand a while. In mid-print, behind an empty FIFO and on a firmware without stop
/// point, only `=RS` shows that the machine stood.
bool Faults::too_fast_for_a_hand(Fault fault) {
    constexpr Duration least = 400ms;
    const Duration standing = context_.now - stopped_at_;
    if (line_.look().mail_status().last_print_finished || standing >= least) {
        return false;
    }
    ++under_repair_;
    context_.after(least - standing, EventKind::fault_ends, static_cast<std::uint64_t>(fault), 0);
    return true;
}

void Faults::repair(Fault fault, std::uint64_t) {
    --under_repair_;
    context_.trace.note(context_.now, "repair", static_cast<std::uint64_t>(fault));
    switch (fault) {
    case Fault::stop_and_go:
    case Fault::stop_under_refill:
        if (too_fast_for_a_hand(fault)) {
            return;
        }
        line_.act([](PrinterModel& model, Instant now) { model.press(Action::start_print, now); });
        excuse_for(1h); // what was in the FIFO is gone, and a slow line notices it late
        return;
    case Fault::start_between_looks:
        line_.act([](PrinterModel& model, Instant now) { model.press(Action::stop_print, now); });
        return;
    case Fault::another_printer:
        if (memory_may_go()) {
            line_.exchange_printer();
        } else {
            repair_later(fault, 1s, 200s);
        }
        return;
    case Fault::host_power_loss:
    case Fault::both_power_loss:
        operator_.set_host_power(true);
        return;
    case Fault::disk_full:
        RamDisk::instance().set_full(false);
        return;
    case Fault::slow_disk:
        if (host_.running()) {
            host_.kill();
            count(Fault::process_kill);
        }
        return;
    case Fault::link_cut:
    case Fault::link_silent:
        wire_.set_down(false);
        return;
    default:
        return;
    }
}

} // namespace linefeed::simulation
