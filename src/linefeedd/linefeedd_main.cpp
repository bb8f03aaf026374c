// linefeedd, the service: reads its settings, runs until SIGTERM, and leaves no line printing. CLI11 stays in this
// file.
#include "cli/check_config_command.hpp"
#include "linefeedd/serve.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace {

using linefeed::cli::ExitCode;

struct Options {
    std::filesystem::path config;
    bool check_config = false;
};

int run(int argc, char** argv) {
    Options options;
    CLI::App app{"The linefeed service: feeds printers from queues of jobs", "linefeedd"};
    app.set_version_flag("--version", std::string{"linefeedd "} + LINEFEED_VERSION);
    app.add_option("--config", options.config, "The settings, a YAML file")->required();
    app.add_flag("--check-config", options.check_config, "Check the settings, show those in force, and end");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        app.exit(error);
        return static_cast<int>(ExitCode::usage);
    }
    const auto settings = linefeed::linefeedd::load_settings(options.config);
    if (options.check_config || !settings) {
        return static_cast<int>(linefeed::cli::run_check_config({options.config, false}));
    }
    const linefeed::linefeedd::Signals signals;
    return static_cast<int>(linefeed::linefeedd::serve(options.config, *settings, signals));
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "linefeedd: %s\n", error.what());
        return static_cast<int>(ExitCode::other);
    }
}
