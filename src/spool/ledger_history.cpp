#include "spool/ledger_history.hpp"

#include <optional>

namespace linefeed::spool {

namespace {

std::optional<RecordState> state_after(LedgerKind kind) {
    switch (kind) {
    case LedgerKind::run_started:
    case LedgerKind::run_ended:
        return std::nullopt;
    case LedgerKind::intent:
        return RecordState::open;
    case LedgerKind::printed:
        return RecordState::printed;
    case LedgerKind::unused:
        return RecordState::unused;
    case LedgerKind::in_doubt:
        return RecordState::in_doubt;
    case LedgerKind::skipped:
        return RecordState::skipped;
    case LedgerKind::released:
    case LedgerKind::reprint:
        return RecordState::released;
    }
    assertion_failed("LedgerKind", __FILE__, __LINE__);
}

} // namespace

void LedgerHistory::add(const LedgerRow& row) {
    const auto state = state_after(row.entry.kind);
    const RunId run = row.entry.run;
    const auto last_report = last_report_ns_.try_emplace(run, row.time_ns).first->second;
    if (row.entry.kind == LedgerKind::printed) {
        last_report_ns_[run] = row.time_ns;
    }
    if (!state || row.entry.range.empty()) {
        return;
    }
    const std::vector<HistoryStretch> settled = in_doubt_within(row.entry.range);
    cut_out(row.entry.range);
    by_first_[row.entry.range.first()] = {row.entry.range, *state, run, last_report, row.time_ns, row.entry.evidence};
    for (const HistoryStretch& doubt : settled) {
        cut_out(doubt.range);
        by_first_[doubt.range.first()] = {doubt.range, *state, run, doubt.from_ns, doubt.to_ns, row.entry.evidence};
    }
}

/// Whoever settles a doubt later does not know better when the records were printed.
std::vector<HistoryStretch> LedgerHistory::in_doubt_within(RecordRange range) const {
    std::vector<HistoryStretch> found;
    for (auto it = by_first_.begin(); it != by_first_.end() && it->first <= range.last(); ++it) {
        HistoryStretch stretch = it->second;
        if (stretch.state == RecordState::in_doubt && stretch.range.last() >= range.first()) {
            stretch.range = RecordRange::closed(std::max(stretch.range.first(), range.first()),
                                                std::min(stretch.range.last(), range.last()));
            found.push_back(stretch);
        }
    }
    return found;
}

/// Shortens, splits or removes what is known about `range`.
void LedgerHistory::cut_out(RecordRange range) {
    auto next = by_first_.upper_bound(range.first());
    if (next != by_first_.begin()) {
        --next;
    }
    while (next != by_first_.end() && next->first <= range.last()) {
        const HistoryStretch old = next->second;
        if (old.range.last() < range.first()) {
            ++next;
            continue;
        }
        next = by_first_.erase(next);
        if (old.range.first() < range.first()) {
            HistoryStretch before = old;
            before.range = RecordRange::closed(old.range.first(), range.first().previous());
            by_first_[before.range.first()] = before;
        }
        if (old.range.last() > range.last()) {
            HistoryStretch after = old;
            after.range = RecordRange::closed(range.last().next(), old.range.last());
            by_first_[after.range.first()] = after;
        }
    }
}

std::vector<HistoryStretch> LedgerHistory::stretches() const {
    std::vector<HistoryStretch> result;
    result.reserve(by_first_.size());
    for (const auto& [first, stretch] : by_first_) {
        result.push_back(stretch);
    }
    return result;
}

} // namespace linefeed::spool
