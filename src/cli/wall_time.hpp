// Wall time for people.
#pragma once

#include <cstdint>
#include <string>

namespace linefeed::cli {

/// ISO 8601 in UTC with milliseconds, e.g. "2026-11-22T19:45:50.123Z".
[[nodiscard]] std::string format_wall_time(std::int64_t ns);

} // namespace linefeed::cli
