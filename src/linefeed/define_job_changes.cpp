#include "client/import_command.hpp"
#include "client/job_commands.hpp"
#include "linefeed/definitions.hpp"

#include <memory>

namespace linefeed {

namespace {

void add_import(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::ImportOptions>();
    CLI::App& import = *app.add_subcommand("import", "Let the service make a job of a CSV file or an SQLite database");
    import.footer("The service reads the file itself, as its own user; over TCP, and with --upload, it is sent.\n"
                  "Exit codes: 0 imported, or there already; 5 rows cannot be printed: each is named, and nothing is\n"
                  "imported.");
    import.add_option("FILE", options->file, "CSV file or SQLite database")->required();
    import.add_option("--printer", options->printer, "Put the job into the queue of this printer");
    import.add_option("--layout", options->layout,
                      "How the file is read: name of a layout in the configuration; default: every column");
    import.add_option("--name", options->name, "Name of the job; default: the file's");
    import.add_flag("--autostart", options->autostart,
                    "The job may start by itself, if the queue of its printer does so");
    import.add_flag("--again", options->again, "Import the same content once more, as a new job");
    import.add_flag("--upload", options->upload, "Send the content, for a file that the service may not read");
    add_common(import, options->common);
    commands.push_back({&import, [options] { return client::run_import(*options); }});
}

void add_show(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::JobOptions>();
    CLI::App& job = *app.add_subcommand("job", "Show one job of the service, and its records in doubt");
    add_job(job, options->job)->required();
    add_common(job, options->common);
    commands.push_back({&job, [options] { return client::run_job(*options); }});
}

void add_queue(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::QueueOptions>();
    CLI::App& queue = *app.add_subcommand("queue", "Put a job behind the last of a printer's queue");
    add_job(queue, options->job)->required();
    queue.add_option("PRINTER", options->printer, "Name of the printer in the configuration")->required();
    add_common(queue, options->common);
    commands.push_back({&queue, [options] { return client::run_queue(*options); }});
}

void add_cancel(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::CancelOptions>();
    CLI::App& cancel = *app.add_subcommand("cancel", "Give a job up; what is printed stays in the ledger");
    add_job(cancel, options->job)->required();
    cancel.add_flag("--yes", options->yes, "Do not ask");
    add_common(cancel, options->common);
    commands.push_back({&cancel, [options] { return client::run_cancel(*options); }});
}

void add_reprint(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::ReprintOptions>();
    CLI::App& reprint =
        *app.add_subcommand("reprint", "Have printed or skipped records printed once more, with the next start");
    reprint.footer("The job stands as stopped then, with these records next. Reason and user stay in the ledger.");
    add_job(reprint, options->job)->required();
    reprint.add_option("--records", options->records, "The records: N-M,N")->required();
    reprint.add_option("--reason", options->reason, "Why, for the ledger")->required();
    reprint.add_flag("--yes", options->yes, "Do not ask");
    add_common(reprint, options->common);
    commands.push_back({&reprint, [options] {
                            if (options->reason.find_first_not_of(" \t") == std::string::npos) {
                                return usage_error("--reason: say why");
                            }
                            return client::run_reprint(*options);
                        }});
}

} // namespace

void define_job_changes(CLI::App& app, Commands& commands) {
    add_import(app, commands);
    add_show(app, commands);
    add_queue(app, commands);
    add_cancel(app, commands);
    add_reprint(app, commands);
}

} // namespace linefeed
