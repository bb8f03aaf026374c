// Text from printers, files and people, wherever it is shown: what could command a terminal or forge a line is
// disarmed.
#pragma once

#include <string>
#include <string_view>

namespace linefeed::protocol {

/// Safe to show on a terminal and as one line: control characters, characters that turn the direction of writing, line
/// separators, and bytes that are no UTF-8 are written as \xNN.
[[nodiscard]] std::string printable(std::string_view text);

} // namespace linefeed::protocol
