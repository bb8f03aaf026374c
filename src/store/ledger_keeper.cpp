#include "store/ledger_keeper.hpp"

#include "store/evidence_json.hpp"

#include <algorithm>

namespace linefeed::store {

using spool::LedgerEntry;
using spool::LedgerKind;
using spool::RecordState;

namespace {

/// Intents of the first grant: enough for the first fill of any FIFO; the feeder asks for more as it goes.
constexpr std::uint64_t first_intents = 512;

/// `range` without its part up to and including `last`.
RecordRange behind(RecordRange range, RecordNumber last) {
    if (range.empty() || range.last() <= last) {
        return {};
    }
    return RecordRange::closed(std::max(range.first(), last.next()), range.last());
}

/// `range` without its part behind `last`, which is not before its first record.
RecordRange up_to(RecordRange range, RecordNumber last) {
    return RecordRange::closed(range.first(), std::min(range.last(), last));
}

} // namespace

Result<std::optional<OpenIssue>> find_open_issue(spool::Spool& spool, spool::JobId job) {
    const auto state = spool.ledger_state(job);
    if (!state) {
        return state.error();
    }
    const std::vector<RecordRange> open = state->ranges(RecordState::open);
    if (open.empty()) {
        return std::optional<OpenIssue>{};
    }
    const auto last_run = spool.last_run(job);
    if (!last_run) {
        return last_run.error();
    }
    // A run issues in ascending order and none begins before the last is settled, so what is open is one stretch of the
    // last run.
    LINEFEED_ASSERT(open.size() == 1 && last_run->has_value());
    const spool::LedgerRow& started = (*last_run)->started;
    const auto start = parse_run_start(started.entry.evidence);
    if (!start) {
        return Failure{FailureKind::storage, "the print ledger is damaged: the start of run " +
                                                 std::to_string(static_cast<std::int64_t>(started.entry.run)) +
                                                 " cannot be read"};
    }
    OpenIssue issue;
    issue.job = job;
    issue.run = started.entry.run;
    issue.records = open.front();
    issue.run_range = started.entry.range;
    issue.printer = start->printer;
    issue.facts = {started.entry.range.first(), issue.records.first().previous(),
                   issue.records.last(),        start->serial_number,
                   start->total_before,         start->last_printed_before};
    const auto stored_job = spool.job(job);
    if (!stored_job) {
        return stored_job.error();
    }
    LINEFEED_ASSERT(stored_job->has_value());                    // a job that stands in the ledger stays
    if ((*stored_job)->state != spool::ImportState::importing) { // the run may have begun before the end was known
        issue.run_range = up_to(issue.run_range, (*stored_job)->records.last());
    }
    issue.facts.last = issue.run_range.last();
    if (const auto& ended = (*last_run)->ended) {
        const RunEnd end = parse_run_end(ended->entry.evidence).value_or(RunEnd{});
        issue.facts.broken_off = issue.records.contains(end.broken_off) ? end.broken_off : RecordNumber{};
        issue.facts.unclear = end.unclear;
    }
    return std::optional<OpenIssue>{issue};
}

feeder::FeederPlan make_plan(const std::optional<OpenIssue>& open, spool::JobId job, RecordRange wanted) {
    feeder::FeederPlan plan;
    if (open) {
        plan.open = open->facts;
        plan.doubt_blocks = open->job == job;
        plan.take_over = open->job == job && !wanted.empty() && open->run_range.last() == wanted.last();
    }
    return plan;
}

LedgerKeeper::LedgerKeeper(spool::Spool& spool, spool::JobId job, RecordRange wanted, std::string printer,
                           std::optional<OpenIssue> open)
    : spool_(spool)
    , job_(job)
    , wanted_(wanted)
    , printer_(std::move(printer))
    , open_(std::move(open)) {}

Result<void> LedgerKeeper::append_verdict(spool::JobId job, spool::RunId run, const feeder::Settle& settle) {
    const auto state = spool_.ledger_state(job);
    if (!state) {
        return state.error();
    }
    const std::string evidence = settle_json(settle);
    std::vector<LedgerEntry> entries;
    const auto add = [&](LedgerKind kind, RecordRange range) {
        if (!range.empty()) {
            entries.push_back({kind, run, range, evidence});
        }
    };
    add(LedgerKind::printed, settle.verdict.printed);
    add(LedgerKind::in_doubt, settle.verdict.in_doubt);
    for (RecordRange open : settle.provisional ? std::vector<RecordRange>{} : state->ranges(RecordState::open)) {
        if (!settle.verdict.printed.empty()) {
            open = behind(open, settle.verdict.printed.last());
        }
        if (!settle.verdict.in_doubt.empty()) {
            open = behind(open, settle.verdict.in_doubt.last());
        }
        add(LedgerKind::unused, open);
    }
    return entries.empty() ? Result<void>{} : spool_.append(job, entries);
}

Result<void> LedgerKeeper::settle_earlier(const feeder::Settle& settle) {
    LINEFEED_ASSERT(open_.has_value());
    return append_verdict(open_->job, open_->run, settle);
}

Result<LedgerKeeper::Grant> LedgerKeeper::grant(const feeder::BeginRun& begin) {
    const auto state = spool_.ledger_state(job_);
    if (!state) {
        return state.error();
    }
    Grant grant;
    if (state->count(RecordState::in_doubt) > RecordCount{0}) {
        grant.in_doubt = true;
        return grant;
    }
    grant.range = state->next_printable(known_part(wanted_));
    if (grant.range.empty() || grant.range.first() > imported_through_) {
        grant.range = {};
        return grant;
    }
    const auto run = spool_.begin_run(job_, grant.range, run_start_json(printer_, begin));
    if (!run) {
        return run.error();
    }
    run_ = *run;
    intent_wanted_ = intent_through_ = printed_through_ = grant.range.first().previous();
    intent(intent_through_ + std::min(grant.range.count(), RecordCount{first_intents}));
    if (const auto committed = commit(); !committed) {
        return committed.error();
    }
    grant.durable_through = intent_through_;
    return grant;
}

Result<LedgerKeeper::Grant> LedgerKeeper::adopt(const feeder::AdoptRun& adopted) {
    LINEFEED_ASSERT(make_plan(open_, job_, wanted_).take_over);
    run_ = open_->run;
    intent_wanted_ = intent_through_ = open_->facts.issued_through;
    printed_through_ = open_->facts.printed_through;
    printed(adopted.printed_through, adopted.evidence);
    if (const auto committed = commit(); !committed) {
        return committed.error();
    }
    return Grant{known_part(open_->run_range), intent_through_, false};
}

RecordRange LedgerKeeper::known_part(RecordRange range) const {
    return end_ ? up_to(range, *end_) : range;
}

void LedgerKeeper::imported(RecordNumber through) {
    imported_through_ = through;
    extend_intent();
}

void LedgerKeeper::end_at(RecordNumber last) {
    end_ = last;
}

void LedgerKeeper::intent(RecordNumber through) {
    intent_wanted_ = std::max(intent_wanted_, through);
    extend_intent();
}

void LedgerKeeper::extend_intent() {
    const RecordNumber through = std::min(intent_wanted_, imported_through_);
    if (run_ && through > intent_through_) {
        const RecordNumber first = pending_intent_.empty() ? intent_through_.next() : pending_intent_.first();
        pending_intent_ = RecordRange::closed(first, through);
        intent_through_ = through;
    }
}

void LedgerKeeper::printed(RecordNumber through, const protocol::MailStatus& evidence) {
    if (through > printed_through_) {
        const RecordNumber first = pending_printed_.empty() ? printed_through_.next() : pending_printed_.first();
        pending_printed_ = RecordRange::closed(first, through);
        pending_evidence_ = evidence;
        printed_through_ = through;
    }
}

bool LedgerKeeper::has_pending() const {
    return !pending_intent_.empty() || !pending_printed_.empty();
}

std::vector<LedgerEntry> LedgerKeeper::pending_rows() const {
    LINEFEED_ASSERT(run_.has_value());
    std::vector<LedgerEntry> entries;
    if (!pending_intent_.empty()) {
        entries.push_back({LedgerKind::intent, *run_, pending_intent_, {}});
    }
    if (!pending_printed_.empty()) {
        entries.push_back({LedgerKind::printed, *run_, pending_printed_, mail_json(pending_evidence_)});
    }
    return entries;
}

void LedgerKeeper::rows_written() {
    pending_intent_ = {};
    pending_printed_ = {};
}

Result<void> LedgerKeeper::commit() {
    const std::vector<LedgerEntry> entries = pending_rows();
    rows_written(); // also if it fails: nothing is written after that
    return entries.empty() ? Result<void>{} : spool_.append(job_, entries);
}

Result<void> LedgerKeeper::settle(const feeder::Settle& settle) {
    printed(settle.confirmed_through, settle.evidence.mail);
    intent_wanted_ = intent_through_; // nothing more goes out
    if (const auto committed = commit(); !committed) {
        return committed;
    }
    if (!settle.verdict.printed.empty()) {
        printed_through_ = settle.verdict.printed.last();
    }
    return append_verdict(job_, *run_, settle);
}

/// No run has begun, but it was seen that a print of the earlier one may be broken off, or that nobody knows its
/// records.
Result<void> LedgerKeeper::finish_earlier(const feeder::Outcome& outcome) {
    if (!open_) {
        return {};
    }
    const bool broken_off = outcome.broken_off != RecordNumber{} && outcome.broken_off != open_->facts.broken_off;
    const bool unclear = outcome.unclear && !open_->facts.unclear;
    if (!broken_off && !unclear) {
        return {};
    }
    const LedgerEntry ended{LedgerKind::run_ended, open_->run, {}, outcome_json(outcome)};
    return spool_.append(open_->job, {&ended, 1});
}

Result<void> LedgerKeeper::finish(const feeder::Outcome& outcome) {
    if (!run_) {
        return finish_earlier(outcome);
    }
    if (const auto committed = commit(); !committed) {
        return committed;
    }
    std::vector<LedgerEntry> entries;
    if (!outcome.issued) { // granted, and surely not in the printer
        const auto state = spool_.ledger_state(job_);
        if (!state) {
            return state.error();
        }
        for (const RecordRange open : state->ranges(RecordState::open)) {
            entries.push_back({LedgerKind::unused, *run_, open, outcome_json(outcome)});
        }
    }
    entries.push_back({LedgerKind::run_ended, *run_, {}, outcome_json(outcome)});
    return spool_.append(job_, entries);
}

} // namespace linefeed::store
