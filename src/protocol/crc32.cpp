// zlib's CRC-32 is the printer's (protocol, section 6).
#include "protocol/crc32.hpp"

#include <zlib.h>

namespace linefeed::protocol {

std::uint32_t crc32(std::string_view frame_without_cr) {
    const uLong start = ::crc32_z(0, nullptr, 0);
    // zlib's byte is unsigned char, which may alias any object.
    const auto* bytes = reinterpret_cast<const Bytef*>(frame_without_cr.data());
    return static_cast<std::uint32_t>(::crc32_z(start, bytes, frame_without_cr.size()));
}

bool is_announced_by(std::string_view raw, std::uint32_t crc) {
    if (raw.ends_with('\n')) {
        raw.remove_suffix(1);
    }
    return crc32(raw) == crc;
}

} // namespace linefeed::protocol
