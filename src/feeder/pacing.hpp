// How often to ask `?SM` and how much to refill at once (design, section 4). Asked too seldom, the FIFO runs empty;
// asked too often, the printer's processor is kept from printing.
//
// What a stall of ours may last is what lies in the printer just before a refill arrives. The records printed since the
// last answer was made are missing there: rate × (interval + round trip). That may be a sixteenth of the buffer: the
// interval takes what the round trip leaves of it, within bounds behind which asking more often gains less than it
// costs. Asking faster than the printer answers gains nothing at all: the questions queue, the answers grow old on the
// way, and the records wait behind them. Whether it is the way or the printer that takes the time shows when several
// are under way at once.
#pragma once

#include "base/record_number.hpp"
#include "base/time.hpp"

#include <array>
#include <cstddef>

namespace linefeed::feeder {

/// Inquiries under way at once, at most, whatever the way.
inline constexpr int max_inquiries = 32;

/// Precondition: 0 < poll_least ≤ poll_min ≤ poll_max; rates, polls and inquiries above 0.
struct PacingSettings {
    Duration poll_min = std::chrono::milliseconds{1};
    /// Even more often when the measured rate demands it, and while nothing is known of the rate after a start.
    Duration poll_least = std::chrono::microseconds{400};
    Duration unknown_rate = std::chrono::milliseconds{250}; ///< for so long after a start
    Duration poll_max = std::chrono::milliseconds{250};
    /// A standing line may start again at this rate (prints/s) at any moment.
    double burst_rate = 2000.0;
    /// Polls in the time in which the buffer would run empty at that rate.
    double polls_per_buffer = 8.0;
    /// The share of the buffer that may be printed before a refill for it arrives.
    double missing_share = 1.0 / 16;
    /// Polls in the time in which the line prints as much as is in the printer: if answers are quick, and at most.
    double polls_per_filling = 64.0;
    double polls_per_filling_max = 256.0;
    int most_inquiries = max_inquiries; ///< under way at once, at most
    /// A record must lie in the FIFO so long before its PrintGo (protocol, section 5).
    Duration lead = std::chrono::milliseconds{3};
};

/// Measures the print rate and derives the beat from it. Flow: restart() when printing begins, printed() for every
/// answer.
class Pacing {
public:
    explicit Pacing(const PacingSettings& settings);

    /// `printed` records in all have been printed already.
    void restart(Instant now, RecordCount printed = {});
    /// `count` records in all have been printed by `now` (the time of the answer). Precondition: count does not fall.
    void printed(RecordCount count, Instant now);
    /// Prints per second over the last second or so; 0 while the line stands still.
    [[nodiscard]] double rate() const;
    /// `count` is clearly more than the line can have printed since the last answer: records may have been skipped.
    [[nodiscard]] bool leaps(RecordCount count, Instant now) const;
    /// An answer took this long: a refill is late by as much, so the buffer holds that much less.
    /// With it, `under_way` inquiries were under way when it was asked for.
    void answered_after(Duration round_trip, int under_way);
    /// Two inquiries that went out together were answered after these times.
    void pair_answered_after(Duration first, Duration second);
    /// So many inquiries may be under way. As many as one likes if it is the way that takes the time; few if the
    /// printer takes one after the other.
    [[nodiscard]] int inquiries_at_most() const { return inquiries_at_most_; }
    /// How long after one inquiry the next is due, with `level` records in the printer at most.
    [[nodiscard]] Duration poll_interval(RecordCount level) const;
    /// Whether `credit` records should be sent now, or rather be collected into a larger block.
    [[nodiscard]] static bool worth_sending(RecordCount credit, RecordCount level, RecordCount depth);

private:
    [[nodiscard]] double latest_rate() const;
    [[nodiscard]] bool rate_is_known() const;
    [[nodiscard]] Duration least_interval(RecordCount level) const;

    struct Sample {
        RecordCount count;
        Instant at;
    };
    static constexpr int first_inquiries = 16; ///< under way, while nothing speaks against it
    static constexpr int least_inquiries = 2;
    static constexpr int answers_judged = 8; ///< together: one that was late by chance says nothing
    static constexpr std::size_t samples_kept = 64;
    static constexpr Duration window = std::chrono::seconds{1};

    PacingSettings settings_;
    Duration round_trip_{0}; ///< of late; falls slowly
    Duration shortest_round_trip_{Duration::max()};
    Duration shortest_of_late_{Duration::max()}; ///< of the answers that are judged next
    Duration shortest_before_{Duration::max()};  ///< of those that were judged last
    int answers_since_judged_ = 0;
    int inquiries_at_most_;
    std::array<Sample, samples_kept> samples_{};
    std::size_t oldest_ = 0;
    std::size_t size_ = 0;
    Instant restarted_at_{};
    Instant last_at_{};
    RecordCount last_count_;
};

} // namespace linefeed::feeder
