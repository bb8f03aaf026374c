#include "spool/page_codec.hpp"

namespace linefeed::spool {

std::string pack_ends(const std::vector<std::uint32_t>& ends) {
    std::string packed;
    packed.reserve(ends.size() * 4);
    for (const std::uint32_t end : ends) {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            packed += static_cast<char>((end >> shift) & 0xFFU);
        }
    }
    return packed;
}

std::vector<std::uint32_t> unpack_ends(std::string_view packed) {
    std::vector<std::uint32_t> ends(packed.size() / 4);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        for (unsigned byte = 0; byte < 4; ++byte) {
            ends[i] |= std::uint32_t{static_cast<unsigned char>(packed[i * 4 + byte])} << (8 * byte);
        }
    }
    return ends;
}

bool is_consistent(const RecordPage& page) {
    std::uint32_t previous = 0;
    for (const std::uint32_t end : page.ends) {
        if (end <= previous) {
            return false;
        }
        previous = end;
    }
    return previous == page.frames.size() && previous > 0;
}

} // namespace linefeed::spool
