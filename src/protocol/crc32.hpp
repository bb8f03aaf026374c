// The CRC-32 of secured transmissions (protocol, section 6).
#pragma once

#include <cstdint>
#include <string_view>

namespace linefeed::protocol {

/// The common CRC-32 (zlib) over a frame from `^` up to and without the CR.
[[nodiscard]] std::uint32_t crc32(std::string_view frame_without_cr);

/// A received frame, from `^` up to and without the CR, was announced by this CRC-32. A LF before the CR (field notes,
/// "Connection") is not a part of the frame.
[[nodiscard]] bool is_announced_by(std::string_view raw, std::uint32_t crc);

} // namespace linefeed::protocol
