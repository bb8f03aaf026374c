// Text that goes into a path or a query.
#pragma once

#include <string>
#include <string_view>

namespace linefeed::api {

/// `text` for a path or a query: everything but letters, digits and `-._~` as %NN.
[[nodiscard]] std::string url_encoded(std::string_view text);

} // namespace linefeed::api
