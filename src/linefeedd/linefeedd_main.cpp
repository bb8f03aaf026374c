// linefeedd, the service: reads its settings, runs until SIGTERM, and leaves no line printing. CLI11 stays in this file.
#include "cli/check_config_command.hpp"
#include "config/load.hpp"
#include "service/service.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <pthread.h>
#include <unistd.h>

namespace {

using linefeed::cli::ExitCode;

struct Options {
    std::filesystem::path config;
    bool check_config = false;
};

/// Blocked from before the first thread on, and waited for by the main thread alone.
class Signals {
public:
    Signals() {
        sigemptyset(&signals_);
        for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
            sigaddset(&signals_, signal);
        }
        ::pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
        ::signal(SIGPIPE, SIG_IGN); // whoever reads may go away
    }
    /// The next signal, 0 if none comes within a second.
    [[nodiscard]] int wait() const {
        const timespec second{1, 0};
        const int signal = ::sigtimedwait(&signals_, nullptr, &second);
        return signal > 0 ? signal : 0;
    }

private:
    sigset_t signals_{};
};

linefeed::config::Checked<linefeed::config::Settings> load(const std::filesystem::path& file) {
    return linefeed::config::load(file, linefeed::config::read_environment(::environ));
}

void tell(const linefeed::spool::Event& event) {
    std::fprintf(stderr, "linefeedd: %s%s%s%s: %s\n", event.kind.c_str(), event.printer.empty() ? "" : " ",
                 event.printer.c_str(), event.job ? (" job " + std::to_string(static_cast<std::int64_t>(*event.job))).c_str() : "",
                 event.message.c_str());
}

ExitCode serve(const Options& options, const linefeed::config::Settings& settings, const Signals& signals) {
    auto service = linefeed::service::Service::open(
        {settings, [&options] { return load(options.config); }, tell, LINEFEED_VERSION});
    if (!service) {
        std::cerr << "linefeedd: " << service.error().message << '\n';
        return ExitCode::other;
    }
    // The place of the API: it serves the operations of *service from here on, and ends before shut_down().
    constexpr int checkpoint_seconds = 10;
    for (int quiet = 1;; ++quiet) {
        switch (signals.wait()) {
        case SIGTERM:
        case SIGINT:
            (*service)->shut_down();
            return ExitCode::done;
        case SIGHUP:
            static_cast<void>((*service)->reload({"linefeedd (SIGHUP)"})); // an event tells what came of it
            break;
        default:
            if (quiet % checkpoint_seconds == 0) {
                (*service)->tick();
            }
            break;
        }
    }
}

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
    const auto settings = load(options.config);
    if (options.check_config || !settings) {
        return static_cast<int>(linefeed::cli::run_check_config({options.config, false}));
    }
    const Signals signals;
    return static_cast<int>(serve(options, *settings, signals));
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
