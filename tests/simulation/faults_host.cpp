// Faults of the host and of the network.
#include "faults.hpp"

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
        host_.kill();
        return running;
    case Fault::kill_in_step:
        host_.kill(random_.between(1, 12));
        return running;
    case Fault::both_power_loss:
        if (two_disasters(memory_lost_, others_printed_)) {
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
        const Duration duration = random_.spread(Duration{1ms}, Duration{5s});
        host_.pause(duration);
        excuse_for(duration);
        return running;
    }
    case Fault::slow_disk: {
        const Duration duration = random_.spread(Duration{10ms}, Duration{10s});
        host_.slow_disk(duration);
        excuse_for(duration * 2);
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

bool Faults::cause_on_the_way(Fault fault) {
    if (fault == Fault::link_stall) {
        const Duration duration = random_.spread(Duration{1ms}, Duration{20s});
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
