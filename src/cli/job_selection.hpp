// From a file to its job in the spool: the one that was imported from it before, or a new import. A changed file is
// never taken for the old one, and an old one never for new: both would print numbers twice.
#pragma once

#include "base/failure.hpp"
#include "cli/print_options.hpp"
#include "cli/source_import.hpp"

#include <memory>
#include <optional>

namespace linefeed::cli {

struct JobSelection {
    std::optional<spool::Job> job; ///< absent: refused because of bad rows, see report
    intake::ImportReport report;   ///< of this import; empty for a job that was there already
    bool imported = false;
    std::unique_ptr<daemon::RunningImport> running{}; ///< goes on while the job is printed
    bool refused = false; ///< a bad row has ended the import of a job of which something is printed
};

/// Finds or imports the job for `options.file`, or begins to import it (options.while_importing). FailureKind::input if
/// the file changed while its job is unfinished, or grew behind a finished one (unless options.new_job).
[[nodiscard]] Result<JobSelection> select_job(const PrintOptions& options, spool::Spool& spool,
                                              const ImportProgress& on_progress);

} // namespace linefeed::cli
