// `linefeed token new`: a token for programs that use the service over TCP.
#pragma once

#include "client/command.hpp"

#include <string>

namespace linefeed::client {

struct TokenOptions {
    std::string name;
    std::string role{"viewer"}; ///< viewer or operator
    bool json = false;
};

/// Shows the token, which is nowhere kept, and the line for http.tokens_file.
[[nodiscard]] ExitCode run_token(const TokenOptions& options);

} // namespace linefeed::client
