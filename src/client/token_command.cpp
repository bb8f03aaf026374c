#include "client/token_command.hpp"

#include "api/tokens.hpp"

namespace linefeed::client {

ExitCode run_token(const TokenOptions& options) {
    return run_command(options.json, [&]() -> Result<ExitCode> {
        const auto made =
            api::make_token(options.name, options.role == "operator" ? api::Role::operator_ : api::Role::viewer);
        if (!made) {
            return made.error();
        }
        if (options.json) {
            show_json({{"token", made->token}, {"line", made->line}});
        } else {
            show("token, shown only this once: " + made->token + "\nline for http.tokens_file:    " + made->line +
                 "\nThen let the service read its configuration again: linefeed reload\n");
        }
        return ExitCode::done;
    });
}

} // namespace linefeed::client
