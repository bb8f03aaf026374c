#include "client/events_command.hpp"
#include "client/service_commands.hpp"
#include "client/watch_command.hpp"
#include "linefeed/definitions.hpp"

#include <limits>
#include <memory>

namespace linefeed {

namespace {

/// A command without options of its own.
void add_plain(CLI::App& app, Commands& commands, const std::string& name, const std::string& help,
               cli::ExitCode (*run)(const client::CommonOptions&)) {
    const auto options = std::make_shared<client::CommonOptions>();
    CLI::App& command = *app.add_subcommand(name, help);
    add_common(command, *options);
    commands.push_back({&command, [options, run] { return run(*options); }});
}

void add_watch(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::WatchOptions>();
    const auto interval_s = std::make_shared<double>(1);
    CLI::App& watch = *app.add_subcommand("watch", "Look on at all printers, until Ctrl-C");
    watch.footer(
        "On a terminal the view is drawn again and again; otherwise there is a line for every change, or with\n"
        "-o json one for every look.");
    watch.add_option("--interval", *interval_s, "Seconds between two looks")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 60.0));
    add_common(watch, options->common);
    commands.push_back({&watch, [options, interval_s] {
                            options->interval = std::chrono::duration_cast<std::chrono::milliseconds>(
                                std::chrono::duration<double>{*interval_s});
                            return client::run_watch(*options);
                        }});
}

void add_events(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::EventsOptions>();
    CLI::App& events = *app.add_subcommand("events", "Show what has happened, and what happens");
    events.footer("With -o json one line for each event. With --follow a service that is away is waited for, and then\n"
                  "what was missed is shown; Ctrl-C ends it.");
    events.add_flag("-f,--follow", options->follow, "Go on with what happens");
    CLI::Option* const after = events.add_option("--after", options->after, "All behind the event with this number")
                                   ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
    events.add_option("--limit", options->limit, "So many of the newest")
        ->capture_default_str()
        ->check(CLI::Range(0, 100'000))
        ->excludes(after);
    events.add_option("--printer", options->printer, "Only those of this printer");
    events.add_option("--job", options->job, "Only those of this job");
    add_common(events, options->common);
    commands.push_back({&events, [options] { return client::run_events(*options); }});
}

void add_audit(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::AuditOptions>();
    CLI::App& audit = *app.add_subcommand("audit", "Show who has changed what, and who was refused");
    audit.add_option("--limit", options->limit, "So many of the newest")
        ->capture_default_str()
        ->check(CLI::Range(1, 1'000'000));
    add_common(audit, options->common);
    commands.push_back({&audit, [options] { return client::run_audit(*options); }});
}

} // namespace

void define_service(CLI::App& app, Commands& commands) {
    add_plain(app, commands, "status", "Show the service and its printers", client::run_status);
    add_watch(app, commands);
    add_events(app, commands);
    add_plain(app, commands, "folders", "List the drop folders, and what stays in them", client::run_folders);
    add_audit(app, commands);
    add_plain(app, commands, "reload", "Let the service read its configuration again, whole or not at all",
              client::run_reload);
}

} // namespace linefeed
