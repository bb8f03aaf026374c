#include "service/follower.hpp"

#include "daemon/line_use.hpp"

#include <algorithm>

namespace linefeed::service {

using spool::RecordState;

namespace {

RecordCount overlap(RecordRange a, RecordRange b) {
    if (a.empty() || b.empty()) {
        return RecordCount{0};
    }
    return RecordRange::closed(std::max(a.first(), b.first()), std::min(a.last(), b.last())).count();
}

} // namespace

bool ends_with(const daemon::JobFacts& facts, RecordRange run) {
    RecordCount done = run.count();
    for (const spool::LedgerSegment& segment : facts.ledger.segments()) {
        if (segment.state == RecordState::printed || segment.state == RecordState::skipped) {
            done += segment.range.count() - overlap(segment.range, run);
        }
    }
    return done == facts.job.records.count();
}

bool fits_behind(const daemon::JobFacts& next, const FollowerWanted& wanted) {
    const bool waits = phase_of(next, {}) == daemon::JobPhase::queued && next.ticket->autostart && !next.issued();
    const bool complete = next.job.state == spool::ImportState::ready && !next.job.records.empty();
    const daemon::RecordFormat format = daemon::record_format(next.job);
    const bool same_format = format.charsets == wanted.format.charsets && format.escapes == wanted.format.escapes &&
                             (!format.properties || wanted.format.properties);
    const bool short_enough = !wanted.most_record_bytes || daemon::record_bytes(next.job) <= *wanted.most_record_bytes;
    return waits && complete && same_format && short_enough;
}

} // namespace linefeed::service
