#include "client/service_commands.hpp"

#include "cli/progress_view.hpp"
#include "client/printer_text.hpp"
#include "client/service_text.hpp"

#include <algorithm>
#include <limits>

namespace linefeed::client {

namespace {

constexpr std::size_t everything = std::numeric_limits<std::size_t>::max();

Result<ExitCode> status(Service& service, bool json) {
    const auto status = service.get("/api/v1/status");
    if (!status) {
        return status.error();
    }
    const auto printers = service.list("/api/v1/printers", everything);
    if (!printers) {
        return printers.error();
    }
    if (json) {
        show_json({{"service", *status}, {"printers", *printers}});
        return ExitCode::done;
    }
    const Screen screen = stdout_screen();
    show(status_text(*status, screen) + '\n' + printers_text(*printers, screen));
    return ExitCode::done;
}

Result<ExitCode> audit(Service& service, const AuditOptions& options) {
    const auto first = service.get("/api/v1/audit?limit=1");
    if (!first) {
        return first.error();
    }
    const auto newest = static_cast<std::size_t>(std::max<std::int64_t>(0, number(*first, "last_id")));
    const std::size_t after = newest - std::min(newest, options.limit);
    const auto entries = service.list("/api/v1/audit?limit=1000&after=" + std::to_string(after), everything);
    if (!entries) {
        return entries.error();
    }
    if (options.common.json) {
        show_json(*entries);
    } else {
        show(audit_text(*entries, stdout_screen()));
    }
    return ExitCode::done;
}

Result<ExitCode> reload(Service& service, bool json) {
    const auto changes = service.post("/api/v1/reload");
    if (!changes) {
        return changes.error();
    }
    if (json) {
        show_json(*changes);
        return ExitCode::done;
    }
    const Json& lines = items(*changes, "changes");
    for (const Json& line : lines) {
        show(cli::printable(line.is_string() ? line.get<std::string>() : std::string{}) + '\n');
    }
    if (lines.empty()) {
        show("nothing has changed\n");
    }
    return ExitCode::done;
}

} // namespace

ExitCode run_status(const CommonOptions& options) {
    return run_with_service(options, [&](Service& service) { return status(service, options.json); });
}

ExitCode run_folders(const CommonOptions& options) {
    return run_with_service(options, [&](Service& service) -> Result<ExitCode> {
        const auto folders = service.list("/api/v1/folders", everything);
        if (!folders) {
            return folders.error();
        }
        if (options.json) {
            show_json(*folders);
        } else {
            show(folders_text(*folders, stdout_screen()));
        }
        return ExitCode::done;
    });
}

ExitCode run_audit(const AuditOptions& options) {
    return run_with_service(options.common, [&](Service& service) { return audit(service, options); });
}

ExitCode run_reload(const CommonOptions& options) {
    return run_with_service(options, [&](Service& service) { return reload(service, options.json); });
}

} // namespace linefeed::client
