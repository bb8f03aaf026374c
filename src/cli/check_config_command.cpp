#include "cli/check_config_command.hpp"

#include "config/effective.hpp"
#include "config/load.hpp"

#include <iostream>
#include <unistd.h>

namespace linefeed::cli {

ExitCode run_check_config(const CheckConfigOptions& options) {
    const auto settings = config::load(options.file, config::read_environment(::environ));
    if (settings) {
        std::cout << (options.json ? config::effective_json(*settings) : config::effective_yaml(*settings));
        std::cout.flush();
        return std::cout ? ExitCode::done : ExitCode::other;
    }
    const config::Problems& problems = settings.error();
    for (const config::Problem& problem : problems.kept()) {
        std::cerr << config::to_string(problem) << '\n';
    }
    if (problems.more() > 0) {
        std::cerr << "and " << problems.more() << " more\n";
    }
    return ExitCode::usage;
}

} // namespace linefeed::cli
