// Which record numbers were printed, and whether one was printed twice or left out: the simulator's own judgement of a
// run.
#pragma once

#include "base/record_number.hpp"

#include <cstdint>
#include <map>

namespace linefeed::simulator {

/// The numbers printed so far, as ranges. Number 0 is not counted: it is no place in a sequence.
class NumberSequence {
public:
    void add(RecordNumber number);

    /// Prints of a number that had been printed before.
    [[nodiscard]] std::uint64_t doubles() const { return doubles_; }
    /// Numbers between the smallest and the largest printed that were not printed.
    [[nodiscard]] std::uint64_t missing() const;
    /// The places where numbers are missing.
    [[nodiscard]] std::uint64_t gaps() const { return ranges_.empty() ? 0 : ranges_.size() - 1; }
    /// 0 while none was printed.
    [[nodiscard]] RecordNumber smallest() const;
    [[nodiscard]] RecordNumber largest() const;

private:
    std::map<std::uint32_t, std::uint32_t> ranges_; ///< first → last, disjoint and not adjacent
    std::uint64_t doubles_ = 0;
};

} // namespace linefeed::simulator
