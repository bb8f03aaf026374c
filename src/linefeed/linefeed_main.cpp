// The command line of linefeed: reads it, and runs the command.
#include "linefeed/definitions.hpp"

#include <iostream>
#include <string>

namespace {

using linefeed::cli::ExitCode;

/// What is wrong where a command of a group is missing or is none of its commands; empty = something else is.
std::string missing_command(const CLI::App& app) {
    const CLI::App* group = &app;
    std::string path;
    while (!group->get_subcommands().empty()) {
        group = group->get_subcommands().back();
        path += group->get_name() + ' ';
    }
    if (group->get_require_subcommand_min() == 0) {
        return {};
    }
    std::string names;
    for (const CLI::App* const command : group->get_subcommands([](const CLI::App*) { return true; })) {
        names += (names.empty() ? "" : ", ") + path + command->get_name();
    }
    const auto others = app.remaining(true);
    return (others.empty() ? "a command is missing; there is: "
                           : '"' + path + others.front() + "\" is no command; there is: ") +
           names;
}

ExitCode run(int argc, char** argv) {
    CLI::App app{"linefeed streams the records of a database into the mailing FIFO of Leibinger JET printers: every "
                 "record once, in order.\nprint and drop work by themselves, in the foreground; jobs and ledger read "
                 "what they have left, or ask the service linefeedd, as the others do."};
    app.set_version_flag("--version", "linefeed " LINEFEED_VERSION);
    app.require_subcommand(1);
    linefeed::Commands commands;
    linefeed::define_print(app, commands);
    linefeed::define_drop(app, commands);
    linefeed::define_job_changes(app, commands);
    linefeed::define_jobs(app, commands);
    linefeed::define_starts(app, commands);
    linefeed::define_printers(app, commands);
    linefeed::define_service(app, commands);
    linefeed::define_checks(app, commands);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return static_cast<ExitCode>(app.exit(success));
    } catch (const CLI::ParseError& error) {
        const std::string missing = missing_command(app);
        return linefeed::usage_error((missing.empty() ? error.what() : missing) +
                                     " (linefeed --help, or linefeed COMMAND --help, shows the options)");
    }
    for (const linefeed::Command& command : commands) {
        if (command.app->parsed()) {
            return command.run();
        }
    }
    return ExitCode::usage; // not reached: a subcommand is required
}

} // namespace

int main(int argc, char** argv) {
    try {
        return static_cast<int>(run(argc, argv));
    } catch (const std::exception& exception) {
        std::cerr << "linefeed: " << exception.what() << '\n';
        return static_cast<int>(ExitCode::other);
    }
}
