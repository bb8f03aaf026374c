// Messages of the printer as JSON, and from it as words: what a message says of its fields is used here once more, so
// that every view, the monitor and `query` say the same.
#pragma once

#include "printer/json.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages.hpp"
#include "protocol/printable.hpp"

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace linefeed::printer {

/// A number that has a name: to_string() of the protocol's enumerations.
template <typename T>
concept Worded = std::is_enum_v<T> && requires(T value) {
    { to_string(value) } -> std::convertible_to<std::string_view>;
};

/// The visitor that makes an object of a message's fields: numbers, flags, and enumerations in words with the number
/// beside them as `…_code`. An absent value is null.
class FieldJson {
public:
    template <typename T>
    void number(std::string_view key, std::string_view /*what*/, const T& value, protocol::Limits /*limits*/ = {}) {
        const std::string name{key};
        if constexpr (std::is_same_v<T, RecordNumber>) {
            fields[name] = value.value();
        } else if constexpr (Worded<T>) {
            fields[name] = std::string{to_string(value)};
            fields[name + "_code"] = static_cast<std::uint32_t>(value);
        } else if constexpr (std::is_enum_v<T>) {
            fields[name] = static_cast<std::uint32_t>(value);
        } else {
            fields[name] = value;
        }
    }
    template <typename T>
    void optional(std::string_view key, std::string_view what, const std::optional<T>& value,
                  protocol::Limits /*limits*/ = {}) {
        if (value) {
            number(key, what, *value);
        } else {
            fields[std::string{key}] = nullptr;
        }
    }
    /// Left out if the printer leaves it out.
    template <typename T>
    void added(std::string_view key, std::string_view what, const std::optional<T>& value,
               protocol::Limits /*limits*/ = {}) {
        if (value) {
            number(key, what, *value);
        }
    }
    template <typename T>
    void defaulted(std::string_view key, std::string_view what, const T& value, protocol::Limits /*limits*/ = {}) {
        number(key, what, value);
    }
    void text(std::string_view key, std::string_view value) { fields[std::string{key}] = protocol::printable(value); }
    void verbatim(std::string_view key, std::string_view value) { text(key, value); }
    void wide(std::string_view key, std::string_view /*what*/, std::uint64_t value, std::uint64_t /*largest*/) {
        fields[std::string{key}] = value;
    }
    void reserved() {}

    Json fields = Json::object();
};

/// The fields of a message that describes itself.
template <protocol::DescribedMessage T>
[[nodiscard]] Json fields_of(const T& message) {
    FieldJson visitor;
    T::describe(visitor, message);
    return visitor.fields;
}

/// An error number taken apart; null if there is none.
[[nodiscard]] Json to_json(const protocol::PrinterError& error);
/// "2024-05-06 07:08:09"
[[nodiscard]] Json to_json(const protocol::PrinterTime& time);
/// One line of the error list: its numbers are bare, and tell neither who reports it nor whether it switches off.
[[nodiscard]] Json listed_error_json(const protocol::ErrorEntry& entry);
/// One line of the event list.
[[nodiscard]] Json event_json(const protocol::EventEntry& entry);

/// Any message: its fields, and for lists their entries.
[[nodiscard]] Json fields_of(const protocol::Message& message);
/// Its command with the group, "=SM", "!GO"; for script lines "*". Empty for one that nobody knows.
[[nodiscard]] std::string command_of(const protocol::Message& message);
/// {"command": "=SM", "what": "mailing status", "fields": {…}}
[[nodiscard]] Json to_json(const protocol::Message& message);
/// One line, "mailing status: depth 256, entries 0, …".
[[nodiscard]] std::string in_words(const protocol::Message& message);

/// Bytes of a frame in ASCII, everything else and the backslash as \xNN, TAB as \t: what send takes as well.
[[nodiscard]] std::string escaped_bytes(std::string_view bytes);
/// The bytes that escaped_bytes() has made text of; std::nullopt = a backslash that begins none of its escapes.
[[nodiscard]] std::optional<std::string> unescaped_bytes(std::string_view text);

} // namespace linefeed::printer
