// Ranges of printed numbers, see number_sequence.hpp.
#include "simulator/number_sequence.hpp"

#include <iterator>

namespace linefeed::simulator {

void NumberSequence::add(RecordNumber record) {
    const std::uint32_t number = record.value();
    if (number == 0) {
        return;
    }
    const auto next = ranges_.upper_bound(number);
    const auto before = next == ranges_.begin() ? ranges_.end() : std::prev(next);
    if (before != ranges_.end() && number <= before->second) {
        ++doubles_;
        return;
    }
    const bool extends_before = before != ranges_.end() && number - 1 == before->second;
    const bool extends_next = next != ranges_.end() && number + 1 == next->first;
    const std::uint32_t last = extends_next ? next->second : number;
    if (extends_next) {
        ranges_.erase(next);
    }
    if (extends_before) {
        before->second = last;
    } else {
        ranges_.emplace(number, last);
    }
}

std::uint64_t NumberSequence::missing() const {
    std::uint64_t covered = 0;
    for (const auto& [first, last] : ranges_) {
        covered += std::uint64_t{last} - first + 1;
    }
    return ranges_.empty() ? 0 : std::uint64_t{largest().value()} - smallest().value() + 1 - covered;
}

RecordNumber NumberSequence::smallest() const {
    return RecordNumber{ranges_.empty() ? 0 : ranges_.begin()->first};
}

RecordNumber NumberSequence::largest() const {
    return RecordNumber{ranges_.empty() ? 0 : std::prev(ranges_.end())->second};
}

} // namespace linefeed::simulator
