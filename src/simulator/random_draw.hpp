// Draws from a seed: pure arithmetic, so that a run with the same seed is the same run.
#pragma once

#include <cstdint>

namespace linefeed::simulator {

/// SplitMix64: the same draws with every library and compiler.
[[nodiscard]] constexpr std::uint64_t next_random(std::uint64_t& state) {
    state += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
}

} // namespace linefeed::simulator
