// What every subcommand over the service has in common: its options, how it ends, and what it asks before it does harm.
#pragma once

#include "cli/exit_code.hpp"
#include "client/json_fields.hpp"
#include "client/service.hpp"
#include "client/terminal.hpp"

#include <functional>
#include <string>

namespace linefeed::client {

using cli::ExitCode;

struct CommonOptions {
    ServiceOptions service;
    bool json = false;
};

/// Finds the service, runs the command, and shows why it failed: on stderr, and as JSON on stdout if asked for.
[[nodiscard]] ExitCode run_with_service(const CommonOptions& options,
                                        const std::function<Result<ExitCode>(Service&)>& command);
/// The same for a command that looks for the service itself.
[[nodiscard]] ExitCode run_command(bool json, const std::function<Result<ExitCode>()>& command);

/// One document on stdout.
void show_json(const Json& json);
/// One line of JSON on stdout, at once.
void show_json_line(const Json& json);
/// On stdout, at once.
void show(const std::string& text);
/// A line on stderr, made safe to show.
void say(const std::string& message);

/// Asks on the terminal whether to do it, and says so if it is not done; `yes` = it was said already.
/// FailureKind::usage if there is nobody to ask.
[[nodiscard]] Result<bool> confirm(const std::string& question, bool yes, bool json);

} // namespace linefeed::client
