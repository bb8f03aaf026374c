// LedgerState: what all rows about a job come to. Pure; the law of which row may follow which is here and nowhere else.
#include "spool/ledger.hpp"

#include <algorithm>
#include <array>

namespace linefeed::spool {

namespace {

/// The state that a row gives its records; std::nullopt for rows that are not about records.
std::optional<RecordState> state_after(LedgerKind kind) {
    switch (kind) {
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
    case LedgerKind::run_started:
    case LedgerKind::run_ended:
        return std::nullopt;
    }
    assertion_failed("LedgerKind", __FILE__, __LINE__);
}

bool may_be_issued(RecordState state) {
    return state == RecordState::fresh || state == RecordState::unused || state == RecordState::released;
}

/// Whether a row of `kind` may follow for a record in `state`.
bool allowed(LedgerKind kind, RecordState state) {
    switch (kind) {
    case LedgerKind::intent:
        return may_be_issued(state);
    case LedgerKind::printed:
    case LedgerKind::unused:
        return state == RecordState::open || state == RecordState::in_doubt;
    case LedgerKind::in_doubt:
        return state == RecordState::open;
    case LedgerKind::skipped:
    case LedgerKind::released:
        return state == RecordState::in_doubt;
    case LedgerKind::reprint:
        return state == RecordState::printed || state == RecordState::skipped;
    case LedgerKind::run_started:
    case LedgerKind::run_ended:
        return true; // about no record: apply() does not ask
    }
    assertion_failed("LedgerKind", __FILE__, __LINE__);
}

/// The first segment that ends at or behind `number`.
auto first_reaching(const std::vector<LedgerSegment>& segments, RecordNumber number) {
    return std::lower_bound(
        segments.begin(), segments.end(), number,
        [](const LedgerSegment& segment, RecordNumber wanted) { return segment.range.last() < wanted; });
}

bool joinable(const LedgerSegment& left, const LedgerSegment& right) {
    return left.state == right.state && left.run == right.run &&
           std::uint64_t{left.range.last().value()} + 1 == right.range.first().value();
}

/// The pieces that take the place of the segments which a row touches: at most a remainder on either side and the row
/// itself.
struct Replacement {
    std::array<LedgerSegment, 3> pieces;
    std::size_t count = 0;

    /// Appends a piece; joins it with the one before where they are alike.
    void add(const LedgerSegment& piece) {
        if (count > 0 && joinable(pieces[count - 1], piece)) {
            auto& last = pieces[count - 1].range;
            last = RecordRange::closed(last.first(), piece.range.last());
        } else {
            pieces[count++] = piece;
        }
    }
};

} // namespace

bool LedgerState::apply(const LedgerEntry& entry) {
    const std::optional<RecordState> state = state_after(entry.kind);
    if (!state || entry.range.empty()) {
        return true;
    }
    const RecordNumber first = entry.range.first();
    const RecordNumber last = entry.range.last();
    auto begin = first_reaching(segments_, first);
    auto end = begin;
    std::uint64_t covered = 0;
    for (; end != segments_.end() && end->range.first() <= last; ++end) {
        if (!allowed(entry.kind, end->state)) {
            return false;
        }
        const auto overlap =
            RecordRange::closed(std::max(first, end->range.first()), std::min(last, end->range.last()));
        covered += overlap.count().value();
    }
    if (covered < entry.range.count().value() && !allowed(entry.kind, RecordState::fresh)) {
        return false;
    }
    const LedgerSegment added{entry.range, *state, entry.run};
    // Neighbours that merely touch take part when they can be joined.
    if (begin != segments_.begin() && joinable(*std::prev(begin), added)) {
        --begin;
    }
    if (end != segments_.end() && joinable(added, *end)) {
        ++end;
    }
    Replacement replacement;
    if (begin != end && begin->range.first() < first) {
        replacement.add({RecordRange::closed(begin->range.first(), first.previous()), begin->state, begin->run});
    }
    replacement.add(added);
    if (begin != end && std::prev(end)->range.last() > last) {
        const LedgerSegment& right = *std::prev(end);
        replacement.add({RecordRange::closed(last.next(), right.range.last()), right.state, right.run});
    }
    const auto at = begin - segments_.begin();
    const auto old_count = static_cast<std::size_t>(end - begin);
    const auto common = static_cast<std::ptrdiff_t>(std::min(old_count, replacement.count));
    if (replacement.count > old_count) {
        segments_.insert(segments_.begin() + at + common, replacement.count - old_count, LedgerSegment{});
    } else {
        segments_.erase(segments_.begin() + at + common,
                        segments_.begin() + at + static_cast<std::ptrdiff_t>(old_count));
    }
    std::copy_n(replacement.pieces.begin(), replacement.count, segments_.begin() + at);
    return true;
}

RecordState LedgerState::state_of(RecordNumber number) const {
    const auto segment = first_reaching(segments_, number);
    return segment != segments_.end() && segment->range.contains(number) ? segment->state : RecordState::fresh;
}

RecordCount LedgerState::count(RecordState state) const {
    RecordCount total;
    for (const LedgerSegment& segment : segments_) {
        if (segment.state == state) {
            total += segment.range.count();
        }
    }
    return total;
}

std::vector<RecordRange> LedgerState::ranges(RecordState state) const {
    std::vector<RecordRange> result;
    for (const LedgerSegment& segment : segments_) {
        if (segment.state != state) {
            continue;
        }
        if (!result.empty() && std::uint64_t{result.back().last().value()} + 1 == segment.range.first().value()) {
            result.back() = RecordRange::closed(result.back().first(), segment.range.last());
        } else {
            result.push_back(segment.range);
        }
    }
    return result;
}

RecordRange LedgerState::next_printable(RecordRange wanted) const {
    if (wanted.empty()) {
        return {};
    }
    RecordNumber first = wanted.first();
    for (auto segment = first_reaching(segments_, first);
         segment != segments_.end() && segment->range.first() <= wanted.last(); ++segment) {
        if (may_be_issued(segment->state)) {
            continue;
        }
        if (first < segment->range.first()) {
            return RecordRange::closed(first, segment->range.first().previous());
        }
        if (segment->range.last() >= wanted.last()) {
            return {};
        }
        first = segment->range.last().next();
    }
    return RecordRange::closed(first, wanted.last());
}

} // namespace linefeed::spool
