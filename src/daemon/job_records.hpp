// What is printed on the records of a job, for people.
#pragma once

#include "daemon/operations.hpp"
#include "spool/spool.hpp"

#include <functional>
#include <span>
#include <vector>

namespace linefeed::daemon {

/// Calls `take` with each record of the ranges, which are of the job and ascending, until it returns false. Each page
/// is read once.
[[nodiscard]] Result<void> for_each_record(spool::Spool& spool, const spool::Job& job,
                                           std::span<const RecordRange> ranges,
                                           const std::function<bool(DoubtView::Record)>& take);

/// The first `limit` of the records that the job has in these ranges, ascending.
[[nodiscard]] Result<std::vector<DoubtView::Record>> records_of(spool::Spool& spool, const spool::Job& job,
                                                                std::span<const RecordRange> ranges, std::size_t limit);

} // namespace linefeed::daemon
