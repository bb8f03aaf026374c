// Decimal numbers as the protocol writes them: digits only, no sign but a leading minus, no locale, no allocation.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// Appends the digits of `value`.
template <std::integral Number>
void append_decimal(std::string& out, Number value) {
    std::array<char, 24> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    out.append(digits.data(), end);
}

/// The number that the whole of `text` spells, or std::nullopt if it spells none or one that does not fit.
template <std::integral Number>
[[nodiscard]] std::optional<Number> read_decimal(std::string_view text) {
    Number value{};
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stopped != end) {
        return std::nullopt;
    }
    return value;
}

} // namespace linefeed::protocol
