#include "feeder/numbering.hpp"

#include <algorithm>

namespace linefeed::feeder {

Numbering Numbering::begun_with_zero(RecordNumber first) {
    Numbering numbering;
    numbering.parts_[0] = {first, first, true};
    return numbering;
}

void Numbering::append(RecordNumber first, RecordNumber number) {
    LINEFEED_ASSERT(count_ < max_parts && first > parts_[count_ - 1].first);
    parts_[count_++] = {first, number, true};
}

void Numbering::forget_before(RecordNumber place) {
    if (count_ == max_parts && place >= parts_[1].first) {
        parts_[0] = parts_[1];
        count_ = 1;
    }
}

const Numbering::Part& Numbering::part_of(RecordNumber place) const {
    return count_ == max_parts && place >= parts_[1].first ? parts_[1] : parts_[0];
}

RecordNumber Numbering::number_of(RecordNumber place) const {
    const Part& part = part_of(place);
    return place < part.first ? place : part.number + (place - part.first);
}

RecordNumber Numbering::on_wire(RecordNumber place) const {
    const Part& part = part_of(place);
    return part.begins_with_zero && place == part.first ? RecordNumber{} : number_of(place);
}

RecordNumber Numbering::place_of(RecordNumber said, RecordNumber from, RecordNumber through) const {
    for (std::size_t i = 0; i < count_; ++i) {
        const Part& part = parts_[i];
        if (part.begins_with_zero && said == RecordNumber{} && from <= part.first && part.first <= through) {
            return part.first;
        }
        if (said < part.number || (said == part.number && part.begins_with_zero)) {
            continue;
        }
        const std::uint64_t place = part.first.value() + (said - part.number).value();
        const bool in_part = i + 1 == count_ || place < parts_[i + 1].first.value();
        if (in_part && from.value() <= place && place <= through.value()) {
            return RecordNumber{static_cast<std::uint32_t>(place)};
        }
    }
    const Part& last = parts_[count_ - 1];
    const bool places_are_numbers = count_ == 1 && last.first == last.number;
    if (said == RecordNumber{} || places_are_numbers) {
        return said;
    }
    return RecordNumber::max(); // of somebody else
}

bool Numbering::has_zero(RecordNumber from, RecordNumber through) const {
    const auto last = parts_.begin() + static_cast<std::ptrdiff_t>(count_);
    return std::any_of(parts_.begin(), last, [&](const Part& part) {
        return part.begins_with_zero && from <= part.first && part.first <= through;
    });
}

RecordNumber Numbering::distinct_through(RecordNumber printed_through) const {
    if (count_ < max_parts || printed_through >= parts_[1].first) {
        return RecordNumber::max();
    }
    const Part& next = parts_[1];
    const RecordNumber least = number_of(printed_through);
    const RecordNumber most = number_of(next.first.previous());
    if (next.number >= most) {
        return RecordNumber::max();
    }
    // Its numbers ascend towards those that may still be reported, and must not reach them.
    const RecordCount behind_first = next.number.next() >= least ? RecordCount{0} : least.previous() - next.number;
    return next.first + std::min(behind_first, RecordNumber::max() - next.first);
}

} // namespace linefeed::feeder
