#include "client/printer_commands.hpp"

#include "client/printer_text.hpp"

#include <limits>

namespace linefeed::client {

namespace {

/// Every item of a list: printers, frames and folders are few.
Result<std::vector<Json>> all_of(Service& service, std::string_view target) {
    return service.list(target, std::numeric_limits<std::size_t>::max());
}

/// The printer as it is now.
Result<ExitCode> show_printer(Service& service, const PrinterOptions& options) {
    const auto printer = service.get(printer_path(options.printer));
    if (!printer) {
        return printer.error();
    }
    if (options.common.json) {
        show_json(*printer);
    } else {
        show(printer_text(*printer, stdout_screen()));
    }
    return ExitCode::done;
}

/// The error that the printer shows now.
Result<std::int64_t> shown_error(Service& service, const PrinterOptions& options) {
    const auto status = service.get(printer_path(options.printer, "/inspect/status"));
    if (!status) {
        return status.error();
    }
    const auto code = whole(member(*status, "error"), "code");
    return code ? Result<std::int64_t>{*code} : Failure{FailureKind::stopped, "the printer shows no error"};
}

Result<ExitCode> change(Service& service, const PrinterOptions& options, std::string_view what, const Json& body) {
    const auto changed = service.post(printer_path(options.printer, what), body);
    if (!changed) {
        return changed.error();
    }
    if (options.common.json) {
        const auto printer = service.get(printer_path(options.printer));
        if (!printer) {
            return printer.error();
        }
        show_json(*printer);
    }
    return ExitCode::done;
}

} // namespace

ExitCode run_printers(const CommonOptions& options) {
    return run_with_service(options, [&](Service& service) -> Result<ExitCode> {
        const auto printers = all_of(service, "/api/v1/printers");
        if (!printers) {
            return printers.error();
        }
        if (options.json) {
            show_json(*printers);
        } else {
            show(printers_text(*printers, stdout_screen()));
        }
        return ExitCode::done;
    });
}

ExitCode run_printer(const PrinterOptions& options) {
    return run_with_service(options.common, [&](Service& service) { return show_printer(service, options); });
}

ExitCode run_preflight(const PrinterOptions& options) {
    return run_with_service(options.common, [&](Service& service) -> Result<ExitCode> {
        const auto findings = service.post(printer_path(options.printer, "/preflight"));
        if (!findings) {
            return findings.error();
        }
        if (options.common.json) {
            show_json(*findings);
        } else {
            show(findings_text(items(*findings), stdout_screen()));
        }
        return flag(*findings, "ok") ? ExitCode::done : ExitCode::stopped;
    });
}

ExitCode run_frames(const FramesOptions& options) {
    return run_with_service(options.printer.common, [&](Service& service) -> Result<ExitCode> {
        const auto frames =
            all_of(service, printer_path(options.printer.printer, options.error ? "/frames?error=true" : "/frames"));
        if (!frames) {
            return frames.error();
        }
        if (options.printer.common.json) {
            show_json(*frames);
        } else {
            show(frames_text(*frames, stdout_screen()));
        }
        return ExitCode::done;
    });
}

ExitCode run_acknowledge(const AcknowledgeOptions& options) {
    return run_with_service(options.printer.common, [&](Service& service) -> Result<ExitCode> {
        const auto error = options.error ? Result<std::int64_t>{*options.error} : shown_error(service, options.printer);
        if (!error) {
            return error.error();
        }
        auto done = change(service, options.printer, "/acknowledge", {{"error", *error}});
        if (done && !options.printer.common.json) {
            show(options.printer.printer + ": error " + std::to_string(*error) + " is acknowledged\n");
        }
        return done;
    });
}

ExitCode run_accept(const AcceptOptions& options) {
    return run_with_service(options.printer.common, [&](Service& service) -> Result<ExitCode> {
        auto done = change(service, options.printer, "/accept", {{"serial_number", options.serial_number}});
        if (done && !options.printer.common.json) {
            show(options.printer.printer + ": the machine with serial number " + options.serial_number +
                 " is accepted\n");
        }
        return done;
    });
}

ExitCode run_suspend(const SuspendOptions& options) {
    return run_with_service(options.printer.common, [&](Service& service) -> Result<ExitCode> {
        Json body{{"suspend", options.suspend}};
        if (options.suspend) {
            body["hold_s"] = options.hold_s;
        }
        auto done = change(service, options.printer, "/suspend", body);
        if (done && !options.printer.common.json) {
            show(options.printer.printer + (options.suspend
                                                ? ": the panel is suspended for " + std::to_string(options.hold_s) +
                                                      " s; the same command again prolongs it, release gives it back\n"
                                                : ": the panel is given back\n"));
        }
        return done;
    });
}

} // namespace linefeed::client
