#include "protocol/printable.hpp"

#include "protocol/charset.hpp"

namespace linefeed::protocol {

namespace {

/// Control characters, also those of one byte beyond ASCII, line separators, and what turns the direction of writing.
bool commands_terminal(char32_t character) {
    return character < 0x20 || (character >= 0x7F && character < 0xA0) || character == 0x061C ||
           (character >= 0x200E && character <= 0x200F) || (character >= 0x2028 && character <= 0x202E) ||
           (character >= 0x2066 && character <= 0x2069);
}

void append_as_hex(std::string& out, std::string_view bytes) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    for (const char byte : bytes) {
        const auto value = static_cast<unsigned char>(byte);
        out += "\\x";
        out += digits[value / digits.size()];
        out += digits[value % digits.size()];
    }
}

} // namespace

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const auto character = decode_utf8(text);
        const std::string_view bytes = text.substr(0, character ? character->bytes : 1);
        text.remove_prefix(bytes.size());
        if (character && !commands_terminal(character->code_point)) {
            result += bytes;
        } else {
            append_as_hex(result, bytes);
        }
    }
    return result;
}

} // namespace linefeed::protocol
