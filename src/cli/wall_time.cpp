#include "cli/wall_time.hpp"

#include <cstdio>
#include <ctime>

namespace linefeed::cli {

namespace {

constexpr std::int64_t ns_per_s = 1'000'000'000;
constexpr std::int64_t ns_per_ms = 1'000'000;

std::string milliseconds_of(std::int64_t ns) {
    char text[16];
    std::snprintf(text, sizeof text, ".%03d", static_cast<int>(ns % ns_per_s / ns_per_ms));
    return text;
}

std::tm local(std::int64_t ns) {
    const std::time_t seconds = ns / ns_per_s;
    std::tm local{};
    ::localtime_r(&seconds, &local);
    return local;
}

} // namespace

std::string format_wall_time(std::int64_t ns) {
    const std::time_t seconds = ns / ns_per_s;
    std::tm utc{};
    ::gmtime_r(&seconds, &utc);
    char text[40];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
    return text + milliseconds_of(ns) + 'Z';
}

std::string format_local_time(std::int64_t ns) {
    const std::tm time = local(ns);
    char text[40];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &time);
    return text;
}

std::string format_local_clock(std::int64_t ns) {
    const std::tm time = local(ns);
    char text[16];
    std::strftime(text, sizeof text, "%H:%M:%S", &time);
    return text + milliseconds_of(ns);
}

} // namespace linefeed::cli
