// The printer's clock beside that of this computer. The printer knows no time zone: it shows local time.
#pragma once

#include "base/failure.hpp"
#include "printer/json.hpp"
#include "protocol/machine_messages.hpp"

#include <chrono>
#include <string_view>

namespace linefeed::printer {

/// Local time of this computer, now.
[[nodiscard]] protocol::ClockTime host_clock();
/// "2026-11-26 10:00:00", or with a T between; empty or "now" = host_clock(). FailureKind::usage: there is no such
/// moment, or the printer has no room for it.
[[nodiscard]] Result<protocol::ClockTime> read_clock(std::string_view text);
/// How far `clock` is ahead of `other`; 0 if one of them shows no moment that exists.
[[nodiscard]] std::chrono::seconds ahead_of(const protocol::ClockTime& clock, const protocol::ClockTime& other);

/// With how far it is ahead of this computer.
[[nodiscard]] Json clock_json(const protocol::ClockTime& clock);

} // namespace linefeed::printer
