// Images of two colours as graphics of a record: PNG (libpng) and PBM.
#pragma once

#include "base/failure.hpp"
#include "protocol/graphic.hpp"

#include <cstdint>
#include <string_view>

namespace linefeed::intake {

/// No record holds more strokes: each takes two of its 2048 bytes.
inline constexpr std::uint32_t max_image_width = 1024;
/// No image of that width and 32 dots needs more, however it is packed.
inline constexpr std::uint64_t max_image_bytes = std::uint64_t{1} << 20U;

/// Black pixels are dots, the image's first row is dot Y.1. FailureKind::input, saying why: neither PNG nor PBM,
/// damaged, higher than `max_height` dots, wider than max_image_width, a pixel that is neither black nor white
/// (transparent ones stand on white). Precondition: max_height ≤ protocol::max_graphic_height.
[[nodiscard]] Result<protocol::Graphic> read_image(std::string_view bytes, std::uint32_t max_height);

} // namespace linefeed::intake
