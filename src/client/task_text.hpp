// What printers answer, for people: any JSON of the printer's tasks as names and values, with lists as tables.
#pragma once

#include "client/json_fields.hpp"
#include "client/terminal.hpp"

#include <string>

namespace linefeed::client {

/// Names lose their `_`, numbers that stand beside their words (`…_code`) are left out, an absent value is "-".
[[nodiscard]] std::string task_text(const Json& answer, const Screen& screen);

/// A value on one line.
[[nodiscard]] std::string value_text(const Json& value);

} // namespace linefeed::client
