#include "client/printer_commands.hpp"
#include "client/task_command.hpp"
#include "linefeed/definitions.hpp"
#include "printer/tasks.hpp"
#include "protocol/profile.hpp"

#include <memory>

namespace linefeed {

namespace {

void add_printers(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::CommonOptions>();
    CLI::App& printers = *app.add_subcommand("printers", "List the printers, what they do, and what is wrong");
    add_common(printers, *options);
    commands.push_back({&printers, [options] { return client::run_printers(*options); }});
}

/// What the service alone can tell.
cli::ExitCode of_service_only(const client::PrinterOptions& options, const std::function<cli::ExitCode()>& run) {
    return client::is_address(options.printer)
               ? usage_error("that is what the service knows: say a printer's name instead of " + options.printer)
               : run();
}

/// `linefeed printer NAME …`: what is done with the one printer. Options may stand in front of the action or behind it.
void add_printer(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::PrinterOptions>();
    const auto error = std::make_shared<bool>(false);
    const auto code = std::make_shared<std::optional<std::int64_t>>();
    const auto serial_number = std::make_shared<std::string>();
    const auto hold_s = std::make_shared<std::int64_t>(60);
    CLI::App& printer = *app.add_subcommand("printer", "Show one printer, or do something with it");
    printer
        .add_option("PRINTER", options->printer,
                    "Its name in the configuration, or its address (tcp://HOST:PORT, serial:///DEVICE) to ask it "
                    "without the service")
        ->required();
    add_common(printer, options->common);
    constexpr const char* group = "With an address";
    printer
        .add_option("--profile", options->direct.profile,
                    "Firmware profile: " + protocol::profile_names() +
                        "; default: as the printer says (?VS), jet3up if it does not tell")
        ->group(group);
    printer
        .add_option("--errors", options->direct.errors,
                    "Table of error numbers; default: /etc/linefeed/errors.yaml, if it is there")
        ->group(group);
    printer.require_subcommand(0, 1);

    CLI::App& preflight = *printer.add_subcommand("preflight", "Ask the printer whether a job could start");
    preflight.footer("Exit codes: 0 it could, 4 it could not: each finding says what to do.");
    CLI::App& frames = *printer.add_subcommand("frames", "Show the last frames each way");
    frames.add_flag("--error", *error, "Those before the last error, if there was one");
    CLI::App& acknowledge = *printer.add_subcommand("acknowledge", "Acknowledge the error that the printer shows");
    acknowledge.alias("ack");
    acknowledge.add_option("ERROR", *code, "Its number; another one is left alone. Default: the one that is shown now")
        ->check(CLI::Range(1, 33'554'431));
    CLI::App& accept =
        *printer.add_subcommand("accept", "The printer was exchanged: accept the machine that answers now");
    accept
        .add_option("SERIAL", *serial_number, "Its serial number, see linefeed printer PRINTER; another one is refused")
        ->required();
    CLI::App& suspend = *printer.add_subcommand("suspend", "Suspend the panel, so that nobody presses a key on it");
    suspend.add_option("--hold", *hold_s, "Seconds until it is given back by itself")
        ->capture_default_str()
        ->check(CLI::Range(1, 86'400));
    CLI::App& release = *printer.add_subcommand("release", "Give the panel back");
    for (CLI::App* const action : {&preflight, &frames, &acknowledge, &accept, &suspend, &release}) {
        action->fallthrough();
    }

    commands.push_back(
        {&preflight, [options] { return of_service_only(*options, [&] { return client::run_preflight(*options); }); }});
    commands.push_back({&frames, [options, error] {
                            return of_service_only(*options, [&] { return client::run_frames({*options, *error}); });
                        }});
    commands.push_back({&acknowledge, [options, code] {
                            if (!client::is_address(options->printer)) {
                                return client::run_acknowledge({*options, *code});
                            }
                            client::TaskOptions task{*options, printer::find_task("acknowledge"), {}, true};
                            if (*code) {
                                task.arguments.emplace_back("error", std::to_string(**code));
                            }
                            return client::run_task(task);
                        }});
    commands.push_back(
        {&accept, [options, serial_number] {
             return of_service_only(*options, [&] { return client::run_accept({*options, *serial_number}); });
         }});
    commands.push_back({&suspend, [options, hold_s] {
                            const client::SuspendOptions all{*options, true, *hold_s};
                            return client::is_address(options->printer) ? client::run_direct_suspend(all)
                                                                        : client::run_suspend(all);
                        }});
    commands.push_back({&release, [options] {
                            return client::is_address(options->printer)
                                       ? client::run_task({*options, printer::find_task("release"), {}, true})
                                       : client::run_suspend({*options, false});
                        }});
    define_tasks(printer, commands, options);
    commands.push_back({&printer, [options] {
                            return client::is_address(options->printer)
                                       ? client::run_task({*options, printer::find_task("status"), {}, false})
                                       : client::run_printer(*options);
                        }});
}

void add_stop(CLI::App& app, Commands& commands) {
    const auto options = std::make_shared<client::StopOptions>();
    CLI::App& stop = *app.add_subcommand("stop", "Stop a printer, and show where its job stands");
    stop.footer("Ends when the truth is in the ledger. Exit codes: 0 stopped, 6 and records are in doubt.");
    CLI::Option* const name = stop.add_option("PRINTER", options->printer,
                                              "Its name in the configuration; default: the only one that prints");
    stop.add_flag("--all", options->all, "Every printer that prints")->excludes(name);
    add_common(stop, options->common);
    commands.push_back({&stop, [options] { return client::run_stop(*options); }});
}

} // namespace

void define_printers(CLI::App& app, Commands& commands) {
    add_stop(app, commands);
    add_printers(app, commands);
    add_printer(app, commands);
}

} // namespace linefeed
