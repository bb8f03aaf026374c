// The one place where the simulator's edges read the monotonic clock.
#pragma once

#include "base/time.hpp"

#include <chrono>

namespace linefeed::simulator {

/// Now, on the clock of the process's timers.
[[nodiscard]] inline Instant steady_now() {
    return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

/// The same instant for Asio's timers.
[[nodiscard]] inline std::chrono::steady_clock::time_point to_steady(Instant instant) {
    return std::chrono::steady_clock::time_point{
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(instant.time_since_epoch())};
}

} // namespace linefeed::simulator
