#include "linefeedd/serve.hpp"

#include "api/core.hpp"
#include "api/request_log.hpp"
#include "api/server.hpp"
#include "daemon/log.hpp"
#include "daemon/service_manager.hpp"
#include "service/event_logging.hpp"
#include "service/service.hpp"

#include <chrono>
#include <unistd.h>

namespace linefeed::linefeedd {

using config::LogComponent;
using config::LogLevel;
using daemon::Watchdog;

namespace {

void reload(service::Service& service) {
    daemon::notify_reloading();
    static_cast<void>(service.reload({"linefeedd (SIGHUP)"})); // an event tells what came of it
    daemon::notify_ready("running");
}

/// Who was refused leaves a trace; what changes something is in the audit log.
void log_request(daemon::Log& log, api::RequestLog& requests, const api::AccessRecord& request) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    for (const api::RequestLog::Line& line : requests.take(request, Instant{now})) {
        log.write(LogComponent::api, line.level, line.text);
    }
}

/// Says once that a thread does not get on, before systemd ends the service.
void look(Watchdog& watchdog, daemon::Log& log, int& stalled_looks) {
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
void watch(service::Service& service, daemon::Log& log, const Signals& signals) {
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
            reload(service);
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

} // namespace

config::Checked<config::Settings> load_settings(const std::filesystem::path& file) {
    return config::load(file, config::read_environment(::environ));
}

cli::ExitCode serve(const std::filesystem::path& file, const config::Settings& settings, const Signals& signals) {
    daemon::Log log{settings.logging, daemon::make_log_target(settings.logging.target)};
    api::Server* told = nullptr; // of new settings; it is there before anybody can ask for a reload
    auto opened = service::Service::open({.settings = settings,
                                          .load = [&file] { return load_settings(file); },
                                          .listen = [&log](const auto& event) { service::log_event(log, event); },
                                          .version = LINEFEED_VERSION,
                                          .take_over = [&](const config::Settings& next) -> Result<void> {
                                              if (const auto taken = told->reload(next.http); !taken) {
                                                  return taken.error();
                                              }
                                              log.set_levels(next.logging);
                                              return {};
                                          }});
    if (!opened) {
        log.write(LogComponent::service, LogLevel::error, opened.error().message);
        return cli::ExitCode::other;
    }
    service::Service& service = **opened;
    api::RequestLog requests;
    api::Server server{service, settings,
                       [&](const api::AccessRecord& request) { log_request(log, requests, request); }};
    told = &server;
    if (const auto started = server.start(); !started) {
        log.write(LogComponent::api, LogLevel::error, started.error().message);
        return cli::ExitCode::other;
    }
    service.start();
    daemon::notify_ready("running");
    watch(service, log, signals);
    daemon::notify_stopping("stopping the lines");
    service.shut_down(); // still answering what it is asked meanwhile
    server.stop();
    return cli::ExitCode::done;
}

} // namespace linefeed::linefeedd
