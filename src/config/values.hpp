// The kinds of values that settings have. Each kind reads strictly what a node holds, writes it as the effective
// settings show it, and tells what it allows: one description for the parser, the refusals, the dump and the schema.
#pragma once

#include "base/assert.hpp"
#include "base/time.hpp"
#include "config/context.hpp"
#include "config/names.hpp"
#include "link/printer_address.hpp"
#include "protocol/profile.hpp"
#include "protocol/record_properties.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace linefeed::config {

using Json = nlohmann::ordered_json;

/// What a kind of value allows, for the schema test and for refusals.
struct Expectation {
    std::string type; ///< "flag", "whole number", "duration", "size", "text", "path", "choice", "list", "mapping"
    std::vector<std::string> allowed{};     ///< of a choice
    std::optional<std::uint64_t> minimum{}; ///< durations in nanoseconds, sizes in bytes, texts in characters
    std::optional<std::uint64_t> maximum{};
};

// Each kind has: T, the type of the setting;
//   bool read(const Node&, const std::string& key, Context&, T& out): false = refused, and said so;
//   Json write(const T&): null = absent; Expectation expects().

struct Flag {
    using T = bool;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, bool& out) const;
    [[nodiscard]] Json write(bool value) const { return value; }
    [[nodiscard]] Expectation expects() const { return {"flag"}; }
};

/// A whole number: decimal digits without quotes and without leading zeros, within bounds.
[[nodiscard]] std::optional<std::uint64_t> read_whole(const Node& node, const std::string& key, Context& context,
                                                      std::uint64_t minimum, std::uint64_t maximum);

template <typename Number>
struct Whole {
    using T = Number;
    std::uint64_t minimum;
    std::uint64_t maximum; ///< within Number
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, Number& out) const {
        const auto value = read_whole(node, key, context, minimum, maximum);
        out = value ? static_cast<Number>(*value) : out;
        return value.has_value();
    }
    [[nodiscard]] Json write(Number value) const { return value; }
    [[nodiscard]] Expectation expects() const { return {"whole number", {}, minimum, maximum}; }
};

/// `250 ms`: a whole number with a unit, us, ms, s, min or h.
struct DurationValue {
    using T = Duration;
    Duration minimum; ///< in whole microseconds
    Duration maximum;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, Duration& out) const;
    [[nodiscard]] Json write(Duration value) const;
    [[nodiscard]] Expectation expects() const;
};

/// `16 MiB`: a whole number with a unit, B, KiB, MiB or GiB.
struct SizeValue {
    using T = std::uint64_t;
    std::uint64_t minimum;
    std::uint64_t maximum;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, std::uint64_t& out) const;
    [[nodiscard]] Json write(std::uint64_t value) const;
    [[nodiscard]] Expectation expects() const { return {"size", {}, minimum, maximum}; }
};

/// A text. What YAML might take for a number, a flag or nothing needs quotes, since tools differ in what they make of
/// it.
struct TextValue {
    using T = std::string;
    std::uint64_t max_bytes = 1000;
    /// Whole numbers need no quotes: the number of a column.
    bool whole_numbers = false;
    /// What is wrong with the text, in words that follow "expected"; nullptr = nothing can be.
    std::string (*problem)(std::string_view text) = nullptr;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, std::string& out) const;
    [[nodiscard]] Json write(const std::string& value) const { return value; }
    [[nodiscard]] Expectation expects() const { return {"text", {}, 1, max_bytes}; }
};

/// A path; a relative one is relative to the directory of the file.
struct PathValue {
    using T = std::filesystem::path;
    std::uint64_t max_bytes = 4095; ///< of the whole path
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context,
                            std::filesystem::path& out) const;
    [[nodiscard]] Json write(const std::filesystem::path& value) const { return value.string(); }
    [[nodiscard]] Expectation expects() const { return {"path", {}, 1, max_bytes}; }
};

/// `tcp://HOST:PORT` or `serial:///DEVICE`, with options.
struct AddressValue {
    using T = link::PrinterAddress;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context,
                            link::PrinterAddress& out) const;
    [[nodiscard]] Json write(const link::PrinterAddress& value) const { return link::to_string(value); }
    [[nodiscard]] Expectation expects() const { return {"text", {}, 1, 300}; }
};

/// The separator of CSV files: one ASCII character, or `tab`.
struct DelimiterValue {
    using T = char;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, char& out) const;
    [[nodiscard]] Json write(char value) const { return value == '\t' ? std::string{"tab"} : std::string{value}; }
    [[nodiscard]] Expectation expects() const { return {"text", {}, 1, 3}; }
};

/// The index of the word that the node holds, without quotes or with.
[[nodiscard]] std::optional<std::size_t> read_word(const Node& node, const std::string& key, Context& context,
                                                   const std::vector<std::string>& words);

/// One of a few words.
template <typename Value>
struct Choice {
    using T = Value;
    std::vector<std::pair<std::string, Value>> options;

    [[nodiscard]] std::vector<std::string> words() const {
        std::vector<std::string> words;
        for (const auto& option : options) {
            words.push_back(option.first);
        }
        return words;
    }
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, Value& out) const {
        const auto index = read_word(node, key, context, words());
        out = index ? options[*index].second : out;
        return index.has_value();
    }
    [[nodiscard]] Json write(const Value& value) const {
        for (const auto& [word, candidate] : options) {
            if (candidate == value) {
                return word;
            }
        }
        assertion_failed("a value without a word", __FILE__, __LINE__);
    }
    [[nodiscard]] Expectation expects() const { return {"choice", words()}; }
};

/// A firmware profile, see protocol::parse_profile().
struct ProfileValue {
    using T = protocol::Profile;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, protocol::Profile& out) const;
    [[nodiscard]] Json write(const protocol::Profile& value) const { return to_string(value); }
    [[nodiscard]] Expectation expects() const { return {"text", {}, 1, 200}; }
};

/// 0, 90, 180 or 270 degrees.
struct OrientationValue {
    using T = protocol::Orientation;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, T& out) const;
    [[nodiscard]] Json write(T value) const { return 90 * static_cast<int>(value); }
    [[nodiscard]] Expectation expects() const;
};

/// A setting that may be absent.
template <typename Kind>
struct Maybe {
    using T = std::optional<typename Kind::T>;
    Kind kind;
    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, T& out) const {
        typename Kind::T value{};
        if (!kind.read(node, key, context, value)) {
            return false;
        }
        out = std::move(value);
        return true;
    }
    [[nodiscard]] Json write(const T& value) const { return value ? kind.write(*value) : Json{}; }
    [[nodiscard]] Expectation expects() const { return kind.expects(); }
};
template <typename Kind>
Maybe(Kind) -> Maybe<Kind>;

} // namespace linefeed::config
