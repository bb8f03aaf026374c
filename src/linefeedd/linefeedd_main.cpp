// linefeedd, the service: reads its settings, runs until SIGTERM, and leaves no line printing. CLI11 stays in this file.
#include "api/server.hpp"
#include "cli/check_config_command.hpp"
#include "config/load.hpp"
#include "daemon/log.hpp"
#include "daemon/service_manager.hpp"
#include "service/event_logging.hpp"
#include "service/service.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <csignal>
#include <cstdio>
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
    /// The next signal, 0 if none comes in that time. Precondition: `time` ≤ 1 s.
    [[nodiscard]] int wait(linefeed::Duration time) const {
        constexpr linefeed::Duration second = std::chrono::seconds{1};
        const timespec patience{time / second, (time % second).count()};
        const int signal = ::sigtimedwait(&signals_, nullptr, &patience);
        return signal > 0 ? signal : 0;
    }

private:
    sigset_t signals_{};
};

linefeed::config::Checked<linefeed::config::Settings> load(const std::filesystem::path& file) {
    return linefeed::config::load(file, linefeed::config::read_environment(::environ));
}

using linefeed::config::LogComponent;
using linefeed::config::LogLevel;
using linefeed::daemon::Watchdog;

/// The settings again: those of the service, and where they were taken, of what stands around it.
void reload(linefeed::service::Service& service, linefeed::api::Server& server, linefeed::daemon::Log& log) {
    linefeed::daemon::notify_reloading();
    if (service.reload({"linefeedd (SIGHUP)"})) { // an event tells what came of it
        const auto settings = service.settings();
        log.set_levels(settings->logging);
        if (const auto taken = server.reload(settings->http); !taken) {
            log.write(LogComponent::api, LogLevel::error, "the API goes on as it was: " + taken.error().message);
        }
    }
    linefeed::daemon::notify_ready("running");
}

/// Says once that a thread does not get on, before systemd ends the service.
void look(Watchdog& watchdog, linefeed::daemon::Log& log, int& stalled_looks) {
    constexpr int patience = 2;
    const std::vector<std::string> stalled = watchdog.look();
    stalled_looks = stalled.empty() ? 0 : stalled_looks + 1;
    if (stalled_looks == patience) {
        for (const std::string& name : stalled) {
            log.write(LogComponent::service, LogLevel::error, "the " + name + " does not get on");
        }
    }
}

/// Until SIGTERM; SIGHUP reads the settings again.
void watch(linefeed::service::Service& service, linefeed::api::Server& server, linefeed::daemon::Log& log,
           const Signals& signals) {
    constexpr auto tick_interval = std::chrono::seconds{10};
    using Clock = std::chrono::steady_clock;
    Watchdog watchdog{service.hearts()};
    const auto look_interval = Watchdog::look_interval();
    Clock::time_point ticked = Clock::now();
    int stalled_looks = 0;
    while (true) {
        switch (signals.wait(look_interval.value_or(std::chrono::seconds{1}))) {
        case SIGTERM:
        case SIGINT:
            return;
        case SIGHUP:
            reload(service, server, log);
            break;
        default:
            break;
        }
        if (look_interval) {
            look(watchdog, log, stalled_looks);
        }
        if (Clock::now() - ticked >= tick_interval) {
            service.tick();
            ticked = Clock::now();
        }
    }
}

ExitCode serve(const Options& options, const linefeed::config::Settings& settings, const Signals& signals) {
    linefeed::daemon::Log log{settings.logging, linefeed::daemon::make_log_target(settings.logging.target)};
    auto opened = linefeed::service::Service::open(
        {settings, [&options] { return load(options.config); },
         [&log](const linefeed::spool::Event& event) { linefeed::service::log_event(log, event); }, LINEFEED_VERSION});
    if (!opened) {
        log.write(LogComponent::service, LogLevel::error, opened.error().message);
        return ExitCode::other;
    }
    linefeed::service::Service& service = **opened;
    linefeed::api::Server server{service, settings};
    if (const auto started = server.start(); !started) {
        log.write(LogComponent::api, LogLevel::error, started.error().message);
        return ExitCode::other;
    }
    service.start();
    linefeed::daemon::notify_ready("running");
    watch(service, server, log, signals);
    linefeed::daemon::notify_stopping("stopping the lines");
    service.shut_down(); // still answering what it is asked meanwhile
    server.stop();
    return ExitCode::done;
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
