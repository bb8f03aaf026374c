// The CRC-32 of secured transmissions (protocol, section 6).
#pragma once

#include <cstdint>
#include <string_view>

namespace linefeed::protocol {

/// The common CRC-32 (zlib) over a frame from `^` up to and without the CR.
[[nodiscard]] std::uint32_t crc32(std::string_view frame_without_cr);

} // namespace linefeed::protocol
