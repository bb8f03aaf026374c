// Graphics as text, see graphic.hpp.
#include "protocol/graphic.hpp"

#include "base/assert.hpp"
#include "protocol/decimal.hpp"

namespace linefeed::protocol {

namespace {

constexpr std::uint32_t bits_per_byte = 8;

/// Takes what stands before the next blank, with the blank.
std::optional<std::uint32_t> take_number(std::string_view& text) {
    const std::size_t blank = text.find(' ');
    if (blank == std::string_view::npos) {
        return std::nullopt;
    }
    const auto number = read_decimal<std::uint32_t>(text.substr(0, blank));
    text.remove_prefix(blank + 1);
    return number;
}

std::optional<unsigned> hex_value(char digit) {
    if (digit >= '0' && digit <= '9') {
        return static_cast<unsigned>(digit - '0');
    }
    if (digit >= 'A' && digit <= 'F') {
        return static_cast<unsigned>(digit - 'A') + 10;
    }
    if (digit >= 'a' && digit <= 'f') {
        return static_cast<unsigned>(digit - 'a') + 10;
    }
    return std::nullopt;
}

} // namespace

bool Graphic::dot(std::uint32_t x, std::uint32_t y) const {
    LINEFEED_ASSERT(x < width && y < height);
    const auto byte = static_cast<unsigned char>(bytes[x * bytes_per_stroke() + y / bits_per_byte]);
    return (byte >> y % bits_per_byte & 1U) != 0;
}

void Graphic::set(std::uint32_t x, std::uint32_t y) {
    LINEFEED_ASSERT(x < width && y < height);
    char& byte = bytes[x * bytes_per_stroke() + y / bits_per_byte];
    byte = static_cast<char>(static_cast<unsigned char>(byte) | 1U << y % bits_per_byte);
}

Graphic Graphic::blank(std::uint32_t height, std::uint32_t width) {
    LINEFEED_ASSERT(height >= 1 && height <= max_graphic_height && width >= 1);
    Graphic graphic{height, width, {}};
    graphic.bytes.assign(graphic.bytes_per_stroke() * width, '\0');
    return graphic;
}

void append_graphic(std::string& out, const Graphic& graphic) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    out.push_back('(');
    append_decimal(out, graphic.height);
    out.push_back(' ');
    append_decimal(out, graphic.width);
    out.push_back(' ');
    for (const char byte : graphic.bytes) {
        out.push_back(digits[static_cast<unsigned char>(byte) >> 4U]);
        out.push_back(digits[static_cast<unsigned char>(byte) & 0xFU]);
    }
    out.push_back(')');
}

std::optional<Graphic> parse_graphic(std::string_view text) {
    if (text.size() < 2 || text.front() != '(' || text.back() != ')') {
        return std::nullopt;
    }
    text = text.substr(1, text.size() - 2);
    const auto height = take_number(text);
    const auto width = height ? take_number(text) : std::nullopt;
    if (!width || *height < 1 || *height > max_graphic_height || *width < 1) {
        return std::nullopt;
    }
    Graphic graphic{*height, *width, {}};
    if (text.size() % 2 != 0 || text.size() / 2 != graphic.bytes_per_stroke() * *width) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < text.size(); i += 2) {
        const auto high = hex_value(text[i]);
        const auto low = hex_value(text[i + 1]);
        if (!high || !low) {
            return std::nullopt;
        }
        graphic.bytes.push_back(static_cast<char>(*high << 4U | *low));
    }
    return graphic;
}

} // namespace linefeed::protocol
