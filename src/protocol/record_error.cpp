// The words for RecordError, see mail_record.hpp.
#include "base/assert.hpp"
#include "protocol/frame.hpp"
#include "protocol/mail_record.hpp"

#include <array>
#include <charconv>

namespace linefeed::protocol {

namespace {

std::string hex(char32_t value, std::size_t width) {
    std::array<char, 8> digits{};
    const auto [end, error] =
        std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<std::uint32_t>(value), 16);
    std::string out{digits.data(), end};
    for (char& digit : out) {
        digit = digit >= 'a' ? static_cast<char>(digit - 'a' + 'A') : digit;
    }
    return out.size() < width ? std::string(width - out.size(), '0') + out : out;
}

std::string code_point_name(char32_t code_point) {
    return "U+" + hex(code_point, 4);
}

/// The usual name of the control characters that spreadsheets and exports leave in data.
std::string_view control_name(char32_t code_point) {
    switch (code_point) {
    case 0x00:
        return " (NUL)";
    case 0x09:
        return " (TAB)";
    case 0x0A:
        return " (LF)";
    case 0x0D:
        return " (CR)";
    case 0x1A:
        return " (SUB)";
    case 0x1B:
        return " (ESC)";
    case 0x7F:
        return " (DEL)";
    default:
        return "";
    }
}

/// The character itself, unless it is one that cannot be seen or that turns the writing direction of the terminal.
std::string visible(char32_t code_point) {
    const bool unseen = (code_point >= 0x2000 && code_point <= 0x200F) ||
                        (code_point >= 0x2028 && code_point <= 0x202F) ||
                        (code_point >= 0x205F && code_point <= 0x206F) || code_point >= 0xE000;
    const bool emoji_planes = code_point >= 0x1'0000 && code_point <= 0x3'FFFF;
    if (unseen && !emoji_planes) {
        return "";
    }
    std::string out = " (";
    const auto push = [&out](char32_t bits) { out.push_back(static_cast<char>(static_cast<unsigned char>(bits))); };
    if (code_point >= 0x1'0000) {
        push(0xF0U | (code_point >> 18U));
        push(0x80U | ((code_point >> 12U) & 0x3FU));
        push(0x80U | ((code_point >> 6U) & 0x3FU));
    } else if (code_point >= 0x800) {
        push(0xE0U | (code_point >> 12U));
        push(0x80U | ((code_point >> 6U) & 0x3FU));
    } else {
        push(0xC0U | (code_point >> 6U));
    }
    push(0x80U | (code_point & 0x3FU));
    return out + ")";
}

} // namespace

std::string describe(const RecordError& error) {
    const std::string character = "character " + std::to_string(error.character);
    const std::string named = character + " is " + code_point_name(error.code_point);
    switch (error.code) {
    case RecordErrc::invalid_utf8:
        return character + " is not valid UTF-8: byte 0x" + hex(error.code_point, 2);
    case RecordErrc::control_character:
        return named + std::string{control_name(error.code_point)} + ", a control character";
    case RecordErrc::not_in_charset:
        return named + visible(error.code_point) +
               ", which the charset of the field does not have: replace it or choose another charset";
    case RecordErrc::outside_bmp:
        return named + visible(error.code_point) + ": the printer takes characters up to U+FFFF only";
    case RecordErrc::not_escapable:
        return character + " is " + static_cast<char>(error.code_point) +
               ", which cannot be sent to firmware without escapes (profile jet3): remove it or choose another "
               "--profile";
    case RecordErrc::looks_like_properties:
        return "the last field reads as a property block {…}: the printer would obey it instead of printing it";
    case RecordErrc::too_many_fields:
        return std::to_string(error.length) + " fields, the printer takes " + std::to_string(max_fields);
    case RecordErrc::no_fields:
        return "the record has no field";
    case RecordErrc::too_long:
        return "the record takes " + std::to_string(error.length) + " bytes, the printer takes " +
               std::to_string(max_record_bytes);
    case RecordErrc::repetitions_numbered:
        return "repetitions (rN) are only allowed for records with number 0";
    }
    assertion_failed("RecordErrc", __FILE__, __LINE__);
}

} // namespace linefeed::protocol
