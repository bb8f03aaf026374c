// Wall time for people.
#pragma once

#include <cstdint>
#include <string>

namespace linefeed::cli {

/// ISO 8601 in UTC with milliseconds, e.g. "2026-11-22T19:45:50.123Z".
[[nodiscard]] std::string format_wall_time(std::int64_t ns);

/// For people, in local time to the second, e.g. "2026-11-22 20:45:50".
[[nodiscard]] std::string format_local_time(std::int64_t ns);
/// The same with milliseconds, without the day: "20:45:50.123".
[[nodiscard]] std::string format_local_clock(std::int64_t ns);

} // namespace linefeed::cli
