// `linefeed check-config FILE`: the effective settings, or everything that is wrong.
#pragma once

#include "cli/exit_code.hpp"

#include <filesystem>

namespace linefeed::cli {

struct CheckConfigOptions {
    std::filesystem::path file;
    bool json = false; ///< the settings as JSON instead of YAML
};

/// The settings go to stdout, all problems to stderr, one a line. ExitCode::done or ExitCode::usage.
[[nodiscard]] ExitCode run_check_config(const CheckConfigOptions& options);

} // namespace linefeed::cli
