#include "cli/wall_time.hpp"

#include <cstdio>
#include <ctime>

namespace linefeed::cli {

std::string format_wall_time(std::int64_t ns) {
    constexpr std::int64_t ns_per_s = 1'000'000'000;
    constexpr std::int64_t ns_per_ms = 1'000'000;
    const std::time_t seconds = ns / ns_per_s;
    std::tm utc{};
    ::gmtime_r(&seconds, &utc);
    char text[40];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
    char milliseconds[16];
    std::snprintf(milliseconds, sizeof milliseconds, ".%03dZ", static_cast<int>(ns % ns_per_s / ns_per_ms));
    return std::string{text} + milliseconds;
}

} // namespace linefeed::cli
