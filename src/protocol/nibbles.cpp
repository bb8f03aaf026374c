// Nibbles, see nibbles.hpp.
#include "protocol/nibbles.hpp"

#include <cstddef>

namespace linefeed::protocol {

void append_nibbles(std::string& out, std::string_view bytes) {
    for (const char byte : bytes) {
        const auto value = static_cast<unsigned char>(byte);
        out.push_back(static_cast<char>('A' + (value >> 4U)));
        out.push_back(static_cast<char>('A' + (value & 0xFU)));
    }
}

std::optional<std::string> read_nibbles(std::string_view nibbles) {
    if (nibbles.size() % 2 != 0) {
        return std::nullopt;
    }
    std::string bytes;
    bytes.reserve(nibbles.size() / 2);
    for (std::size_t i = 0; i < nibbles.size(); i += 2) {
        const int high = nibbles[i] - 'A';
        const int low = nibbles[i + 1] - 'A';
        if (high < 0 || high > 15 || low < 0 || low > 15) {
            return std::nullopt;
        }
        bytes.push_back(static_cast<char>(high << 4 | low));
    }
    return bytes;
}

} // namespace linefeed::protocol
