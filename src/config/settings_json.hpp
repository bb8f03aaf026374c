// Settings as a JSON tree, by their description: the form in which they are shown and compared.
#pragma once

#include "config/settings.hpp"

#include <nlohmann/json.hpp>

namespace linefeed::config {

[[nodiscard]] nlohmann::ordered_json to_json(const Settings& settings);
[[nodiscard]] nlohmann::ordered_json to_json(const ErrorTable& table);

} // namespace linefeed::config
