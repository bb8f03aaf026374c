// Reads parameters, see parameter_reader.hpp.
#include "protocol/parameter_reader.hpp"

#include "base/assert.hpp"
#include "protocol/decimal.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::protocol {

namespace {

constexpr std::size_t longest_value_shown = 40;

bool is_blank(char c) {
    return c == ' ' || c == '\0';
} // the printer replaces NUL by a blank

std::string printable(std::string_view text) {
    std::string out{text.substr(0, longest_value_shown)};
    std::ranges::replace_if(
        out, [](char c) { return c < ' ' || c > '~'; }, '?');
    return text.size() > longest_value_shown ? out + "..." : out;
}

} // namespace

std::optional<std::string_view> ParameterReader::text() {
    ++position_;
    if (!rest_) {
        return std::nullopt;
    }
    const std::size_t end = rest_->find('\t');
    const std::string_view value = rest_->substr(0, end);
    rest_ = end == std::string_view::npos ? std::nullopt : std::optional{rest_->substr(end + 1)};
    return value.empty() ? std::nullopt : std::optional{value};
}

std::string_view ParameterReader::trimmed() {
    std::string_view value = text().value_or(std::string_view{});
    while (!value.empty() && is_blank(value.front())) {
        value.remove_prefix(1);
    }
    while (!value.empty() && is_blank(value.back())) {
        value.remove_suffix(1);
    }
    return value;
}

std::optional<std::uint32_t> ParameterReader::optional_number(std::string_view what, std::uint32_t largest) {
    const std::string_view value = trimmed();
    if (value.empty()) {
        return std::nullopt;
    }
    const auto number = read_decimal<std::uint32_t>(value);
    if (!number || *number > largest) {
        complain(what, value);
        return std::nullopt;
    }
    return number;
}

std::uint32_t ParameterReader::number(std::string_view what, std::uint32_t smallest, std::uint32_t largest) {
    const std::string_view value = trimmed();
    const auto number = read_decimal<std::uint32_t>(value);
    if (!number || *number < smallest || *number > largest) {
        complain(what, value);
        return smallest;
    }
    return *number;
}

namespace {

/// 32 bits written as a signed or an unsigned decimal.
std::optional<std::int32_t> read_32_bits(std::string_view value) {
    if (const auto number = read_decimal<std::int32_t>(value)) {
        return *number;
    }
    if (const auto number = read_decimal<std::uint32_t>(value)) {
        return static_cast<std::int32_t>(*number);
    }
    return std::nullopt;
}

} // namespace

std::int32_t ParameterReader::signed_number(std::string_view what) {
    const std::string_view value = trimmed();
    const auto number = read_32_bits(value);
    if (!number) {
        complain(what, value);
    }
    return number.value_or(0);
}

std::optional<std::int32_t> ParameterReader::optional_signed_number(std::string_view what) {
    const std::string_view value = trimmed();
    const auto number = read_32_bits(value);
    if (!number && !value.empty()) {
        complain(what, value);
    }
    return number;
}

std::uint64_t ParameterReader::wide_number(std::string_view what, std::uint64_t largest) {
    const std::string_view value = trimmed();
    const auto number = read_decimal<std::uint64_t>(value);
    if (!number || *number > largest) {
        complain(what, value);
        return 0;
    }
    return *number;
}

std::string_view ParameterReader::rest() {
    ++position_;
    return std::exchange(rest_, std::nullopt).value_or(std::string_view{});
}

std::string ParameterReader::problem() const {
    LINEFEED_ASSERT(!ok());
    const std::string position = "parameter " + std::to_string(bad_position_);
    if (value_.empty()) {
        return position + " is missing: " + std::string{expected_};
    }
    return position + " is not " + std::string{expected_} + ": \"" + printable(value_) + '"';
}

void ParameterReader::complain(std::string_view what, std::string_view value) {
    if (ok()) {
        bad_position_ = position_;
        expected_ = what;
        value_ = value;
    }
}

} // namespace linefeed::protocol
