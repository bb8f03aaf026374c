// Reads mail records as the printer does, see mail_record.hpp: for the simulator, and to show what was sent.
#include "protocol/decimal.hpp"
#include "protocol/frame.hpp"
#include "protocol/mail_record.hpp"

#include <algorithm>

namespace linefeed::protocol {

namespace {

/// The first TAB-separated element of `text`, taken off together with its TAB.
std::string_view take_element(std::string_view& text) {
    const std::size_t end = std::min(text.find('\t'), text.size());
    const std::string_view element = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return element;
}

bool is_record_number(std::string_view text) {
    return !text.empty() && (text.front() != '0' || text.size() == 1);
}

} // namespace

std::optional<MailRecord> parse_mail_record(std::string_view text, EscapeMode escapes) {
    text = text.substr(0, max_record_bytes);
    std::size_t elements = static_cast<std::size_t>(std::ranges::count(text, '\t'));
    const std::string_view number_text = take_element(text);
    const auto number = read_decimal<std::uint32_t>(number_text);
    if (!is_record_number(number_text) || !number) {
        return std::nullopt;
    }
    MailRecord record{RecordNumber{*number}, {}, {}};
    record.fields.reserve(std::min(elements, max_fields));
    for (; elements > 0; --elements) {
        const std::string_view element = take_element(text);
        if (elements == 1) {
            if (const auto properties = read_properties(element)) {
                record.properties = *properties;
                break;
            }
        }
        if (record.fields.size() < max_fields) {
            std::string& field = record.fields.emplace_back(unescape(element, escapes));
            std::ranges::replace(field, '\0', ' ');
        }
    }
    return record;
}

} // namespace linefeed::protocol
