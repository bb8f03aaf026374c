// What the operating system grants the feed thread, so that nothing else on the machine makes it late: a real-time
// scheduling class, a processor of its own, memory that is never paged out (design, section 3). All of it is optional:
// what is not permitted is said in one line, and the thread goes on without.
#pragma once

#include "base/real_time_settings.hpp"

#include <string>

namespace linefeed::daemon {

using linefeed::RealTimeSettings;

/// Asks for what is wanted, for the calling thread. Returns one line for people: what was granted, and for what was not
/// the reason and the remedy.
[[nodiscard]] std::string make_real_time(const RealTimeSettings& settings);

} // namespace linefeed::daemon
