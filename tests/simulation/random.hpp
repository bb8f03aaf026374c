// Chance from one 64-bit seed. Own draws, since the distributions of <random> differ between libraries: a seed must
// give the same run everywhere.
#pragma once

#include "base/time.hpp"

#include <cstdint>

namespace linefeed::simulation {

/// SplitMix64. Every component has its own, forked from the seed of the run, so that one more draw here changes nothing
/// there.
class Random {
public:
    explicit Random(std::uint64_t seed)
        : state_(seed) {}

    [[nodiscard]] std::uint64_t next() {
        state_ += 0x9E3779B97F4A7C15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
        return z ^ (z >> 31U);
    }
    /// A generator of its own for the component `name`.
    [[nodiscard]] Random fork(std::uint64_t name) const {
        return Random{Random{state_ ^ (name * 0xD1342543DE82EF95U)}.next()};
    }

    /// 0 … n − 1. Precondition: n > 0.
    [[nodiscard]] std::uint64_t below(std::uint64_t n) { return next() % n; }
    /// low … high.
    [[nodiscard]] std::uint64_t between(std::uint64_t low, std::uint64_t high) { return low + below(high - low + 1); }
    [[nodiscard]] Duration between(Duration low, Duration high) {
        return Duration{static_cast<Duration::rep>(
            between(static_cast<std::uint64_t>(low.count()), static_cast<std::uint64_t>(high.count())))};
    }
    /// low … high, each doubling as likely as the next. Precondition: low > 0.
    [[nodiscard]] std::uint64_t spread(std::uint64_t low, std::uint64_t high) {
        std::uint64_t doublings = 0;
        while ((low << (doublings + 1)) <= high) {
            ++doublings;
        }
        const std::uint64_t from = low << below(doublings + 1);
        const std::uint64_t value = from + below(from);
        return value > high ? high : value;
    }
    [[nodiscard]] Duration spread(Duration low, Duration high) {
        return Duration{static_cast<Duration::rep>(
            spread(static_cast<std::uint64_t>(low.count()), static_cast<std::uint64_t>(high.count())))};
    }
    [[nodiscard]] bool chance(double probability) {
        constexpr double steps = 9007199254740992.0; // 2^53
        return static_cast<double>(next() >> 11U) < probability * steps;
    }

private:
    std::uint64_t state_;
};

} // namespace linefeed::simulation
