// The range of a number, as the fields of messages state it.
#pragma once

#include <cstdint>

namespace linefeed::protocol {

/// What a number may be, both ends included.
struct Limits {
    std::uint32_t smallest = 0;
    std::uint32_t largest = UINT32_MAX;
};

/// A flag that is nothing but 0 or 1. Where the manual says "> 0", any number counts as on.
inline constexpr Limits zero_or_one{0, 1};

} // namespace linefeed::protocol
