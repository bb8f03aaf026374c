// What earlier runs have left open in a printer, read from the ledger. Where a job followed another without a stop,
// records of both may lie in one FIFO: then they are asked about together.
#pragma once

#include "base/failure.hpp"
#include "feeder/actions.hpp"
#include "feeder/feeder.hpp"
#include "spool/spool.hpp"
#include "store/job_places.hpp"

#include <optional>
#include <string>
#include <vector>

namespace linefeed::store {

/// Records of one job that its last run has issued, and whose fate is not known.
struct OpenJob {
    spool::JobId job{};
    spool::RunId run{};
    RecordRange records;
    RecordRange run_range; ///< what the run meant to print
    JobPlaces places;      ///< among those of the issue
};

/// Records issued by earlier runs whose fate is not known, and who issued them.
struct OpenIssue {
    std::vector<OpenJob> jobs; ///< one, or one and its follower
    feeder::OpenRun facts;     ///< of all
    feeder::Numbering numbering;
    std::string printer; ///< address of the printer that may hold them

    /// nullptr = no record of this job is open.
    [[nodiscard]] const OpenJob* of(spool::JobId job) const;
};

/// What the job's last run left open, and with it what a run that followed it, or that it followed; absent if the fate
/// of every issued record of the job is known.
[[nodiscard]] Result<std::optional<OpenIssue>> find_open_issue(spool::Spool& spool, spool::JobId job);

/// What the feeder has to know of the open records before it prints `wanted` of `job`. The earlier run may be gone on
/// with if it is of this job alone and ends where the operator wants it to end.
[[nodiscard]] feeder::FeederPlan make_plan(const std::optional<OpenIssue>& open, spool::JobId job, RecordRange wanted);

} // namespace linefeed::store
