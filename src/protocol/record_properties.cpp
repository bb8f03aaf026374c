// Writes and reads property blocks, see record_properties.hpp.
#include "protocol/record_properties.hpp"

#include "protocol/decimal.hpp"

#include <algorithm>
#include <limits>

namespace linefeed::protocol {

namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Takes the digits at the front of `text`. std::nullopt if there are none.
std::optional<std::uint32_t> take_number(std::string_view& text) {
    const auto digits = static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
    if (digits == 0) {
        return std::nullopt;
    }
    const auto value = read_decimal<std::uint32_t>(text.substr(0, digits));
    text.remove_prefix(digits);
    return value.value_or(std::numeric_limits<std::uint32_t>::max());
}

/// Takes one property from the front of `text`. False if there is none or the block has it already.
bool take_property(std::string_view& text, RecordProperties& properties) {
    const char name = text.front();
    text.remove_prefix(1);
    switch (name) {
    case 'h':
        if (properties.mirrored) {
            return false;
        }
        properties.mirrored = true;
        return true;
    case 'o':
        if (properties.orientation || text.empty() || text.front() < '0' || text.front() > '3') {
            return false;
        }
        properties.orientation = static_cast<Orientation>(text.front() - '0');
        text.remove_prefix(1);
        return true;
    case 'r':
        if (properties.repetitions) {
            return false;
        }
        properties.repetitions = take_number(text);
        return properties.repetitions.has_value();
    default:
        return false;
    }
}

} // namespace

void append_properties(std::string& out, const RecordProperties& properties) {
    out.push_back('{');
    if (properties.mirrored) {
        out.push_back('h');
    }
    if (properties.orientation) {
        out.push_back('o');
        append_decimal(out, static_cast<unsigned>(*properties.orientation));
    }
    if (properties.repetitions) {
        out.push_back('r');
        append_decimal(out, *properties.repetitions);
    }
    out.push_back('}');
}

std::optional<RecordProperties> read_properties(std::string_view text) {
    if (text.size() < 2 || !text.starts_with('{') || !text.ends_with('}')) {
        return std::nullopt;
    }
    text = text.substr(1, text.size() - 2);
    RecordProperties properties;
    while (!text.empty()) {
        if (!take_property(text, properties)) {
            return std::nullopt;
        }
    }
    return properties;
}

} // namespace linefeed::protocol
