#include "daemon/record_text.hpp"

#include "protocol/mail_record.hpp"
#include "protocol/profile.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <string_view>

namespace linefeed::daemon {

namespace {

using Json = nlohmann::ordered_json;

void append_utf8(std::string& out, char32_t character) {
    const auto byte = [&out](char32_t value) { out += static_cast<char>(static_cast<unsigned char>(value)); };
    if (character < 0x80) {
        byte(character);
    } else if (character < 0x800) {
        byte(0xC0 | (character >> 6));
        byte(0x80 | (character & 0x3F));
    } else {
        byte(0xE0 | (character >> 12));
        byte(0x80 | ((character >> 6) & 0x3F));
        byte(0x80 | (character & 0x3F));
    }
}

/// Four hex digits a character; anything else comes back as it is.
std::string from_hex(std::string_view digits) {
    std::string text;
    for (std::size_t at = 0; at + 4 <= digits.size(); at += 4) {
        std::uint32_t unit = 0;
        const char* const end = digits.data() + at + 4;
        const auto [stop, error] = std::from_chars(digits.data() + at, end, unit, 16);
        if (error != std::errc{} || stop != end) {
            return std::string{digits};
        }
        append_utf8(text, unit);
    }
    return text;
}

std::string to_utf8(std::string_view bytes, protocol::Charset charset) {
    if (charset == protocol::Charset::unicode_hex) {
        return from_hex(bytes);
    }
    std::string text;
    for (const char c : bytes) {
        append_utf8(text, protocol::from_single_byte(static_cast<unsigned char>(c), charset));
    }
    return text;
}

} // namespace

RecordFormat record_format(const spool::Job& job) {
    RecordFormat format;
    const Json layout = Json::parse(job.spec.layout, nullptr, false);
    if (layout.is_object()) {
        const auto profile = protocol::parse_profile(layout.value("profile", std::string{}));
        format.escapes = profile ? profile->escapes : format.escapes;
        format.properties = layout.value("mirrored", false) || layout.contains("orientation");
    }
    const Json report = Json::parse(job.import_report, nullptr, false);
    if (report.is_object() && report.contains("columns") && !report["columns"].empty()) {
        format.charsets.clear();
        for (const Json& column : report["columns"]) {
            const auto charset = protocol::charset_from_name(column.value("encoding", std::string{}));
            format.charsets.push_back(charset.value_or(protocol::Charset::latin1));
        }
    }
    return format;
}

std::vector<std::string> record_fields(const RecordPage& page, RecordNumber number, const RecordFormat& format) {
    constexpr std::string_view head = "^0=MR";
    std::string_view frame = page.slice({number, RecordCount{1}});
    frame.remove_prefix(head.size());
    frame.remove_suffix(1);
    std::vector<std::string> fields;
    if (const auto record = protocol::parse_mail_record(frame, format.escapes)) {
        for (const std::string& field : record->fields) {
            const std::size_t column = std::min(fields.size(), format.charsets.size() - 1);
            fields.push_back(to_utf8(field, format.charsets[column]));
        }
    }
    return fields;
}

std::string joined(const std::vector<std::string>& fields, const std::string& separator) {
    std::string text;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        text += (i == 0 ? "" : separator) + fields[i];
    }
    return text;
}

} // namespace linefeed::daemon
