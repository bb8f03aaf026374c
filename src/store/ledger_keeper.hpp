// Translates between what becomes of the records of one job in one run and the rows of the print ledger: which records
// may be granted, and which rows a verdict becomes. It knows them by their numbers. Pure bookkeeping over the spool;
// called on the store's thread only.
#pragma once

#include "base/failure.hpp"
#include "feeder/actions.hpp"
#include "spool/spool.hpp"
#include "store/evidence_json.hpp"
#include "store/open_issue.hpp"

#include <optional>
#include <string>
#include <vector>

namespace linefeed::store {

/// What the verdict says of the records of one job, by their numbers.
[[nodiscard]] feeder::Settle in_job(const feeder::Settle& settle, const JobPlaces& places);

/// Appends rows of several jobs in one transaction, if there are any; durable at return.
[[nodiscard]] Result<void> append_all(spool::Spool& spool, std::vector<spool::JobRows> rows);

/// One job's ledger during one run. Flow: construct, settle_earlier() and grant() as the feeder asks, then intent(),
/// printed(), and at the end confirm(), commit(), verdict_rows(), and finish().
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
    /// The same for `job`, none of which is issued, behind this run and without intents. Absent: its records cannot be
    /// printed as a whole.
    [[nodiscard]] Result<std::optional<LedgerKeeper>> begin_follower(const feeder::BeginRun& begin, spool::JobId job,
                                                                     RecordRange records) const;

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

    /// Nothing more of the run goes out, and records up to this one were confirmed before its verdict.
    void confirm(RecordNumber through, const protocol::MailStatus& evidence);
    /// The verdict over this run as rows: what is neither printed nor in doubt is unused. Precondition: nothing is
    /// pending.
    [[nodiscard]] Result<spool::JobRows> verdict_rows(const feeder::Settle& settle);
    /// The run is over: writes what is pending, and what else there is to write behind it, of all jobs it is about.
    [[nodiscard]] Result<std::vector<spool::JobRows>> end_rows(const feeder::Outcome& outcome);
    /// The same, and writes those.
    [[nodiscard]] Result<void> finish(const feeder::Outcome& outcome);

    [[nodiscard]] spool::JobId job() const { return job_; }
    [[nodiscard]] RecordNumber intent_through() const { return intent_through_; }
    /// As written.
    [[nodiscard]] RecordNumber durably_printed() const;

private:
    [[nodiscard]] Result<void> begin(RecordRange range, const std::string& evidence);
    [[nodiscard]] Result<spool::JobRows> verdict_rows(spool::JobId job, spool::RunId run, const feeder::Settle& settle);
    [[nodiscard]] std::vector<spool::JobRows> rows_about_earlier(const feeder::Outcome& outcome) const;
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
