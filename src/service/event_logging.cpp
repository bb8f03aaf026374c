#include "service/event_logging.hpp"

#include "daemon/events.hpp"

#include <algorithm>
#include <array>

namespace linefeed::service {

namespace {

namespace kinds = daemon::event_kind;
using config::LogComponent;
using config::LogLevel;

LogLevel level_of(std::string_view kind) {
    constexpr std::array errors{kinds::storage_failed, kinds::job_in_doubt, kinds::printer_error};
    constexpr std::array warnings{kinds::service_reload_refused, kinds::job_stopped, kinds::printer_warning,
                                  kinds::folder_failed, kinds::folder_down};
    if (std::ranges::find(errors, kind) != errors.end()) {
        return LogLevel::error;
    }
    return std::ranges::find(warnings, kind) != warnings.end() ? LogLevel::warning : LogLevel::info;
}

LogComponent component_of(std::string_view kind) {
    if (kind.starts_with("job.") || kind.starts_with("printer.")) {
        return LogComponent::printer;
    }
    if (kind.starts_with("folder.")) {
        return LogComponent::folder;
    }
    return kind.starts_with("storage.") ? LogComponent::store : LogComponent::service;
}

} // namespace

void log_event(daemon::Log& log, const spool::Event& event) {
    log.write(component_of(event.kind), level_of(event.kind), event.kind + ": " + event.message,
              {event.job, event.printer, event.record});
}

} // namespace linefeed::service
