// The kinds of events (EventView::kind): stable names for programs that watch the service.
#pragma once

#include <string_view>

namespace linefeed::daemon::event_kind {

inline constexpr std::string_view service_started = "service.started";
inline constexpr std::string_view service_stopping = "service.stopping";
inline constexpr std::string_view service_reloaded = "service.reloaded";
inline constexpr std::string_view service_reload_refused = "service.reload_refused"; ///< the old settings stay
inline constexpr std::string_view storage_failed = "storage.failed";

inline constexpr std::string_view job_imported = "job.imported";
inline constexpr std::string_view job_queued = "job.queued";
inline constexpr std::string_view job_started = "job.started"; ///< its start has begun
inline constexpr std::string_view job_printing = "job.printing";
inline constexpr std::string_view job_stopped = "job.stopped"; ///< and can be resumed; `record` = the last one printed
inline constexpr std::string_view job_in_doubt = "job.in_doubt";
inline constexpr std::string_view job_settled = "job.settled"; ///< by an operator
inline constexpr std::string_view job_reprint = "job.reprint"; ///< records are to be printed again
inline constexpr std::string_view job_finished = "job.finished";
inline constexpr std::string_view job_cancelled = "job.cancelled";

inline constexpr std::string_view printer_up = "printer.up"; ///< it answers again
inline constexpr std::string_view printer_down = "printer.down";
inline constexpr std::string_view printer_notice = "printer.notice";
inline constexpr std::string_view printer_warning = "printer.warning";
inline constexpr std::string_view printer_error = "printer.error";

inline constexpr std::string_view folder_imported = "folder.imported";
inline constexpr std::string_view folder_duplicate = "folder.duplicate";
inline constexpr std::string_view folder_failed = "folder.failed"; ///< a file that is rejected
inline constexpr std::string_view folder_note = "folder.note";
inline constexpr std::string_view folder_down = "folder.down"; ///< it cannot be used for now
inline constexpr std::string_view folder_up = "folder.up";

} // namespace linefeed::daemon::event_kind
