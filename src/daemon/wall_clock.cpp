#include "daemon/wall_clock.hpp"

#include <chrono>
#include <ctime>

namespace linefeed::daemon {

std::int64_t wall_clock_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

std::int64_t file_clock_ns() {
    constexpr std::int64_t ns_of_second = 1'000'000'000;
    timespec time{};
    ::clock_gettime(CLOCK_REALTIME_COARSE, &time);
    return static_cast<std::int64_t>(time.tv_sec) * ns_of_second + time.tv_nsec;
}

} // namespace linefeed::daemon
