// Translates between the feeder's view of a run and the rows of the print ledger: which records may be granted, which
// rows a verdict becomes, and what an earlier run has left open. Pure bookkeeping over the spool; called on the store's
// thread only.
#pragma once

#include "base/failure.hpp"
#include "feeder/actions.hpp"
#include "feeder/feeder.hpp"
#include "spool/spool.hpp"

#include <optional>
#include <string>
#include <vector>

namespace linefeed::store {

/// Records issued by an earlier run whose fate is not known, and who issued them.
struct OpenIssue {
    spool::JobId job{};
    spool::RunId run{};
    RecordRange records;
    RecordRange run_range; ///< what the run meant to print
    feeder::OpenRun facts;
    std::string printer; ///< address of the printer that may hold them
};

/// What the job's last run left open; absent if every issued record's fate is known.
[[nodiscard]] Result<std::optional<OpenIssue>> find_open_issue(spool::Spool& spool, spool::JobId job);

/// What the feeder has to know of the open records before it prints `wanted` of `job`. The earlier run may be gone on
/// with if it is of this job and ends where the operator wants it to end.
[[nodiscard]] feeder::FeederPlan make_plan(const std::optional<OpenIssue>& open, spool::JobId job, RecordRange wanted);

/// One job's ledger during one run. Flow: construct, settle_earlier() and grant() as the feeder asks, then intent(),
/// printed(), and at the end settle() and finish().
class LedgerKeeper {
public:
    /// `wanted` = the records the operator asked for.
    LedgerKeeper(spool::Spool& spool, spool::JobId job, RecordRange wanted, std::string printer,
                 std::optional<OpenIssue> open);

    /// The verdict over what the earlier run left open becomes rows, durable at return.
    [[nodiscard]] Result<void> settle_earlier(const feeder::Settle& settle);

    struct Grant {
        RecordRange range;            ///< empty = nothing to print
        RecordNumber durable_through; ///< intents
        bool in_doubt = false;        ///< an operator must decide before anything is printed
    };
    /// Begins the run over the next printable records, with the first intents, durable at return.
    [[nodiscard]] Result<Grant> grant(const feeder::BeginRun& begin);

    /// Goes on with the earlier run, found still printing: its records stay issued, those behind `sent_through` may be
    /// sent. Precondition: FeederPlan::take_over of make_plan().
    [[nodiscard]] Result<Grant> adopt(const feeder::AdoptRun& adopted);

    /// While the job is imported: only the records up to `through` are there. Grows; intents wait for it.
    void imported(RecordNumber through);
    /// While the job is imported: `last` is its last record.
    void end_at(RecordNumber last);

    /// Adds rows without writing them; commit() does. Both grow with `through`; what is known already is left out.
    void intent(RecordNumber through);
    void printed(RecordNumber through, const protocol::MailStatus& evidence);
    [[nodiscard]] bool has_pending() const;
    [[nodiscard]] std::vector<spool::LedgerEntry> pending_rows() const;
    /// pending_rows() are durable.
    void rows_written();
    /// Writes what is pending in one transaction, durable at return.
    [[nodiscard]] Result<void> commit();

    /// The verdict over this run becomes rows: what is neither printed nor in doubt is unused, durable at return.
    [[nodiscard]] Result<void> settle(const feeder::Settle& settle);
    /// The run is over.
    [[nodiscard]] Result<void> finish(const feeder::Outcome& outcome);

    [[nodiscard]] RecordNumber intent_through() const { return intent_through_; }

private:
    [[nodiscard]] Result<void> append_verdict(spool::JobId job, spool::RunId run, const feeder::Settle& settle);
    [[nodiscard]] Result<void> finish_earlier(const feeder::Outcome& outcome);
    [[nodiscard]] RecordRange known_part(RecordRange range) const;

    spool::Spool& spool_;
    spool::JobId job_;
    RecordRange wanted_;
    std::optional<RecordNumber> end_; ///< of the job, where it became known during the run
    std::string printer_;
    std::optional<OpenIssue> open_;
    std::optional<spool::RunId> run_;
    void extend_intent();

    RecordNumber imported_through_ = RecordNumber::max();
    RecordNumber intent_wanted_; ///< asked for, perhaps before the records were there
    RecordNumber intent_through_;
    RecordNumber printed_through_;
    RecordRange pending_intent_;
    RecordRange pending_printed_;
    protocol::MailStatus pending_evidence_;
};

} // namespace linefeed::store
