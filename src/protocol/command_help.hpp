// The table of commands for people: help and documentation are made of it.
#pragma once

#include "protocol/command_table.hpp"

#include <string>
#include <string_view>

namespace linefeed::protocol {

/// E.g. "host to printer".
[[nodiscard]] std::string_view to_string(Direction direction);
/// E.g. "disturbs the line".
[[nodiscard]] std::string_view to_string(Risk risk);

/// Every command with its direction, parameters, risk and description: a Markdown table for each section of the
/// protocol. deploy/doc/commands.md is this text.
[[nodiscard]] std::string commands_as_markdown();

} // namespace linefeed::protocol
