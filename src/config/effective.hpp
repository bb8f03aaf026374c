// The settings as they are in force, defaults and environment included: what `--check-config` shows. The text is a
// configuration itself: read again, it gives the same settings.
#pragma once

#include "config/settings.hpp"

#include <string>

namespace linefeed::config {

/// YAML, in the order of the documentation. Settings that are absent are left out.
[[nodiscard]] std::string effective_yaml(const Settings& settings);
/// The same as JSON, indented.
[[nodiscard]] std::string effective_json(const Settings& settings);

} // namespace linefeed::config
