// Encodes mail records, see mail_record.hpp. Runs of plain ASCII are copied whole: a job has millions of records.
#include "protocol/mail_record.hpp"

#include "base/assert.hpp"
#include "protocol/decimal.hpp"
#include "protocol/frame.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace linefeed::protocol {

namespace {

/// Bytes of UTF-8 text that every charset takes as they are: ASCII without controls, `^` and `\`.
constexpr std::array<bool, 256> plain_bytes = [] {
    std::array<bool, 256> plain{};
    for (std::size_t byte = 0x20; byte < 0x7F; ++byte) {
        plain[byte] = byte != '^' && byte != '\\';
    }
    return plain;
}();

bool is_control(char32_t code_point) {
    return code_point < 0x20 || (code_point >= 0x7F && code_point <= 0x9F);
}

void append_hex_unit(std::string& out, char32_t code_point) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    for (const unsigned shift : {12U, 8U, 4U, 0U}) {
        out.push_back(digits[(code_point >> shift) & 0xFU]);
    }
}

/// Why a character is refused, in a field whose record and number the caller knows.
std::optional<RecordErrc> append_character(std::string& out, char32_t code_point, Charset charset, EscapeMode escapes) {
    if (is_control(code_point)) {
        return RecordErrc::control_character;
    }
    if (charset == Charset::unicode_hex) {
        if (code_point > 0xFFFF) {
            return RecordErrc::outside_bmp;
        }
        append_hex_unit(out, code_point);
        return std::nullopt;
    }
    const auto byte = to_single_byte(code_point, charset);
    if (!byte) {
        return RecordErrc::not_in_charset;
    }
    if (*byte == '^' || *byte == '\\') {
        if (escapes == EscapeMode::none) {
            return RecordErrc::not_escapable;
        }
        out.push_back('\\');
    }
    out.push_back(static_cast<char>(*byte));
    return std::nullopt;
}

void append_plain(std::string& out, std::string_view text, Charset charset) {
    if (charset != Charset::unicode_hex) {
        out.append(text);
        return;
    }
    for (const char c : text) {
        append_hex_unit(out, static_cast<unsigned char>(c));
    }
}

std::uint32_t characters_in(std::string_view utf8) {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(utf8, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// Appends one field as the printer wants it. The error lacks record and field.
std::optional<RecordError> append_field(std::string& out, std::string_view text, Charset charset, EscapeMode escapes) {
    const auto is_plain = [](char c) { return plain_bytes[static_cast<unsigned char>(c)]; };
    std::size_t at = 0;
    while (true) {
        const auto special = static_cast<std::size_t>(
            std::find_if_not(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), is_plain) - text.begin());
        append_plain(out, text.substr(at, special - at), charset);
        if (special == text.size()) {
            return std::nullopt;
        }
        const std::string_view rest = text.substr(special);
        const auto character = decode_utf8(rest);
        const char32_t shown = character ? character->code_point : static_cast<unsigned char>(rest.front());
        const auto refused = character ? append_character(out, shown, charset, escapes) : RecordErrc::invalid_utf8;
        if (refused) {
            return RecordError{
                .code = *refused, .character = characters_in(text.substr(0, special)) + 1, .code_point = shown};
        }
        at = special + character->bytes;
    }
}

} // namespace

MailRecordEncoder::MailRecordEncoder(std::vector<Charset> charsets, EscapeMode escapes, RecordProperties properties)
    : charsets_(std::move(charsets))
    , escapes_(escapes)
    , properties_(properties) {
    LINEFEED_ASSERT(!charsets_.empty());
}

boost::system::result<void, RecordError>
MailRecordEncoder::append(std::string& out, RecordNumber number, std::span<const std::string_view> utf8_fields) const {
    const auto whole_record = [number](RecordErrc code, std::uint64_t length = 0) {
        return RecordError{.code = code, .record = number, .length = length};
    };
    if (utf8_fields.empty()) {
        return whole_record(RecordErrc::no_fields);
    }
    if (utf8_fields.size() > max_fields) {
        return whole_record(RecordErrc::too_many_fields, utf8_fields.size());
    }
    if (properties_.repetitions && number != RecordNumber{0}) {
        return whole_record(RecordErrc::repetitions_numbered);
    }
    LINEFEED_ASSERT(charsets_.size() == 1 || utf8_fields.size() <= charsets_.size());

    const std::size_t frame_begin = out.size();
    const auto refuse = [&out, frame_begin](RecordError error) {
        out.resize(frame_begin);
        return error;
    };
    out.append("^0=MR");
    const std::size_t record_begin = out.size();
    append_decimal(out, number.value());
    std::size_t field_begin = record_begin;
    for (std::size_t i = 0; i < utf8_fields.size(); ++i) {
        out.push_back('\t');
        field_begin = out.size();
        const Charset charset = charsets_.size() == 1 ? charsets_.front() : charsets_[i];
        if (auto error = append_field(out, utf8_fields[i], charset, escapes_)) {
            error->record = number;
            error->field = static_cast<std::uint32_t>(i + 1);
            return refuse(*error);
        }
    }
    if (!properties_.empty()) {
        out.push_back('\t');
        append_properties(out, properties_);
    } else if (read_properties(std::string_view{out}.substr(field_begin))) {
        return refuse({.code = RecordErrc::looks_like_properties,
                       .record = number,
                       .field = static_cast<std::uint32_t>(utf8_fields.size())});
    }
    const std::size_t length = out.size() - record_begin;
    if (length > max_record_bytes) {
        return refuse(whole_record(RecordErrc::too_long, length));
    }
    out.push_back('\r');
    return {};
}

void throw_exception_from_error(const RecordError& error, const boost::source_location&) {
    throw std::runtime_error(describe(error));
}

} // namespace linefeed::protocol
