// A page of records, encoded once at intake and never touched again: a refill is a slice of a page, found by offset.
#pragma once

#include "base/assert.hpp"
#include "base/record_number.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed {

/// Consecutive records as ready `^0=MR…<CR>` frames (protocol, section 5), back to back.
/// Invariant: `ends[k]` is the offset behind the frame of record first + k; ends are increasing and the last is
/// frames.size().
struct RecordPage {
    RecordNumber first;
    std::vector<std::uint32_t> ends;
    std::string frames;

    [[nodiscard]] RecordRange range() const { return {first, RecordCount{ends.size()}}; }

    /// The frames of `wanted`, which must lie in range() and not be empty.
    [[nodiscard]] std::string_view slice(RecordRange wanted) const {
        LINEFEED_ASSERT(range().contains(wanted.first()) && range().contains(wanted.last()));
        const auto begin_index = (wanted.first() - first).value();
        const auto last_index = (wanted.last() - first).value();
        const std::size_t begin = begin_index == 0 ? 0 : ends[begin_index - 1];
        return std::string_view{frames}.substr(begin, ends[last_index] - begin);
    }
};

} // namespace linefeed
