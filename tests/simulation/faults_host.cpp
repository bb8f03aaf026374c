// Faults of the host and of the network.
#include "faults.hpp"

#include <algorithm>

namespace linefeed::simulation {

using namespace std::chrono_literals;
using simulator::PrinterModel;

bool Faults::cause_at_host(Fault fault) {
    const bool running = host_.running();
    switch (fault) {
    case Fault::stop_by_linefeed:
        host_.request_stop();
        return running;
    case Fault::process_kill:
        if (random_.chance(0.4)) {
            return kill_under_fill();
        }
        host_.kill();
        return running;
    case Fault::kill_in_step:
        host_.kill(random_.between(1, 12));
        return running;
    case Fault::both_power_loss:
        if (!memory_may_go()) {
            return false;
        }
        line_.act([](PrinterModel& model, Instant now) { model.power_cycle(now); });
        [[fallthrough]];
    case Fault::host_power_loss:
        host_.lose_power();
        operator_.set_host_power(false);
        repair_later(fault, 5s, 200s);
        return true;
    case Fault::host_pause: {
        if (line_.others_interfere()) {
            return false; // gap_would_show() counts on answers in time
        }
        const Duration duration = random_.spread(Duration{1ms}, Duration{5s});
        answers_late_until_ = std::max(answers_late_until_, context_.now + duration + 1s);
        host_.pause(duration);
        excuse_for(duration);
        return running;
    }
    case Fault::slow_disk: {
        // As long as some records take, or as the printer needs to empty its FIFO several times.
        const Scenario& scenario = context_.scenario;
        const Duration fifo_time = scenario.period * static_cast<std::int64_t>(scenario.printer.depth);
        const Duration duration =
            random_.chance(0.5) ? random_.spread(Duration{10ms}, Duration{10s})
                                : std::clamp<Duration>(fifo_time * static_cast<int>(random_.between(2, 12)), 10ms, 60s);
        host_.slow_disk(duration);
        excuse_for(duration * 2);
        if (running && random_.chance(0.5)) { // the program hangs, and somebody kills it
            repair_later(fault, duration / 2, duration);
        }
        return running;
    }
    case Fault::disk_full:
        RamDisk::instance().set_full(true);
        repair_later(fault, 10ms, 100s);
        return true;
    default:
        return false;
    }
}

/// The process dies while records of it reach the printer; it counts when it happens.
bool Faults::kill_under_fill() {
    line_.at(Line::Moment::record, some_records(), context_.now + 60s, [this] {
        if (host_.running()) {
            host_.kill();
            count(Fault::process_kill);
        }
    });
    return false;
}

bool Faults::cause_on_the_way(Fault fault) {
    if (fault == Fault::link_stall) {
        if (line_.others_interfere()) {
            return false; // as for host_pause
        }
        const Duration duration = random_.spread(Duration{1ms}, Duration{20s});
        answers_late_until_ = std::max(answers_late_until_, context_.now + duration + 1s);
        wire_.stall(context_.now + duration);
        excuse_for(duration);
        return true;
    }
    wire_.cut(fault == Fault::link_cut);
    excuse_for(5s);
    if (random_.chance(0.5)) {
        wire_.set_down(true);
        repair_later(fault, 100ms, 100s);
    }
    return true;
}

} // namespace linefeed::simulation
