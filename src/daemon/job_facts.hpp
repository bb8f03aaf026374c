// Where a job stands: put together from what the spool knows of it and whether a line is at it now. The service and
// whoever reads a spool without it see the same.
#pragma once

#include "daemon/operations.hpp"
#include "spool/spool.hpp"

#include <map>
#include <optional>
#include <string>

namespace linefeed::daemon {

/// What the spool knows of a job.
struct JobFacts {
    spool::Job job;
    std::optional<spool::Ticket> ticket;
    spool::LedgerState ledger;

    [[nodiscard]] RecordCount in(spool::RecordState state) const { return ledger.count(state); }
    [[nodiscard]] RecordRange next() const { return ledger.next_printable(job.records); }
    /// Something of it was granted to a run: it belongs to a printer.
    [[nodiscard]] bool issued() const { return !ledger.segments().empty(); }
    /// Whatever was granted of it came back unused: nothing of it is on a product, in a printer or in doubt.
    [[nodiscard]] bool untouched() const;
    /// Name of its printer; empty = none.
    [[nodiscard]] std::string printer() const { return ticket ? ticket->printer : std::string{}; }
    /// As it is before anything is written.
    [[nodiscard]] spool::Ticket ticket_or_new() const;
};

/// FailureKind::usage if there is no such job.
[[nodiscard]] Result<JobFacts> read_facts(spool::Spool& spool, spool::JobId id);
[[nodiscard]] Result<JobFacts> read_facts(spool::Spool& spool, spool::Job job);

/// `live` = what its line does with it now; absent = nothing.
[[nodiscard]] JobPhase phase_of(const JobFacts& facts, std::optional<JobPhase> live);

/// Without its place in the queue.
[[nodiscard]] JobView view_of(const JobFacts& facts, std::optional<JobPhase> live);

/// "job 12".
[[nodiscard]] std::string name_of(spool::JobId id);

/// Views of many jobs: each queue is read once. The spool must outlive it.
class JobViews {
public:
    explicit JobViews(spool::Spool& spool)
        : spool_(spool) {}
    /// With its place in the queue.
    [[nodiscard]] Result<JobView> view(const JobFacts& facts, std::optional<JobPhase> live = {});

private:
    using Places = std::map<spool::JobId, std::uint32_t>; ///< in one queue, from 1
    [[nodiscard]] Result<const Places*> places_in(const std::string& printer);

    spool::Spool& spool_;
    std::map<std::string, Places> queues_;
};

} // namespace linefeed::daemon
