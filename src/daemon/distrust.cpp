#include "daemon/distrust.hpp"

#include "base/assert.hpp"
#include "spool/json_text.hpp"

namespace linefeed::daemon {

namespace {

using spool::LedgerEntry;
using spool::LedgerKind;
using spool::LedgerState;
using spool::RecordState;

/// Records that would be printed without a question, stretch by stretch.
std::vector<RecordRange> printable(const LedgerState& state, RecordRange records) {
    std::vector<RecordRange> stretches;
    while (!records.empty()) {
        const RecordRange next = state.next_printable(records);
        if (next.empty()) {
            break;
        }
        stretches.push_back(next);
        records =
            next.last() == records.last() ? RecordRange{} : RecordRange::closed(next.last().next(), records.last());
    }
    return stretches;
}

/// What is open belongs to a run that is over, and its printer has gone on since: the records are taken back from it,
/// so that they and what follows them are one stretch in doubt, which one product can tell about.
std::vector<LedgerEntry> take_back_open(LedgerState& state, const std::string& evidence) {
    std::vector<LedgerEntry> entries;
    for (const spool::LedgerSegment& segment : state.segments()) {
        if (segment.state == RecordState::open) {
            entries.push_back({LedgerKind::in_doubt, segment.run, segment.range, evidence});
            entries.push_back({LedgerKind::released, segment.run, segment.range, evidence});
        }
    }
    for (const LedgerEntry& entry : entries) {
        LINEFEED_ASSERT(state.apply(entry));
    }
    return entries;
}

Result<void> distrust_job(spool::Spool& spool, const spool::Job& job, LedgerState state, const std::string& evidence) {
    std::vector<LedgerEntry> entries = take_back_open(state, evidence);
    const std::vector<RecordRange> stretches = printable(state, job.records);
    if (stretches.empty()) {
        return {};
    }
    const auto run =
        spool.begin_run(job.id, RecordRange::closed(stretches.front().first(), stretches.back().last()), evidence);
    if (!run) {
        return run.error();
    }
    for (const RecordRange& stretch : stretches) {
        entries.push_back({LedgerKind::intent, *run, stretch, evidence});
        entries.push_back({LedgerKind::in_doubt, *run, stretch, evidence});
    }
    entries.push_back({LedgerKind::run_ended, *run, {}, evidence});
    return spool.append(job.id, entries);
}

} // namespace

Result<std::vector<DistrustedJob>> distrust(spool::Spool& spool, const std::string& who, const std::string& why) {
    const auto jobs = spool.jobs();
    if (!jobs) {
        return jobs.error();
    }
    const std::string evidence = spool::JsonObject{}.add("operator", who).add("said", why).text();
    std::vector<DistrustedJob> distrusted;
    for (const spool::Job& job : *jobs) {
        const auto before = spool.ledger_state(job.id);
        if (!before) {
            return before.error();
        }
        if (const auto done = distrust_job(spool, job, *before, evidence); !done) {
            return done.error();
        }
        const auto after = spool.ledger_state(job.id);
        if (!after) {
            return after.error();
        }
        if (auto ranges = after->ranges(RecordState::in_doubt); !ranges.empty()) {
            distrusted.push_back({job, std::move(ranges)});
        }
    }
    return distrusted;
}

} // namespace linefeed::daemon
