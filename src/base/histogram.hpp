// Counts of durations in buckets that widen with the duration, from a refill's microseconds to the minutes that records
// lie in a printer before its line begins to move. Recording is an index and an addition: it never allocates.
#pragma once

#include "base/assert.hpp"
#include "base/time.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace linefeed {

/// Lower borders of the buckets, ascending: 0, then nine in each decade from 1 µs to 100 s. So each has one significant
/// digit, and 3 ms, the protocol's limit, is one of them. The last bucket has no upper border.
inline constexpr std::array<Duration, 74> histogram_borders = [] {
    std::array<Duration, 74> borders{};
    constexpr std::size_t steps = 9;
    Duration decade = std::chrono::microseconds{1};
    for (std::size_t i = 1; i < borders.size(); ++i) {
        const auto step = (i - 1) % steps;
        borders[i] = decade * static_cast<Duration::rep>(step + 1);
        if (step + 1 == steps) {
            decade *= 10;
        }
    }
    return borders;
}();
static_assert(histogram_borders.back() == std::chrono::seconds{100});

/// The bucket that holds `duration` ≥ 0.
[[nodiscard]] inline std::size_t histogram_bucket(Duration duration) {
    LINEFEED_ASSERT(duration >= Duration::zero());
    const auto* const above = std::upper_bound(histogram_borders.begin(), histogram_borders.end(), duration);
    return static_cast<std::size_t>(above - histogram_borders.begin()) - 1;
}

/// `Count` = what counts: an integer, or something like it that other threads may read while one records.
template <typename Count = std::uint64_t>
class Histogram {
public:
    /// `times` durations of this length, which is ≥ 0.
    void record(Duration duration, std::uint64_t times = 1) {
        counts_[histogram_bucket(duration)] += times;
        sum_ns_ += static_cast<std::uint64_t>(duration.count()) * times;
    }

    [[nodiscard]] std::uint64_t count(std::size_t bucket) const { return counts_.at(bucket); }
    /// Those of at least `from` and less than `below`. Precondition: both are borders.
    [[nodiscard]] std::uint64_t count_between(Duration from, Duration below) const {
        const std::size_t end = histogram_bucket(below);
        std::uint64_t count = 0;
        for (std::size_t bucket = histogram_bucket(from); bucket < end; ++bucket) {
            count += counts_[bucket];
        }
        return count;
    }
    /// Those of at least `from`. Precondition: it is a border.
    [[nodiscard]] std::uint64_t count_from(Duration from) const {
        std::uint64_t count = 0;
        for (std::size_t bucket = histogram_bucket(from); bucket < counts_.size(); ++bucket) {
            count += counts_[bucket];
        }
        return count;
    }
    /// Of all durations; wraps after 584 years of them.
    [[nodiscard]] Duration sum() const {
        return Duration{static_cast<Duration::rep>(static_cast<std::uint64_t>(sum_ns_))};
    }

private:
    std::array<Count, histogram_borders.size()> counts_{};
    Count sum_ns_{};
};

} // namespace linefeed
