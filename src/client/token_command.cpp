#include "client/token_command.hpp"

#include "api/tokens.hpp"
#include "cli/print_report.hpp"

#include <nlohmann/json.hpp>

#include <iostream>

namespace linefeed::client {

ExitCode run_token(const TokenOptions& options) {
    const auto made =
        api::make_token(options.name, options.role == "operator" ? api::Role::operator_ : api::Role::viewer);
    if (!made) {
        show_failure(made.error(), options.json);
        return exit_code(made.error().kind);
    }
    if (options.json) {
        std::cout << nlohmann::ordered_json{{"token", made->token}, {"line", made->line}}.dump(2) << std::endl;
        return ExitCode::done;
    }
    std::cout << "token, shown only this once: " << made->token << "\nline for http.tokens_file:    " << made->line
              << "\nThen let the service read its configuration again: linefeed reload" << std::endl;
    return ExitCode::done;
}

} // namespace linefeed::client
