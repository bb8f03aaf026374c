// What has to be known before a job is armed: other jobs may have records in the printer whose fate only it knows,
// until it is flushed. They are settled first.
#pragma once

#include "daemon/job_run.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::daemon {

/// Waits until a run that asks about the job `other` is finished, and stops it if somebody wants that.
using WatchRun = std::function<void(JobRun& run, spool::JobId other)>;

/// An inquiry that has failed, and what there is to say besides.
struct Hindrance {
    feeder::Outcome outcome;
    std::string detail;
};

/// The jobs other than `job` that the printer at that address has to be asked about, oldest first.
[[nodiscard]] Result<std::vector<spool::JobId>> other_jobs(RunThreads threads, spool::JobId job,
                                                           const std::string& printer);

/// Asks the printer of `settings` how far it came with records of jobs other than `job`: once where one run has left
/// those of two. Absent = all that it knows is in the ledger now.
[[nodiscard]] Result<std::optional<Hindrance>> settle_other_jobs(RunThreads threads, spool::Spool& spool,
                                                                 spool::JobId job, const JobRunSettings& settings,
                                                                 const WatchRun& watch);

} // namespace linefeed::daemon
