#include "daemon/wall_clock.hpp"

#include <chrono>

namespace linefeed::daemon {

std::int64_t wall_clock_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

} // namespace linefeed::daemon
