// The head of an answer as bytes: status, length, what a browser must not do with it.
#pragma once

#include "api/admission.hpp"
#include "api/exchange.hpp"

#include <string>
#include <string_view>

namespace linefeed::api {

struct HeadOptions {
    std::string_view cors_origin{}; ///< empty = pages of other origins may not read the answer
    bool preflight = false;         ///< a browser asks what such pages may send
    bool close = false;             ///< the connection ends behind the answer
    bool stream = false;            ///< the body goes on until the connection ends
};

/// Everything before the body. The fields of `answer` hold no characters that end a line.
[[nodiscard]] std::string response_head(const Answer& answer, const HeadOptions& options);

inline constexpr std::string_view continue_head = "HTTP/1.1 100 Continue\r\n\r\n";

} // namespace linefeed::api
