// Media types of requests: what a body is, and what a client takes.
#pragma once

#include <string>
#include <string_view>

namespace linefeed::api {

/// The type without parameters, in lower case: "text/csv" of "Text/CSV; charset=utf-8".
[[nodiscard]] std::string media_type_of(std::string_view content_type);

/// Whether `accept`, the value of the header, takes `media_type`. An empty one takes everything.
[[nodiscard]] bool accepts(std::string_view accept, std::string_view media_type);

} // namespace linefeed::api
