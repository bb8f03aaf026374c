// From a file to its job in the spool: the one that was imported from it before, or a new import. A changed file is
// never taken for the old one, and an old one never for new: both would print numbers twice.
#pragma once

#include "base/failure.hpp"
#include "cli/print_options.hpp"
#include "intake/import.hpp"
#include "spool/spool.hpp"

#include <functional>
#include <optional>

namespace linefeed::cli {

struct JobSelection {
    std::optional<spool::Job> job; ///< absent: refused because of bad rows, see report
    intake::ImportReport report;   ///< of this import; empty for a job that was there already
    bool imported = false;
};

/// Progress of an import: rows so far and the fraction of the file; false cancels.
using ImportProgress = std::function<bool(const intake::ImportReport&, double)>;

/// Finds or imports the job for `options.file`. FailureKind::input if the file changed while its job is unfinished, or
/// grew behind a finished one (unless options.new_job).
[[nodiscard]] Result<JobSelection> select_job(const PrintOptions& options, spool::Spool& spool,
                                              const ImportProgress& on_progress);

} // namespace linefeed::cli
