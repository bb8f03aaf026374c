// The time of day, as it stands in ledger, events and logs.
#pragma once

#include <cstdint>

namespace linefeed::daemon {

/// ns since the Unix epoch.
[[nodiscard]] std::int64_t wall_clock_ns();

} // namespace linefeed::daemon
