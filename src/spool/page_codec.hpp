// How a page of records is stored: its offsets as bytes, and what must hold of a page that is read back.
#pragma once

#include "base/record_page.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::spool {

/// 32-bit little-endian numbers.
[[nodiscard]] std::string pack_ends(const std::vector<std::uint32_t>& ends);
[[nodiscard]] std::vector<std::uint32_t> unpack_ends(std::string_view packed);
/// The invariant of RecordPage, and not empty.
[[nodiscard]] bool is_consistent(const RecordPage& page);

} // namespace linefeed::spool
