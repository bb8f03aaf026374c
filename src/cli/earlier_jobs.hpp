// What a new job may have to do with the jobs that are there: records that were printed under another name must not be
// printed again unnoticed.
#pragma once

#include "base/failure.hpp"
#include "spool/spool.hpp"

#include <optional>
#include <string>

namespace linefeed::cli {

/// "job 12".
[[nodiscard]] std::string name_of(const spool::Job& job);

/// Printed, or in doubt for good.
[[nodiscard]] Result<RecordCount> printed_of(spool::Spool& spool, const spool::Job& job);

/// Refuses new records under the name of an earlier job whose records they may repeat.
[[nodiscard]] Result<void> check_earlier_jobs(spool::Spool& spool, const spool::Job& job);

/// Refuses a copy of a file of which a part was printed while it was imported, and whose import is not finished.
[[nodiscard]] Result<void> check_unfinished(spool::Spool& spool, const spool::Job& job);

/// The job with the same records that takes the place of `job`; absent = there is none. A new job may repeat one that
/// is finished; FailureKind::usage otherwise.
[[nodiscard]] Result<std::optional<spool::Job>> twin_of(spool::Spool& spool, const spool::Job& job, bool new_job);

/// Whether records of the job `id`, of which only the first are known so far, may have been printed as another job:
/// then it has to be compared as a whole before anything is printed.
[[nodiscard]] Result<bool> may_be_known(spool::Spool& spool, const spool::JobSpec& spec, spool::JobId id, bool new_job);

} // namespace linefeed::cli
