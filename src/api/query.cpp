#include "api/query.hpp"

#include <algorithm>
#include <charconv>

namespace linefeed::api {

namespace {

std::optional<unsigned> hex_digit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? std::optional<unsigned>(lower - 'a' + 10) : std::nullopt;
}

Problem malformed(std::string detail, std::string advice) {
    return {ProblemType::malformed, std::move(detail), std::move(advice)};
}

std::string quoted(std::string_view text) {
    return '"' + std::string{text} + '"';
}

} // namespace

std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_blank) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == '+' && plus_is_blank) {
            out += ' ';
            continue;
        }
        if (text[at] != '%') {
            out += text[at];
            continue;
        }
        const auto high = at + 2 < text.size() ? hex_digit(text[at + 1]) : std::nullopt;
        const auto low = high ? hex_digit(text[at + 2]) : std::nullopt;
        if (!low || (*high == 0 && *low == 0)) {
            return std::nullopt;
        }
        out += static_cast<char>(*high << 4U | *low);
        at += 2;
    }
    return out;
}

Checked<Query> Query::parse(std::string_view text) {
    Query query;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('&'), text.size());
        const std::string_view part = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (part.empty()) {
            continue;
        }
        const std::size_t equals = std::min(part.find('='), part.size());
        const auto name = percent_decoded(part.substr(0, equals), true);
        const auto value = percent_decoded(part.substr(std::min(equals + 1, part.size())), true);
        if (!name || !value) {
            return malformed("the parameter " + quoted(part) + " cannot be decoded",
                             "write each byte that is not a letter or a digit as %NN");
        }
        if (query.find(*name) != nullptr) {
            return malformed("the parameter " + quoted(*name) + " comes twice", "give it once");
        }
        if (query.parameters_.size() == max_parameters) {
            return malformed("there are more than " + std::to_string(max_parameters) + " parameters", "give fewer");
        }
        query.parameters_.emplace_back(*name, *value);
    }
    return query;
}

const std::string* Query::find(std::string_view name) const {
    const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                    [&](const auto& parameter) { return parameter.first == name; });
    return found == parameters_.end() ? nullptr : &found->second;
}

std::string Query::text(std::string_view name) const {
    const std::string* const value = find(name);
    return value == nullptr ? "" : *value;
}

Checked<std::uint64_t> Query::number(std::string_view name, std::uint64_t least, std::uint64_t most,
                                     std::uint64_t otherwise) const {
    const std::string* const value = find(name);
    if (value == nullptr) {
        return otherwise;
    }
    const auto number = parse_number(*value, most);
    if (!number || *number < least) {
        return malformed(std::string{name} + '=' + *value + " is not what it should be",
                         "give a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    }
    return *number;
}

Checked<bool> Query::flag(std::string_view name) const {
    const std::string* const value = find(name);
    if (value == nullptr || *value == "false") {
        return false;
    }
    if (value->empty() || *value == "true") {
        return true;
    }
    return malformed(std::string{name} + '=' + *value + " is not what it should be", "give true or false");
}

Checked<RecordRange> parse_records(std::string_view text) {
    const std::size_t dash = text.find('-');
    const std::uint64_t most = RecordNumber::max().value();
    const auto first = parse_number(text.substr(0, dash), most);
    const auto last = dash == std::string_view::npos ? first : parse_number(text.substr(dash + 1), most);
    if (!first || !last || *last < *first) {
        return malformed(quoted(text) + " is neither a record number nor a range", "give N or N-M");
    }
    const auto number = [](std::uint64_t value) { return RecordNumber{static_cast<std::uint32_t>(value)}; };
    return RecordRange::closed(number(*first), number(*last));
}

std::optional<std::uint64_t> parse_number(std::string_view text, std::uint64_t most) {
    if (text.empty() || (text.front() == '0' && text.size() > 1) || text.front() == '-') {
        return std::nullopt;
    }
    std::uint64_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc{} && stop == end && number <= most ? std::optional{number} : std::nullopt;
}

} // namespace linefeed::api
