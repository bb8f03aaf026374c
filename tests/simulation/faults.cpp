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
        ++context_.counts.faults[static_cast<std::size_t>(fault)];
        context_.trace.note(context_.now, "fault", static_cast<std::uint64_t>(fault));
        context_.trace.say(context_.now, "fault", to_string(fault));
    }
    schedule();
}

void Faults::excuse_for(Duration duration) {
    excused_until_ = std::max(excused_until_, context_.now + duration + 2s);
}

void Faults::repair_later(Fault fault, Duration low, Duration high, std::uint64_t detail) {
    ++under_repair_;
    context_.after(random_.spread(low, high), EventKind::fault_ends, static_cast<std::uint64_t>(fault), detail);
}

bool Faults::two_disasters(bool& this_one, bool other_one) {
    if (host_.running() && host_.phase() == feeder::Phase::printing && interruption_ != context_.counts.runs) {
        interruption_ = context_.counts.runs;
        memory_lost_ = others_printed_ = false;
        other_one = false;
    }
    this_one = this_one || !other_one;
    return other_one;
}

bool Faults::cause(Fault fault) {
    switch (fault) {
    case Fault::operator_stop:
    case Fault::stop_and_go:
    case Fault::panel_start:
    case Fault::printer_error:
    case Fault::cover_opened:
    case Fault::nozzle_closed:
    case Fault::printer_restart:
    case Fault::another_job:
    case Fault::another_printer:
    case Fault::second_client:
    case Fault::belt_pause:
        return cause_at_printer(fault);
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
            repair_later(fault, 1ms, 2s);
        }
        return printing;
    case Fault::panel_start: {
        // Nobody starts the line while the operator is asked what is on the last product.
        const bool may = !printing && host_.ending().in_doubt.empty();
        if (may) {
            press(Action::start_print);
            excuse_for(5s);
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
        if (two_disasters(memory_lost_, others_printed_)) {
            return false;
        }
        line_.act([](PrinterModel& model, Instant now) { model.power_cycle(now); });
        return true;
    case Fault::another_job:
        return another_job();
    case Fault::another_printer:
        line_.exchange_printer();
        if (random_.chance(0.5)) {
            repair_later(fault, 1s, 200s);
        }
        return true;
    case Fault::second_client:
        ask_as_second_client();
        return true;
    case Fault::belt_pause:
        line_.pause_belt(random_.spread(Duration{10ms}, Duration{60s}));
        return true;
    default:
        return false;
    }
}

bool Faults::another_job() {
    const auto status = line_.look().machine_status();
    if (host_.running() || status.machine != MachineState::ready_to_print || !host_.ending().in_doubt.empty() ||
        two_disasters(others_printed_, memory_lost_)) {
        return false;
    }
    const auto count = static_cast<std::uint32_t>(random_.spread(1, context_.scenario.printer.depth - 1));
    // Numbers that by chance continue ours exactly would tell even an expert nothing: they start anywhere else.
    const std::uint32_t first = random_.chance(0.5) ? 1 : static_cast<std::uint32_t>(random_.spread(2, 1U << 30U));
    line_.another_job(first, count);
    return true;
}

void Faults::ask_as_second_client() {
    static constexpr const char* frames[]{"^0?SM", "^0?SM", "^0?RS", "^0?CC", "^0?VS",
                                          "^0!LN", "^0!EM", "^0!EQ", "^0!US", "^0?EL"};
    for (std::uint64_t i = random_.between(1, 8); i > 0; --i) {
        line_.other_client(frames[random_.below(std::size(frames))]);
    }
}

void Faults::repair(Fault fault, std::uint64_t) {
    --under_repair_;
    context_.trace.note(context_.now, "repair", static_cast<std::uint64_t>(fault));
    switch (fault) {
    case Fault::stop_and_go:
        line_.act([](PrinterModel& model, Instant now) { model.press(Action::start_print, now); });
        excuse_for(5s); // what was in the FIFO is gone
        return;
    case Fault::another_printer:
        line_.exchange_printer();
        return;
    case Fault::host_power_loss:
    case Fault::both_power_loss:
        operator_.set_host_power(true);
        return;
    case Fault::disk_full:
        RamDisk::instance().set_full(false);
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
