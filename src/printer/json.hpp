// JSON of what printers say. Texts in it are UTF-8, with everything that could command a terminal disarmed.
#pragma once

#include "base/failure.hpp"

#include <nlohmann/json.hpp>

#include <utility>

namespace linefeed::printer {

using Json = nlohmann::ordered_json;

/// A Result<Json> cannot be made of a Json by itself: nearly everything can be made of that.
[[nodiscard]] inline Result<Json> json_result(Json json) {
    return Result<Json>{boost::system::in_place_value, std::move(json)};
}

} // namespace linefeed::printer
