// The faults ordered for the run, when they are due, see simulator.hpp.
#include "simulator/simulator.hpp"
#include "simulator/steady_instant.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::simulator {

bool Simulator::is_due(const Moment& moment, Instant now) const {
    switch (moment.unit) {
    case Moment::Unit::print:
        return moment.count <= statistics_.prints;
    case Moment::Unit::frame:
        return moment.count <= frames_;
    case Moment::Unit::time:
        return moment.time <= now - started_;
    }
    return false;
}

void Simulator::cause_due_faults(Instant now) {
    auto& faults = settings_.faults;
    for (std::size_t i = 0; i < faults.size();) {
        if (is_due(faults[i].when, now)) {
            const Deed due = std::move(faults[i].what);
            faults.erase(faults.begin() + static_cast<std::ptrdiff_t>(i));
            cause(due, now);
        } else {
            ++i;
        }
    }
}

void Simulator::cause(const Deed& deed, Instant now) {
    struct Visitor {
        Simulator& simulator;
        Instant now;

        void operator()(const PressKey& key) const { simulator.model_.press(key.action, now); }
        void operator()(const RaiseError& error) const { simulator.model_.raise_error(error.code, now); }
        void operator()(const MoveCover& cover) const {
            cover.open ? simulator.model_.open_cover(now) : simulator.model_.close_cover(now);
        }
        void operator()(const LoadJob& job) const { simulator.model_.load_job(job.path, now); }
        void operator()(const SetInput& input) const { simulator.model_.set_input(input.input, input.on, now); }
        void operator()(const MoveStick& stick) const { simulator.model_.set_stick(stick.present); }
        void operator()(const CutConnections&) const { simulator.server_.close_connections(); }
        void operator()(const Mute& mute) const { simulator.muted_ = mute.muted; }
        void operator()(const PowerCycle&) const { simulator.model_.power_cycle(now); }
        void operator()(const ExpectTrouble& trouble) const { simulator.model_.expect(trouble.trouble, trouble.times); }
    };
    std::visit(Visitor{*this, now}, deed);
}

/// For the next fault that has a time; the others come with what they count.
void Simulator::wait_for_fault() {
    std::optional<Duration> next;
    for (const Fault& fault : settings_.faults) {
        if (fault.when.unit == Moment::Unit::time) {
            next = next ? std::min(*next, fault.when.time) : fault.when.time;
        }
    }
    if (!next) {
        return;
    }
    fault_timer_.expires_at(to_steady(started_ + *next));
    fault_timer_.async_wait([this](const boost::system::error_code& error) {
        if (error) {
            return;
        }
        const Instant now = steady_now();
        cause_due_faults(now);
        carry_out(now);
        wait_for_fault();
    });
}

} // namespace linefeed::simulator
