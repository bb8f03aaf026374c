// The time of day, as it stands in ledger, events and logs.
#pragma once

#include <cstdint>

namespace linefeed::daemon {

/// ns since the Unix epoch.
[[nodiscard]] std::int64_t wall_clock_ns();
/// The same as the kernel writes it on files that change now: it stands still for some milliseconds.
[[nodiscard]] std::int64_t file_clock_ns();

} // namespace linefeed::daemon
