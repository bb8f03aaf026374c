#include "cli/check_config_command.hpp"
#include "client/doctor_command.hpp"
#include "client/token_command.hpp"
#include "linefeed/definitions.hpp"

#include <memory>

namespace linefeed {

namespace {

void add_doctor(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::DoctorOptions>();
    options->version = LINEFEED_VERSION;
    CLI::App& doctor =
        *app.add_subcommand("doctor", "Check the service and its surroundings, and say what to do about what is wrong");
    doctor.footer("Exit codes: 0 no problem (there may be warnings), 3 the service cannot be reached, 1 a problem.");
    doctor.add_option("--config", options->config,
                      "Configuration of the service; default: /etc/linefeed/linefeed.yaml");
    add_common(doctor, options->common);
    commands.push_back({&doctor, [options] { return client::run_doctor(*options); }});
}

void add_check_config(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<cli::CheckConfigOptions>();
    CLI::App& check = *app.add_subcommand("check-config",
                                          "Check the configuration of the service and show the settings that it gives");
    check.footer("Variables of the environment go before the file: LINEFEED_HTTP_PORT is http.port.\n"
                 "Exit codes: 0 good, 2 refused: each problem with file, line and column on stderr.");
    check.add_option("FILE", options->file, "The configuration, YAML; see config/linefeed.yaml")->required();
    check
        .add_option_function<std::string>(
            "-o,--output", [options](const std::string& format) { options->json = format == "json"; },
            "text (YAML) or json")
        ->default_str("text")
        ->check(CLI::IsMember({"text", "json"}));
    commands.push_back({&check, [options] { return cli::run_check_config(*options); }});
}

void add_token(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::TokenOptions>();
    CLI::App& token = *app.add_subcommand("token", "Tokens for programs that use the service over TCP");
    token.require_subcommand(1);
    CLI::App& made = *token.add_subcommand("new", "Make a token, and the line for http.tokens_file");
    made.add_option("NAME", options->name, "Whose it is: letters, digits and ._-; stands in the audit log")->required();
    made.add_option("--role", options->role, "viewer (looks at everything) or operator (and changes things)")
        ->capture_default_str()
        ->check(CLI::IsMember({"viewer", "operator"}));
    add_output(made, options->json);
    commands.push_back({&made, [options] { return client::run_token(*options); }});
}

} // namespace

void define_checks(CLI::App& app, Commands& commands) {
    add_doctor(app, commands);
    add_check_config(app, commands);
    add_token(app, commands);
}

} // namespace linefeed
