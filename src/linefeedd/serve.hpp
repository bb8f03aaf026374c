// The service from its start to SIGTERM: what main() has to put together and to look after.
#pragma once

#include "cli/exit_code.hpp"
#include "config/load.hpp"
#include "linefeedd/signals.hpp"

#include <filesystem>

namespace linefeed::linefeedd {

/// The settings in `file` and in the environment.
[[nodiscard]] config::Checked<config::Settings> load_settings(const std::filesystem::path& file);

/// Runs the service until SIGTERM or SIGINT, and leaves no line printing; SIGHUP reads `file` again. What is wrong goes
/// to the log.
[[nodiscard]] cli::ExitCode serve(const std::filesystem::path& file, const config::Settings& settings,
                                  const Signals& signals);

} // namespace linefeed::linefeedd
