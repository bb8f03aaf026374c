// Settings from the environment, which go before those of the file. The rule for the name: the key path in capitals
// with LINEFEED_ in front, and `_` for every other character than letters and digits: `http.port` is
// LINEFEED_HTTP_PORT, `printers.line-1.address` is LINEFEED_PRINTERS_LINE_1_ADDRESS. Lists are separated by commas.
// Printers, layouts and folders must be in the file; error numbers and column encodings are set there only.
#pragma once

#include "config/context.hpp"

#include <string>
#include <utility>
#include <vector>

namespace linefeed::config {

/// Names and values of variables.
using Environment = std::vector<std::pair<std::string, std::string>>;

/// The variables of the process that begin with LINEFEED_, by name. `variables` is environ.
[[nodiscard]] Environment read_environment(const char* const* variables);

/// Puts the values into the tree. Refuses a variable that names no setting but looks as if it should: its first word is
/// that of a section, or it is a near miss. Others (LINEFEED_BIN_DIR) are not ours.
void apply_environment(const Environment& environment, Node& root, Context& context);

} // namespace linefeed::config
