// Reads the parameters of a command into a message, field by field, as the message describes itself (messages.hpp).
#pragma once

#include "base/record_number.hpp"
#include "protocol/escapes.hpp"
#include "protocol/limits.hpp"
#include "protocol/parameter_reader.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace linefeed::protocol {

/// The visitor that parses. `key` is the name of a field for machines, `what` its name in problems, with its article.
class FieldReader {
public:
    FieldReader(ParameterReader& in, EscapeMode escapes)
        : in_(in)
        , escapes_(escapes) {}

    /// A field that must be there.
    template <typename T>
    void number(std::string_view /*key*/, std::string_view what, T& value, Limits limits = {}) {
        if constexpr (std::is_same_v<T, std::int32_t>) {
            value = in_.signed_number(what);
        } else {
            value = made<T>(in_.number(what, limits.smallest, limits.largest));
        }
    }
    /// A field that may be empty or missing.
    template <typename T>
    void optional(std::string_view /*key*/, std::string_view what, std::optional<T>& value, Limits limits = {}) {
        if constexpr (std::is_same_v<T, std::int32_t>) {
            value = in_.optional_signed_number(what);
        } else if (const auto number = in_.optional_number(what, limits.largest)) {
            value = made<T>(*number);
        }
    }
    /// A field that newer firmware has appended.
    template <typename T>
    void added(std::string_view key, std::string_view what, std::optional<T>& value, Limits limits = {}) {
        optional(key, what, value, limits);
    }
    /// A field that keeps its default when it is empty or missing.
    template <typename T>
    void defaulted(std::string_view /*key*/, std::string_view what, T& value, Limits limits = {}) {
        if (const auto number = in_.optional_number(what, limits.largest)) {
            value = made<T>(*number);
        }
    }
    /// Text with escapes.
    void text(std::string_view /*key*/, std::string& value) {
        value = unescape(in_.text().value_or(std::string_view{}), escapes_);
    }
    /// What the manual does not describe: kept as it came.
    void verbatim(std::string_view /*key*/, std::string& value) { value = in_.text().value_or(std::string_view{}); }
    /// A field of up to `largest` that may need more than 32 bits.
    void wide(std::string_view /*key*/, std::string_view what, std::uint64_t& value, std::uint64_t largest) {
        value = in_.wide_number(what, largest);
    }
    /// A field without a meaning; always 0.
    void reserved() { static_cast<void>(in_.text()); }

private:
    template <typename T>
    static T made(std::uint32_t number) {
        if constexpr (std::is_same_v<T, bool>) {
            return number != 0;
        } else if constexpr (std::is_enum_v<T>) {
            return static_cast<T>(number);
        } else {
            return T{number};
        }
    }

    ParameterReader& in_;
    EscapeMode escapes_;
};

} // namespace linefeed::protocol
