// When the next product reaches the sensor. Pure: the driver waits for due() and reports when it was really there, so
// that a stall of the platform is told apart from a miss of the host.
#pragma once

#include "base/time.hpp"

#include <chrono>
#include <cstdint>
#include <optional>

namespace linefeed::simulator {

/// The line.
struct ConveyorSettings {
    double rate = 0;           ///< PrintGos per second; 0 = there is no conveyor
    double jitter_percent = 0; ///< of the period, each way: 0…100
    std::uint64_t seed = 1;    ///< of the jitter
    bool free_running = false; ///< moves also while the printer does not print
    bool keeps_grid = false;   ///< what a stall of the platform has delayed is made up for, however much it is
    Duration start_delay =
        std::chrono::milliseconds{20}; ///< from print start to the first product, if longer than a period
};

/// Flow: start(); then at due() either passed() or, once after a stall, postpone(); halt() when the line stands still.
/// PrintGos lie on a grid of periods (with jitter) as long as the platform keeps up.
class Conveyor {
public:
    /// A PrintGo later than this is a stall of the platform.
    static constexpr Duration stall_limit = std::chrono::milliseconds{1};

    explicit Conveyor(const ConveyorSettings& settings);

    /// Two PrintGos are never nearer than this; a print must be shorter.
    [[nodiscard]] static Duration smallest_distance(const ConveyorSettings& settings);

    /// The line begins to move. Without effect when it moves or the rate is 0.
    void start(Instant now);
    void halt() { due_.reset(); }
    /// When the next product is at the sensor; none: the line stands still.
    [[nodiscard]] std::optional<Instant> due() const { return due_; }
    /// The PrintGo that was due has been given at `now`. Small delays are made up for; after a stall of more than a
    /// period the grid begins anew instead. Precondition: due() ≤ now.
    void passed(Instant now);
    /// `now` is so late that the platform must have stalled.
    [[nodiscard]] bool stalled(Instant now) const { return due_ && now - *due_ > stall_limit; }
    /// The platform stalled, and what arrived meanwhile has been read only at `now`: the product comes `pause` later.
    void postpone(Instant now, Duration pause);

    [[nodiscard]] std::uint64_t stalls() const { return stalls_; }
    [[nodiscard]] Duration longest_stall() const { return longest_stall_; }

private:
    void note_stall(Instant now);
    [[nodiscard]] Duration draw_jitter();

    ConveyorSettings settings_;
    double period_ns_ = 0;
    std::uint64_t random_state_;
    Instant anchor_;
    double steps_ = 0; ///< periods since anchor_
    std::optional<Instant> due_;
    std::uint64_t stalls_ = 0;
    Duration longest_stall_{};
};

} // namespace linefeed::simulator
