#include "world.hpp"

#include "faults.hpp"
#include "host.hpp"
#include "judge.hpp"
#include "line.hpp"
#include "operator.hpp"
#include "ram_disk.hpp"
#include "wire.hpp"

#include <algorithm>

namespace linefeed::simulation {

namespace {

class World final : private WireEnds {
public:
    World(const Scenario& scenario, bool verbose)
        : context_(scenario, verbose)
        , random_(scenario.seed)
        , judge_(context_)
        , wire_(context_, random_.fork(11))
        , line_(context_, judge_, wire_, random_.fork(12))
        , host_(context_, judge_, wire_, random_.fork(13))
        , operator_(context_, judge_, line_, host_, random_.fork(14))
        , faults_(context_, judge_, line_, wire_, host_, operator_, random_.fork(15)) {
        line_.underrun_is_explained = [this] { return underrun_is_explained(); };
    }

    RunResult run() {
        host_.import_jobs();
        host_.start({});
        while (!judge_.violated() && !operator_.done()) {
            step();
            check_progress();
        }
        if (!judge_.violated()) {
            RamDisk::instance().set_full(false);
            host_.check_spool();
            judge_.check_complete();
        }
        context_.counts.simulated = context_.now.time_since_epoch();
        return {judge_.violated(), context_.trace.hash(), context_.counts};
    }

private:
    void step() {
        const Instant event_at = context_.queue.next_at();
        const Instant wake_at = host_.wake_at();
        const Instant product_at = line_.product_due();
        if (event_at <= wake_at && event_at <= product_at) {
            if (context_.queue.empty()) {
                judge_.violation("nothing will ever happen any more");
                return;
            }
            const Event event = context_.queue.take();
            context_.now = event.at;
            dispatch(event);
        } else if (wake_at <= product_at) {
            context_.now = wake_at;
            host_.wake();
        } else {
            context_.now = product_at;
            line_.product();
        }
    }

    void dispatch(const Event& event) {
        switch (event.kind) {
        case EventKind::chunk:
            wire_.deliver(event.a, *this);
            return;
        case EventKind::link_closed:
            host_.link_closed(event.a);
            return;
        case EventKind::peer_closed:
            line_.disconnected(event.a);
            return;
        case EventKind::connected:
            host_.connected(event.a, event.b);
            return;
        case EventKind::write_step:
            host_.write_step(event.a);
            return;
        case EventKind::store_done:
            host_.store_done(event.a);
            return;
        case EventKind::store_wake:
            host_.store_wake(event.a);
            return;
        case EventKind::host_resumes:
            host_.resume(event.a);
            return;
        case EventKind::next_fault:
            faults_.cause_next();
            return;
        case EventKind::fault_ends:
            faults_.repair(static_cast<Fault>(event.a), event.b);
            return;
        case EventKind::operator_acts:
            faults_.line_is_free();
            operator_.act();
            return;
        case EventKind::belt_changes:
            line_.change_belt();
            return;
        }
    }

    /// Once all is repaired, the job must finish in the time that its records take, with patience for every start and
    /// stop.
    void check_progress() {
        if (!faults_.healed()) {
            return;
        }
        const Scenario& scenario = context_.scenario;
        if (!deadline_) {
            deadline_ = context_.now + scenario.period * std::int64_t{scenario.records} * 2 + std::chrono::minutes{30};
            if (!scenario.supply_is_sufficient()) {
                *deadline_ += std::chrono::minutes{2} * std::int64_t{scenario.records}; // it starves again and again
            }
        }
        if (context_.now > *deadline_) {
            judge_.violation("the job does not finish although everything works");
        }
    }

    [[nodiscard]] bool underrun_is_explained() const {
        const auto phase = host_.phase();
        const bool feeds = (phase == feeder::Phase::starting || phase == feeder::Phase::printing) && !host_.all_sent();
        const auto taken_over = host_.taken_over(); // with what little was left in the printer then
        const bool too_late = taken_over && context_.now < *taken_over + context_.scenario.first_refill();
        return !feeds || too_late || !context_.scenario.supply_is_sufficient() || faults_.excuses_underrun();
    }

    void printer_receives(std::uint64_t connection, std::string_view bytes) override {
        line_.receive(connection, bytes);
    }
    void host_receives(std::uint64_t connection, std::string_view bytes) override { host_.receive(connection, bytes); }

    Context context_;
    Random random_;
    Judge judge_;
    Wire wire_;
    Line line_;
    Host host_;
    Operator operator_;
    Faults faults_;
    std::optional<Instant> deadline_;
};

} // namespace

RunResult run_seed(const Scenario& scenario, bool verbose) {
    constexpr auto loses_power = static_cast<std::size_t>(Fault::host_power_loss);
    constexpr auto both_lose_power = static_cast<std::size_t>(Fault::both_power_loss);
    RamDisk::instance().format(scenario.weights[loses_power] > 0 || scenario.weights[both_lose_power] > 0);
    World world{scenario, verbose};
    return world.run();
}

} // namespace linefeed::simulation
