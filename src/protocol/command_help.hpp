// The table of commands for people: help and documentation are made of it.
#pragma once

#include "protocol/command_table.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// E.g. "host to printer".
[[nodiscard]] std::string_view to_string(Direction direction);
/// E.g. "disturbs the line".
[[nodiscard]] std::string_view to_string(Risk risk);

/// What else a table tells of each command.
struct CommandColumn {
    std::string_view title;
    std::function<std::string(const Command&)> cell;
};

/// Every command with its direction, parameters, risk and description: a Markdown table for each section of the
/// protocol. With what is known of each by the whole program it is deploy/doc/commands.md.
[[nodiscard]] std::string commands_as_markdown(std::span<const CommandColumn> columns = {});

} // namespace linefeed::protocol
