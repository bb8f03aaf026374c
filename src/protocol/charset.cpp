// UTF-8 in, printer bytes out, see charset.hpp.
#include "protocol/charset.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace linefeed::protocol {

namespace {

/// Windows-1252 differs from Latin-1 in 0x80…0x9F only: what these bytes stand for, 0 = undefined.
constexpr unsigned char first_special_byte = 0x80;
constexpr std::array<char16_t, 32> windows_1252_specials{
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178,
};
constexpr char32_t replacement_character = 0xFFFD;

struct CharsetName {
    std::string_view name;
    Charset charset;
};

/// The first name of each charset is the one to show.
constexpr std::array<CharsetName, 8> charset_names{{
    {"latin1", Charset::latin1},
    {"latin-1", Charset::latin1},
    {"iso-8859-1", Charset::latin1},
    {"windows-1252", Charset::windows_1252},
    {"cp1252", Charset::windows_1252},
    {"unicode-hex", Charset::unicode_hex},
    {"unicode", Charset::unicode_hex},
    {"hex", Charset::unicode_hex},
}};

char ascii_lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_special_byte(unsigned char byte) {
    return byte >= first_special_byte && byte < first_special_byte + windows_1252_specials.size();
}

/// What the first byte of a UTF-8 sequence says: how long it is, its own bits, and the smallest code point that needs
/// that many bytes. `bytes` is 0 for a byte that begins nothing.
struct Lead {
    std::uint32_t bytes = 0;
    char32_t value = 0;
    char32_t smallest = 0;
};

Lead lead_of(unsigned char byte) {
    if (byte < 0x80) {
        return {1, byte, 0};
    }
    if ((byte & 0xE0U) == 0xC0U) {
        return {2, byte & 0x1FU, 0x80};
    }
    if ((byte & 0xF0U) == 0xE0U) {
        return {3, byte & 0x0FU, 0x800};
    }
    if ((byte & 0xF8U) == 0xF0U) {
        return {4, byte & 0x07U, 0x1'0000};
    }
    return {};
}

} // namespace

std::optional<Charset> charset_from_name(std::string_view name) {
    for (const CharsetName& known : charset_names) {
        if (std::ranges::equal(name, known.name, {}, ascii_lower)) {
            return known.charset;
        }
    }
    return std::nullopt;
}

std::string_view to_string(Charset charset) {
    switch (charset) {
    case Charset::latin1:
        return "latin1";
    case Charset::windows_1252:
        return "windows-1252";
    case Charset::unicode_hex:
        return "unicode-hex";
    }
    assertion_failed("Charset", __FILE__, __LINE__);
}

std::optional<Utf8Character> decode_utf8(std::string_view text) {
    LINEFEED_ASSERT(!text.empty());
    const Lead lead = lead_of(static_cast<unsigned char>(text[0]));
    if (lead.bytes == 0 || lead.bytes > text.size()) {
        return std::nullopt;
    }
    char32_t value = lead.value;
    for (std::uint32_t i = 1; i < lead.bytes; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xC0U) != 0x80U) {
            return std::nullopt;
        }
        value = (value << 6U) | (byte & 0x3FU);
    }
    const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
    if (value < lead.smallest || surrogate || value > 0x10'FFFF) {
        return std::nullopt;
    }
    return Utf8Character{value, lead.bytes};
}

std::optional<unsigned char> to_single_byte(char32_t code_point, Charset charset) {
    LINEFEED_ASSERT(charset != Charset::unicode_hex);
    if (code_point <= 0xFF) {
        const auto byte = static_cast<unsigned char>(code_point);
        if (charset == Charset::windows_1252 && is_special_byte(byte)) {
            return std::nullopt;
        }
        return byte;
    }
    if (charset == Charset::windows_1252) {
        const auto* const found = std::ranges::find(windows_1252_specials, code_point);
        if (found != windows_1252_specials.end()) {
            return static_cast<unsigned char>(first_special_byte + (found - windows_1252_specials.begin()));
        }
    }
    return std::nullopt;
}

char32_t from_single_byte(unsigned char byte, Charset charset) {
    LINEFEED_ASSERT(charset != Charset::unicode_hex);
    if (charset == Charset::windows_1252 && is_special_byte(byte)) {
        const char32_t special = windows_1252_specials[byte - first_special_byte];
        return special == 0 ? replacement_character : special;
    }
    return byte;
}

} // namespace linefeed::protocol
