// How long before its PrintGo each record lay in the printer: the figure that says how near a line came to starving.
#pragma once

#include "base/time.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace linefeed::simulator {

/// Counts of lead times in buckets that widen with the time; 3 ms, the protocol's limit, is a border.
class LeadTimeHistogram {
public:
    /// Lower borders of the buckets; the last has no upper one.
    static constexpr std::array<Duration, 16> borders{
        std::chrono::milliseconds{0},    std::chrono::milliseconds{1},    std::chrono::milliseconds{2},
        std::chrono::milliseconds{3},    std::chrono::milliseconds{5},    std::chrono::milliseconds{10},
        std::chrono::milliseconds{20},   std::chrono::milliseconds{50},   std::chrono::milliseconds{100},
        std::chrono::milliseconds{200},  std::chrono::milliseconds{500},  std::chrono::milliseconds{1000},
        std::chrono::milliseconds{2000}, std::chrono::milliseconds{5000}, std::chrono::milliseconds{10000},
        std::chrono::milliseconds{60000}};

    /// Precondition: lead ≥ 0.
    void add(Duration lead);
    [[nodiscard]] std::uint64_t count(std::size_t bucket) const { return counts_.at(bucket); }
    /// std::nullopt while nothing was added.
    [[nodiscard]] std::optional<Duration> smallest() const { return smallest_; }

private:
    std::array<std::uint64_t, borders.size()> counts_{};
    std::optional<Duration> smallest_;
};

} // namespace linefeed::simulator
