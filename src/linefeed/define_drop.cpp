#include "cli/drop_command.hpp"
#include "linefeed/definitions.hpp"

#include <chrono>
#include <memory>

namespace linefeed {

namespace {

using cli::DropOptions;

struct RawDropOptions {
    RawLayout layout;
    std::string mode{"auto"};
    std::string settle{"quiet=2s"};
    std::optional<double> rescan_s;
};

CLI::App& add_drop(CLI::App& app, DropOptions& options, RawDropOptions& raw) {
    CLI::App& drop = *app.add_subcommand("drop", "Import what is dropped into a folder into jobs, until Ctrl-C");
    drop.footer("A file is claimed into processing/, imported, and ends in done/ or failed/, with a report beside it.\n"
                "Nothing is printed. Exit codes: 0 ended, 4 an import was broken off (the next start takes it up),\n"
                "5 with --once: a file was rejected, 2 usage, 1 anything else.");
    drop.add_option("FOLDER", options.settings.folder, "The folder")->required();
    drop.add_option("--pattern", options.settings.pattern, "Names of the files to take, as in the shell")
        ->capture_default_str();
    drop.add_option("--settle", raw.settle,
                    "When a file is complete: quiet=TIME (unchanged for that time, in ms, s or min), rename (at once: "
                    "files are renamed into the folder) or done (when NAME.done lies beside NAME)")
        ->capture_default_str();
    drop.add_option("--mode", raw.mode, "inotify, poll, or auto: poll on network file systems only")
        ->capture_default_str()
        ->check(CLI::IsMember({"auto", "inotify", "poll"}));
    drop.add_option("--rescan", raw.rescan_s, "Seconds between two looks at the whole folder; inotify 30, poll 1")
        ->check(CLI::Range(0.05, 86400.0));
    drop.add_option("--max-bytes", options.settings.max_bytes, "Larger files are rejected unread")
        ->capture_default_str();
    drop.add_flag("--once", options.once, "Import what is there now, and end");
    add_layout(drop, options.settings.layout, raw.layout);
    drop.add_option("--spool", options.spool, "Database of jobs and the print ledger")->capture_default_str();
    add_output(drop, options.json);
    return drop;
}

/// What is wrong with the options, or nothing.
std::string finish_options(DropOptions& options, const RawDropOptions& raw) {
    if (raw.mode != "auto") {
        options.settings.mode = raw.mode == "poll" ? intake::WatchMode::poll : intake::WatchMode::inotify;
    }
    if (raw.rescan_s) {
        options.settings.rescan = std::chrono::duration_cast<Duration>(std::chrono::duration<double>{*raw.rescan_s});
    }
    const auto settle = intake::parse_settle_rule(raw.settle);
    if (!settle) {
        return "--settle " + raw.settle + ": expected rename, done or quiet=TIME, for example quiet=2s";
    }
    options.settings.settle = *settle;
    return finish_layout(options.settings.layout, raw.layout);
}

} // namespace

void define_drop(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<DropOptions>();
    const auto raw = std::make_shared<RawDropOptions>();
    options->spool = default_spool();
    CLI::App& drop = add_drop(app, *options, *raw);
    commands.push_back({&drop, [options, raw] {
                            const std::string problem = finish_options(*options, *raw);
                            return problem.empty() ? cli::run_drop(*options) : usage_error(problem);
                        }});
}

} // namespace linefeed
