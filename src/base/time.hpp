// Time as the core sees it: a parameter. The tag clock has no now(), so nothing in feeder, session or the printer model
// can read a clock; the edges translate from theirs.
#pragma once

#include <chrono>

namespace linefeed {

using Duration = std::chrono::nanoseconds;

/// Tag for instants of a monotonic clock whose zero is arbitrary.
struct MonotonicTime {
    using rep = Duration::rep;
    using period = Duration::period;
    using duration = Duration;
    using time_point = std::chrono::time_point<MonotonicTime, Duration>;
    static constexpr bool is_steady = true;
};

/// A point in monotonic time, nanoseconds.
using Instant = MonotonicTime::time_point;

} // namespace linefeed
