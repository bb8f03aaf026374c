// What the product will look like, dot by dot: the simple rendering behind `?GW` (protocol, section 4).
#pragma once

#include "protocol/wysiwyg.hpp"

#include <cstdint>
#include <string_view>

namespace linefeed::simulator {

/// As many strokes as one `?GW` delivers at most: the manual says that a detail may come for performance reasons.
inline constexpr std::uint32_t max_delivered_strokes = 400;

/// The fields of a record (separated by TAB) beside each other: graphics as they are, texts in a font 7 dots high,
/// bytes that are not ASCII as a box. From stroke `first` on; beyond the picture nothing.
[[nodiscard]] protocol::WysiwygImage draw(std::string_view text, std::uint32_t job_id, std::uint32_t first);

} // namespace linefeed::simulator
