// What a serial line can carry, and how a printer is fed over it: asked and refilled no faster than the bytes go.
#pragma once

#include "session/session.hpp"

#include <cstddef>

namespace linefeed::session {

/// How many records of so many bytes each, from `^` to CR, the line carries in a second, when nothing else is to be
/// said. Infinite where bytes need no counting.
[[nodiscard]] double records_per_second(const protocol::LineSettings& line, std::size_t record_bytes);

/// Sets beat, blocks and time-outs to what `settings.line` can carry, for records of so many bytes on average. Changes
/// nothing where bytes need no counting.
void fit_to_line(SessionSettings& settings, std::size_t record_bytes);

} // namespace linefeed::session
