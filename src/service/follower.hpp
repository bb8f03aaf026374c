// The job that follows the one at work without a stop of the line: what it has to be like, as far as the jobs
// themselves tell. Whether its records can follow in the FIFO the run finds out.
#pragma once

#include "daemon/job_facts.hpp"
#include "daemon/record_text.hpp"

#include <cstddef>
#include <optional>

namespace linefeed::service {

/// What may follow the job at work: the conversation that sends the records stays as it was begun.
struct FollowerWanted {
    spool::JobId behind{};                          ///< the job at work
    RecordRange run{};                              ///< what of it is being printed
    daemon::RecordFormat format{};                  ///< of the records that the conversation was begun for
    bool has_escapes = true;                        ///< the printer understands them
    std::optional<std::size_t> most_record_bytes{}; ///< see daemon::record_bytes(); absent = any
};

/// Whether every record of the job is printed, or left out, once the run has printed all of `run`.
[[nodiscard]] bool ends_with(const daemon::JobFacts& facts, RecordRange run);

/// Whether the records of the job, which waits in the queue, can go the way of those before them. Their escapes are not
/// looked at.
[[nodiscard]] bool fits_behind(const daemon::JobFacts& next, const FollowerWanted& wanted);

} // namespace linefeed::service
