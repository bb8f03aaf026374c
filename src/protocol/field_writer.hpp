// Writes one frame, parameter by parameter, as a message describes itself (messages.hpp).
#pragma once

#include "base/assert.hpp"
#include "base/record_number.hpp"
#include "protocol/commands.hpp"
#include "protocol/decimal.hpp"
#include "protocol/escapes.hpp"
#include "protocol/frame.hpp"
#include "protocol/limits.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace linefeed::protocol {

/// The visitor that encodes: the head of the frame when constructed, TABs between the values, its CR with end().
class FieldWriter {
public:
    FieldWriter(std::string& out, Group group, std::string_view code, EscapeMode escapes)
        : out_(out)
        , escapes_(escapes) {
        out_.append({'^', printer_address, static_cast<char>(group)});
        out_.append(code);
    }

    template <typename T>
    void number(std::string_view /*key*/, std::string_view /*what*/, const T& value, Limits limits = {}) {
        separate();
        if constexpr (std::is_same_v<T, std::int32_t>) {
            append_decimal(out_, value);
        } else {
            const std::uint32_t number = plain(value);
            LINEFEED_ASSERT(number >= limits.smallest && number <= limits.largest);
            append_decimal(out_, number);
        }
    }
    /// Empty if there is no value.
    template <typename T>
    void optional(std::string_view key, std::string_view what, const std::optional<T>& value, Limits limits = {}) {
        value ? number(key, what, *value, limits) : separate();
    }
    /// Left out if there is no value.
    template <typename T>
    void added(std::string_view key, std::string_view what, const std::optional<T>& value, Limits limits = {}) {
        if (value) {
            number(key, what, *value, limits);
        }
    }
    template <typename T>
    void defaulted(std::string_view key, std::string_view what, const T& value, Limits limits = {}) {
        number(key, what, value, limits);
    }
    /// Precondition: no TAB, no CR.
    void text(std::string_view /*key*/, std::string_view value) {
        LINEFEED_ASSERT(value.find_first_of("\t\r") == std::string_view::npos);
        separate();
        append_escaped(out_, value, escapes_);
    }
    /// Precondition: no TAB, no CR.
    void verbatim(std::string_view /*key*/, std::string_view value) {
        LINEFEED_ASSERT(value.find_first_of("\t\r") == std::string_view::npos);
        separate();
        out_.append(value);
    }
    void wide(std::string_view /*key*/, std::string_view /*what*/, std::uint64_t value, std::uint64_t largest) {
        LINEFEED_ASSERT(value <= largest);
        separate();
        append_decimal(out_, value);
    }
    void reserved() {
        separate();
        out_.push_back('0');
    }
    void end() { out_.push_back('\r'); }

private:
    template <typename T>
    static std::uint32_t plain(const T& value) {
        if constexpr (std::is_same_v<T, RecordNumber>) {
            return value.value();
        } else {
            return static_cast<std::uint32_t>(value);
        }
    }
    void separate() {
        if (!first_) {
            out_.push_back('\t');
        }
        first_ = false;
    }

    std::string& out_;
    EscapeMode escapes_;
    bool first_ = true;
};

} // namespace linefeed::protocol
