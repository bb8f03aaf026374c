#include "client/file_commands.hpp"
#include "linefeed/definitions.hpp"

#include <memory>

namespace linefeed {

namespace {

using Printer = std::shared_ptr<client::PrinterOptions>;

CLI::App& group_of(CLI::App& printer, const std::string& name) {
    const auto there = printer.get_subcommands([&name](const CLI::App* known) { return known->get_name() == name; });
    CLI::App& group = there.empty() ? *printer.add_subcommand(name) : *there.front();
    group.fallthrough();
    return group;
}

CLI::App& command_in(CLI::App& above, const std::string& name, const std::string& help) {
    CLI::App& command = *above.add_subcommand(name, help);
    command.fallthrough();
    return command;
}

void add_transfers(CLI::App& printer, Commands& commands, const Printer& printer_options) {
    CLI::App& files = group_of(printer, "files");
    const auto got = std::make_shared<client::FileOptions>();
    CLI::App& get = command_in(files, "get", "Copy a file of the printer");
    get.add_option("PATH", got->path, "Path in the printer, e.g. FFSDISK\\Jobs\\Name.job; / is taken for \\")
        ->required();
    get.add_option("FILE", got->local, "Where to; - is stdout; default: under the same name");
    get.add_flag("--replace", got->replace, "Replace FILE");
    get.footer("The file is there whole, or not at all. The printer does not tell a missing file from an empty one.");
    commands.push_back({&get, [=] {
                            got->printer = *printer_options;
                            return client::run_file_get(*got);
                        }});
    const auto sent = std::make_shared<client::FileOptions>();
    CLI::App& put = command_in(files, "put", "Copy a file to the printer");
    put.add_option("FILE", sent->local, "File here")->required();
    put.add_option("PATH", sent->path, "Path in the printer, e.g. FFSDISK\\Jobs\\Name.job; / is taken for \\")
        ->required();
    put.add_flag("--replace", sent->replace, "Replace a file of that name; refused while a job is printed");
    commands.push_back({&put, [=] {
                            sent->printer = *printer_options;
                            return client::run_file_put(*sent);
                        }});
}

void add_folders(CLI::App& printer, Commands& commands, const Printer& printer_options) {
    const auto saved = std::make_shared<client::FolderOptions>();
    CLI::App& backup = command_in(printer, "backup", "Save jobs, fonts and graphics of all devices in a folder");
    backup.add_option("FOLDER", saved->folder, "Made if it is not there; a backup that broke off goes on")->required();
    commands.push_back({&backup, [=] {
                            saved->printer = *printer_options;
                            return client::run_backup(*saved);
                        }});
    const auto restored = std::make_shared<client::FolderOptions>();
    CLI::App& restore = command_in(printer, "restore", "Bring a backup back into the printer, and read it back");
    restore.add_option("FOLDER", restored->folder, "What backup has made; it is checked before anything is written")
        ->required();
    restore.add_flag("--other-printer", restored->other_printer, "Also into a printer with another serial number");
    restore.add_flag("-y,--yes", restored->yes, "Without asking");
    restore.footer("Refused while a job is printed. Files that the backup does not have are left alone.");
    commands.push_back({&restore, [=] {
                            restored->printer = *printer_options;
                            return client::run_restore(*restored);
                        }});
}

void add_scripts(CLI::App& printer, Commands& commands, const Printer& printer_options) {
    CLI::App& script = group_of(printer, "script");
    const auto got = std::make_shared<client::ScriptOptions>();
    CLI::App& get = command_in(script, "get", "The current job as a script");
    get.add_option("FILE", got->file, "Where to; default: stdout");
    get.add_flag("--replace", got->replace, "Replace FILE");
    commands.push_back({&get, [=] {
                            got->printer = *printer_options;
                            return client::run_script_get(*got);
                        }});
    const auto sent = std::make_shared<client::ScriptOptions>();
    CLI::App& send = command_in(script, "send", "Send a script, which replaces the current job");
    send.add_option("FILE", sent->file, "Its lines, in UTF-8")->required();
    send.add_flag("-y,--yes", sent->yes, "Without asking");
    send.footer("Refused while a job is printed: stop it first.");
    commands.push_back({&send, [=] {
                            sent->printer = *printer_options;
                            return client::run_script_send(*sent);
                        }});
}

void add_preview(CLI::App& printer, Commands& commands, const Printer& printer_options) {
    constexpr std::uint32_t max_scale = 32;
    const auto options = std::make_shared<client::PreviewOptions>();
    CLI::App& preview = command_in(printer, "preview", "What the product will look like, dot by dot");
    CLI::Option* const png =
        preview.add_option("--png", options->png, "Write a PNG instead of drawing on the terminal");
    preview.add_option("--scale", options->scale, "Of the PNG: pixels of a dot")
        ->capture_default_str()
        ->check(CLI::Range(1U, max_scale));
    preview.add_flag("--replace", options->replace, "Replace the file of --png")->needs(png);
    preview.add_flag("--ascii", options->ascii, "A character for each dot");
    commands.push_back({&preview, [=] {
                            options->printer = *printer_options;
                            return client::run_preview(*options);
                        }});
}

} // namespace

void define_files(CLI::App& printer, Commands& commands, const std::shared_ptr<client::PrinterOptions>& options) {
    add_transfers(printer, commands, options);
    add_folders(printer, commands, options);
    add_scripts(printer, commands, options);
    add_preview(printer, commands, options);
}

} // namespace linefeed
