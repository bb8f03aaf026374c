// The grid of PrintGos, see conveyor.hpp.
#include "simulator/conveyor.hpp"

#include "base/assert.hpp"
#include "simulator/random_draw.hpp"

#include <algorithm>
#include <cmath>

namespace linefeed::simulator {
namespace {

constexpr double ns_per_second = 1e9;
constexpr double percent = 100;

Duration from_ns(double ns) {
    return Duration{static_cast<Duration::rep>(std::llround(ns))};
}

} // namespace

Conveyor::Conveyor(const ConveyorSettings& settings)
    : settings_(settings)
    , random_state_(settings.seed) {
    if (settings.rate > 0) {
        period_ns_ = ns_per_second / settings.rate;
    }
}

Duration Conveyor::smallest_distance(const ConveyorSettings& settings) {
    if (settings.rate <= 0) {
        return Duration::max();
    }
    // Half of what the grid gives, so that small delays of the platform can be made up for; products that a large
    // jitter would bring to the same place come one behind the other.
    constexpr double least_share = 0.1;
    const double without_jitter = std::max(1 - 2 * settings.jitter_percent / percent, least_share);
    return from_ns(ns_per_second / settings.rate * without_jitter / 2);
}

void Conveyor::start(Instant now) {
    if (due_ || period_ns_ <= 0) {
        return;
    }
    anchor_ = now + std::max(settings_.start_delay, from_ns(period_ns_));
    steps_ = 0;
    due_ = std::max(anchor_ + draw_jitter(), now);
}

void Conveyor::passed(Instant now) {
    LINEFEED_ASSERT(due_ && *due_ <= now);
    if (stalled(now)) {
        note_stall(now);
        if (!settings_.keeps_grid && now - *due_ > from_ns(period_ns_)) {
            anchor_ = now;
            steps_ = 0;
        }
    }
    steps_ += 1;
    due_ = std::max(anchor_ + from_ns(steps_ * period_ns_) + draw_jitter(), now + smallest_distance(settings_));
}

void Conveyor::postpone(Instant now, Duration pause) {
    LINEFEED_ASSERT(due_ && *due_ <= now);
    note_stall(now);
    anchor_ = now + pause;
    steps_ = 0;
    due_ = anchor_;
}

void Conveyor::note_stall(Instant now) {
    ++stalls_;
    longest_stall_ = std::max(longest_stall_, now - *due_);
}

Duration Conveyor::draw_jitter() {
    if (settings_.jitter_percent <= 0) {
        return Duration::zero();
    }
    constexpr double draws = 9007199254740992.0; // 2^53
    const double unit = static_cast<double>(next_random(random_state_) >> 11U) / draws;
    return from_ns((2 * unit - 1) * settings_.jitter_percent / percent * period_ns_);
}

} // namespace linefeed::simulator
