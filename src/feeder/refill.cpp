#include "feeder/refill.hpp"

#include <algorithm>

namespace linefeed::feeder {

namespace {

/// Intents reach this many FIFO depths ahead: enough to outlive a slow disk, short enough that a crash without any
/// other evidence leaves few records in doubt.
constexpr std::uint64_t intent_depths = 4;

} // namespace

void Refill::begin(RecordRange range, RecordCount depth) {
    LINEFEED_ASSERT(!range.empty() && range.first() > RecordNumber{} && depth > RecordCount{0});
    range_ = range;
    depth_ = depth;
    sent_through_ = printed_through_ = supplied_through_ = durable_through_ = intent_asked_ = range.first().previous();
}

void Refill::resume(RecordRange range, RecordCount depth, RecordNumber durable_through, RecordNumber sent_through,
                    RecordNumber printed_through) {
    begin(range, depth);
    supplied_through_ = sent_through_ = sent_through;
    printed_through_ = printed_through;
    durable_through_ = intent_asked_ = durable_through;
    check();
}

void Refill::end_at(RecordNumber last) {
    LINEFEED_ASSERT(range_.contains(last) && supplied_through_ <= last && durable_through_ <= last);
    range_ = RecordRange::closed(range_.first(), last);
    intent_asked_ = std::min(intent_asked_, last);
    check();
}

void Refill::extend(RecordNumber last) {
    LINEFEED_ASSERT(last > range_.last());
    range_ = RecordRange::closed(range_.first(), last);
    check();
}

void Refill::supplied(RecordNumber through) {
    supplied_through_ = std::max(supplied_through_, std::min(through, range_.last()));
    check();
}

void Refill::durable(RecordNumber through) {
    durable_through_ = std::max(durable_through_, std::min(through, range_.last()));
    intent_asked_ = std::max(intent_asked_, durable_through_);
    check();
}

bool Refill::printed(RecordNumber through) {
    if (through > sent_through_ || through < printed_through_) {
        return false;
    }
    printed_through_ = through;
    check();
    return true;
}

RecordNumber Refill::bound() const {
    return std::min({range_.last(), supplied_through_, durable_through_});
}

RecordCount Refill::ready() const {
    const RecordCount credit = depth_ - std::min(depth_, level());
    return bound() <= sent_through_ ? RecordCount{0} : std::min(bound() - sent_through_, credit);
}

bool Refill::starved() const {
    return bound() <= sent_through_ && !all_sent();
}

RecordRange Refill::take(RecordCount most) {
    const RecordCount count = std::min(ready(), most);
    if (count == RecordCount{0}) {
        return {};
    }
    const RecordRange taken{sent_through_.next(), count};
    sent_through_ = taken.last();
    check();
    return taken;
}

bool Refill::first_fill_ready() const {
    return ready() >= std::min({depth_, range_.count(), first_fill_at_most});
}

std::optional<RecordNumber> Refill::next_intent() {
    const RecordCount ahead{depth_.value() * intent_depths};
    if (intent_asked_ == range_.last() || intent_asked_ - sent_through_ > RecordCount{ahead.value() / 2}) {
        return std::nullopt;
    }
    const RecordCount rest = range_.last() - sent_through_;
    intent_asked_ = sent_through_ + std::min(ahead, rest);
    return intent_asked_;
}

void Refill::check() const {
    LINEFEED_ASSERT(range_.first().previous() <= printed_through_ && printed_through_ <= sent_through_);
    LINEFEED_ASSERT(sent_through_ <= durable_through_ && sent_through_ <= supplied_through_);
    LINEFEED_ASSERT(sent_through_ <= range_.last() && level() <= depth_);
}

} // namespace linefeed::feeder
