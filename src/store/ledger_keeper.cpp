#include "store/ledger_keeper.hpp"

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

} // namespace

feeder::Settle in_job(const feeder::Settle& settle, const JobPlaces& places) {
    feeder::Settle own = settle;
    own.verdict.printed = places.records(settle.verdict.printed);
    own.verdict.in_doubt = places.records(settle.verdict.in_doubt);
    own.verdict.unused = places.records(settle.verdict.unused);
    return own;
}

Result<void> append_all(spool::Spool& spool, std::vector<spool::JobRows> rows) {
    std::erase_if(rows, [](const spool::JobRows& job) { return job.entries.empty(); });
    return rows.empty() ? Result<void>{} : spool.append_together(rows);
}

LedgerKeeper::LedgerKeeper(spool::Spool& spool, spool::JobId job, RecordRange wanted, std::string printer,
                           std::optional<OpenIssue> open)
    : spool_(spool)
    , job_(job)
    , wanted_(wanted)
    , printer_(std::move(printer))
    , open_(std::move(open)) {}

Result<spool::JobRows> LedgerKeeper::verdict_rows(spool::JobId job, spool::RunId run, const feeder::Settle& settle) {
    const auto state = spool_.ledger_state(job);
    if (!state) {
        return state.error();
    }
    const std::string evidence = settle_json(settle);
    spool::JobRows rows{job, {}};
    const auto add = [&](LedgerKind kind, RecordRange range) {
        if (!range.empty()) {
            rows.entries.push_back({kind, run, range, evidence});
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
    return rows;
}

Result<spool::JobRows> LedgerKeeper::verdict_rows(const feeder::Settle& settle) {
    LINEFEED_ASSERT(!has_pending());
    if (!settle.verdict.printed.empty()) {
        printed_through_ = settle.verdict.printed.last();
    }
    return verdict_rows(job_, *run_, settle);
}

Result<void> LedgerKeeper::settle_earlier(const feeder::Settle& settle) {
    LINEFEED_ASSERT(open_.has_value());
    std::vector<spool::JobRows> rows;
    for (const OpenJob& open : open_->jobs) {
        auto own = verdict_rows(open.job, open.run, in_job(settle, open.places));
        if (!own) {
            return own.error();
        }
        rows.push_back(std::move(*own));
    }
    return append_all(spool_, std::move(rows));
}

Result<LedgerKeeper::Grant> LedgerKeeper::grant(const feeder::BeginRun& begun) {
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
    if (const auto done = begin(grant.range, run_start_json(printer_, begun, {})); !done) {
        return done.error();
    }
    intent(intent_through_ + std::min(grant.range.count(), RecordCount{first_intents}));
    if (const auto committed = commit(); !committed) {
        return committed.error();
    }
    grant.durable_through = intent_through_;
    return grant;
}

Result<void> LedgerKeeper::begin(RecordRange range, const std::string& evidence) {
    const auto run = spool_.begin_run(job_, range, evidence);
    if (!run) {
        return run.error();
    }
    run_ = *run;
    intent_wanted_ = intent_through_ = printed_through_ = range.first().previous();
    return {};
}

Result<std::optional<LedgerKeeper>> LedgerKeeper::begin_follower(const feeder::BeginRun& begun, spool::JobId job,
                                                                 RecordRange records) const {
    const auto state = spool_.ledger_state(job);
    if (!state) {
        return state.error();
    }
    if (!state->segments().empty()) {
        return std::optional<LedgerKeeper>{};
    }
    LedgerKeeper follower{spool_, job, records, printer_, std::nullopt};
    const std::string evidence = run_start_json(printer_, begun, FollowedRun{job_, *run_});
    if (const auto done = follower.begin(records, evidence); !done) {
        return done.error();
    }
    return std::optional<LedgerKeeper>{std::move(follower)};
}

Result<LedgerKeeper::Grant> LedgerKeeper::adopt(const feeder::AdoptRun& adopted) {
    LINEFEED_ASSERT(make_plan(open_, job_, wanted_).take_over);
    const OpenJob& open = open_->jobs.front();
    run_ = open.run;
    intent_wanted_ = intent_through_ = open_->facts.issued_through;
    printed_through_ = open_->facts.printed_through;
    printed(adopted.printed_through, adopted.evidence);
    if (const auto committed = commit(); !committed) {
        return committed.error();
    }
    return Grant{known_part(open.run_range), intent_through_, false};
}

RecordRange LedgerKeeper::known_part(RecordRange range) const {
    return end_ ? RecordRange::closed(range.first(), std::min(range.last(), *end_)) : range;
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

RecordNumber LedgerKeeper::durably_printed() const {
    return pending_printed_.empty() ? printed_through_ : pending_printed_.first().previous();
}

void LedgerKeeper::confirm(RecordNumber through, const protocol::MailStatus& evidence) {
    printed(through, evidence);
    intent_wanted_ = intent_through_;
}

/// No run has begun, but it was seen that a print of the earlier one may be broken off, or that nobody knows its
/// records.
std::vector<spool::JobRows> LedgerKeeper::rows_about_earlier(const feeder::Outcome& outcome) const {
    std::vector<spool::JobRows> rows;
    if (!open_) {
        return rows;
    }
    const bool broken_off = outcome.broken_off != RecordNumber{} && outcome.broken_off != open_->facts.broken_off;
    const bool unclear = outcome.unclear && !open_->facts.unclear;
    if (!broken_off && !unclear) {
        return rows;
    }
    for (const OpenJob& open : open_->jobs) {
        feeder::Outcome own = outcome;
        own.broken_off = open.places.record_at(outcome.broken_off);
        rows.push_back({open.job, {{LedgerKind::run_ended, open.run, {}, outcome_json(own)}}});
    }
    return rows;
}

Result<std::vector<spool::JobRows>> LedgerKeeper::end_rows(const feeder::Outcome& outcome) {
    if (!run_) {
        return rows_about_earlier(outcome);
    }
    if (const auto committed = commit(); !committed) {
        return committed.error();
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
    std::vector<spool::JobRows> rows;
    rows.push_back({job_, std::move(entries)});
    return rows;
}

Result<void> LedgerKeeper::finish(const feeder::Outcome& outcome) {
    auto rows = end_rows(outcome);
    if (!rows) {
        return rows.error();
    }
    return append_all(spool_, std::move(*rows));
}

} // namespace linefeed::store
