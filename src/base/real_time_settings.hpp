// What may be asked of the operating system for the feed thread (daemon/real_time.hpp asks).
#pragma once

#include <optional>

namespace linefeed {

struct RealTimeSettings {
    /// SCHED_FIFO with this priority, 1…99.
    std::optional<int> priority{};
    /// The thread runs on this processor only, 0….
    std::optional<int> processor{};
    /// The memory of the whole process stays in RAM, and the thread's stack is touched beforehand.
    bool lock_memory = false;

    [[nodiscard]] bool wanted() const { return priority || processor || lock_memory; }
    friend bool operator==(const RealTimeSettings&, const RealTimeSettings&) = default;
};

} // namespace linefeed
