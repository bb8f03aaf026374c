// The description of the interface, as it is served: openapi.yaml, embedded at build time.
#pragma once

#include <string_view>

namespace linefeed::api {

extern const std::string_view openapi_text;

} // namespace linefeed::api
