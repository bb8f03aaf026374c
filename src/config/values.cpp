#include "config/values.hpp"

#include <algorithm>
#include <charconv>
#include <span>

namespace linefeed::config {

namespace {

bool is_digit(char character) {
    return character >= '0' && character <= '9';
}

bool all_digits(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

/// Of digits without leading zeros; std::nullopt if there are others, or the number exceeds 64 bits.
std::optional<std::uint64_t> parse_digits(std::string_view digits) {
    if (!all_digits(digits) || (digits.size() > 1 && digits.front() == '0')) {
        return std::nullopt;
    }
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc{} ? std::optional{value} : std::nullopt;
}

struct Unit {
    std::string_view name;
    std::uint64_t size;
};

/// From the smallest to the largest.
constexpr std::array<Unit, 5> duration_units{
    {{"us", 1'000}, {"ms", 1'000'000}, {"s", 1'000'000'000}, {"min", 60'000'000'000}, {"h", 3'600'000'000'000}}};
constexpr std::array<Unit, 4> size_units{{{"B", 1}, {"KiB", 1U << 10U}, {"MiB", 1U << 20U}, {"GiB", 1U << 30U}}};

/// In the largest unit that divides it.
std::string with_unit(std::uint64_t value, std::span<const Unit> units) {
    const Unit* best = &units.front();
    for (const Unit& unit : units) {
        if (value % unit.size == 0) {
            best = &unit;
        }
    }
    return std::to_string(value / best->size) + ' ' + std::string{best->name};
}

std::string unit_names(std::span<const Unit> units) {
    std::vector<std::string> names;
    for (const Unit& unit : units) {
        names.emplace_back(unit.name);
    }
    return one_of(names);
}

/// A quantity as it was written.
struct Quantity {
    std::string_view digits;
    std::string_view unit;
};

Quantity split(std::string_view text) {
    const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
    Quantity quantity{text.substr(0, static_cast<std::size_t>(end - text.begin())), {}};
    quantity.unit = text.substr(quantity.digits.size());
    if (quantity.unit.starts_with(' ')) {
        quantity.unit.remove_prefix(1);
    }
    return quantity;
}

/// `minimum` and `maximum` in the unit whose size is 1 (a nanosecond, a byte).
std::optional<std::uint64_t> read_with_unit(const Node& node, const std::string& key, Context& context,
                                            std::span<const Unit> units, std::string_view what,
                                            const Expectation& bounds) {
    const std::string expected =
        std::string{what} + " from " + with_unit(*bounds.minimum, units) + " to " + with_unit(*bounds.maximum, units);
    const auto refuse = [&](const std::string& hint) {
        refuse_value(node, key, expected, context, hint);
        return std::nullopt;
    };
    if (node.kind != Node::Kind::scalar) {
        return refuse({});
    }
    const Quantity quantity = split(node.text);
    if (quantity.digits.empty()) {
        return refuse("; write a whole number and a unit");
    }
    if (quantity.unit.empty()) {
        return refuse("; a unit is missing: " + unit_names(units));
    }
    const auto unit =
        std::find_if(units.begin(), units.end(), [&](const Unit& one) { return one.name == quantity.unit; });
    if (unit == units.end()) {
        return refuse(quantity.unit.starts_with('.') || quantity.unit.starts_with(',')
                          ? "; write a whole number and a smaller unit"
                          : "; the units are " + unit_names(units));
    }
    const auto number = parse_digits(quantity.digits);
    if (!number) {
        return refuse(quantity.digits.front() == '0' ? "; leave leading zeros out" : std::string{});
    }
    if (*number > *bounds.maximum / unit->size || *number * unit->size < *bounds.minimum) {
        return refuse({});
    }
    return *number * unit->size;
}

/// Words that some version of YAML takes for a flag or for nothing.
bool looks_like_flag(std::string_view text) {
    const std::string word = variable_word(text);
    constexpr std::array<std::string_view, 9> words{"TRUE", "FALSE", "YES", "NO", "ON", "OFF", "Y", "N", "NULL"};
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Numbers, dates and times of any version of YAML, generously; an address with several dots is none.
bool looks_like_number(std::string_view text) {
    if (text.starts_with('+') || text.starts_with('-')) {
        text.remove_prefix(1);
    }
    if (text.starts_with("0x") || text.starts_with("0o") || text.starts_with("0b")) {
        return true;
    }
    const std::string word = variable_word(text);
    if (word == "_INF" || word == "_NAN") {
        return true;
    }
    if (text.starts_with('.')) {
        text.remove_prefix(1);
    }
    return !text.empty() && is_digit(text.front()) &&
           text.find_first_not_of("0123456789_.:eE+-") == std::string_view::npos &&
           std::count(text.begin(), text.end(), '.') < 2;
}

/// Reads a text into `out`; `expected` says what it is.
bool read_text(const Node& node, const std::string& key, const std::string& expected, Context& context,
               bool whole_numbers, std::string& out) {
    if (node.kind != Node::Kind::scalar) {
        refuse_value(node, key, expected, context);
        return false;
    }
    const bool from_file = node.place.variable.empty();
    if (from_file && node.plain && !(whole_numbers && parse_digits(node.text)) &&
        (looks_like_flag(node.text) || looks_like_number(node.text))) {
        refuse_value(node, key, expected, context, "; put it in quotes if this text is meant");
        return false;
    }
    if (node.text.empty() || node.text.find('\0') != std::string::npos) {
        refuse_value(node, key, expected, context); // a text with a NUL would end there elsewhere
        return false;
    }
    out = node.text;
    return true;
}

} // namespace

std::string describe(const Node& node) {
    switch (node.kind) {
    case Node::Kind::nothing:
    case Node::Kind::unusable:
        return "nothing";
    case Node::Kind::scalar:
        return node.plain ? in_quotes(node.text) : "the text " + in_quotes(node.text);
    case Node::Kind::sequence:
        return "a list";
    case Node::Kind::mapping:
        return "a mapping";
    }
    assertion_failed("Node::Kind", __FILE__, __LINE__);
}

void refuse_value(const Node& node, const std::string& key, const std::string& expected, Context& context,
                  const std::string& hint) {
    if (node.kind != Node::Kind::unusable) {
        context.refuse(node.place, key, "expected " + expected + ", found " + describe(node) + hint);
    }
}

bool Flag::read(const Node& node, const std::string& key, Context& context, bool& out) const {
    if (node.kind == Node::Kind::scalar && node.plain && (node.text == "true" || node.text == "false")) {
        out = node.text == "true";
        return true;
    }
    refuse_value(node, key, "true or false", context);
    return false;
}

std::optional<std::uint64_t> read_whole(const Node& node, const std::string& key, Context& context,
                                        std::uint64_t minimum, std::uint64_t maximum) {
    const std::string expected = "a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum);
    if (node.kind != Node::Kind::scalar || !node.plain) {
        refuse_value(node, key, expected, context, node.kind == Node::Kind::scalar ? "; leave the quotes out" : "");
        return std::nullopt;
    }
    const auto value = parse_digits(node.text);
    if (!value || *value < minimum || *value > maximum) {
        const bool zeros = all_digits(node.text) && node.text.front() == '0';
        refuse_value(node, key, expected, context,
                     value                   ? ""
                     : zeros                 ? "; leave leading zeros out"
                     : all_digits(node.text) ? ""
                                             : "; write digits only");
        return std::nullopt;
    }
    return value;
}

bool DurationValue::read(const Node& node, const std::string& key, Context& context, Duration& out) const {
    const auto value = read_with_unit(node, key, context, duration_units, "a duration", expects());
    out = value ? Duration{static_cast<Duration::rep>(*value)} : out;
    return value.has_value();
}

Json DurationValue::write(Duration value) const {
    return with_unit(static_cast<std::uint64_t>(value.count()), duration_units);
}

Expectation DurationValue::expects() const {
    return {"duration", {}, static_cast<std::uint64_t>(minimum.count()), static_cast<std::uint64_t>(maximum.count())};
}

bool SizeValue::read(const Node& node, const std::string& key, Context& context, std::uint64_t& out) const {
    const auto value = read_with_unit(node, key, context, size_units, "a size", expects());
    out = value.value_or(out);
    return value.has_value();
}

Json SizeValue::write(std::uint64_t value) const {
    return with_unit(value, size_units);
}

bool TextValue::read(const Node& node, const std::string& key, Context& context, std::string& out) const {
    const std::string expected = "a text of 1 to " + std::to_string(max_bytes) + " bytes";
    std::string text;
    if (!read_text(node, key, expected, context, whole_numbers, text)) {
        return false;
    }
    if (text.size() > max_bytes) {
        refuse_value(node, key, expected, context, " (" + std::to_string(text.size()) + " bytes)");
        return false;
    }
    if (const std::string wrong = problem == nullptr ? std::string{} : problem(text); !wrong.empty()) {
        refuse_value(node, key, wrong, context);
        return false;
    }
    out = std::move(text);
    return true;
}

bool PathValue::read(const Node& node, const std::string& key, Context& context, std::filesystem::path& out) const {
    const std::string expected = "a path of 1 to " + std::to_string(max_bytes) + " bytes";
    std::string text;
    if (!read_text(node, key, expected, context, false, text)) {
        return false;
    }
    if (text.find('\n') != std::string::npos) {
        refuse_value(node, key, "a path without line breaks", context);
        return false;
    }
    std::filesystem::path path = (context.directory / text).lexically_normal();
    if (!path.has_filename()) {
        path = path.parent_path(); // "folder/" is "folder"
    }
    if (path.native().size() > max_bytes) {
        refuse_value(node, key, expected, context, " (" + std::to_string(path.native().size()) + " bytes)");
        return false;
    }
    out = std::move(path);
    return true;
}

bool AddressValue::read(const Node& node, const std::string& key, Context& context, link::PrinterAddress& out) const {
    const std::string expected = "a printer address, " + std::string{link::printer_address_forms};
    std::string text;
    if (!read_text(node, key, expected, context, false, text)) {
        return false;
    }
    const auto address = link::parse_printer_address(text);
    if (!address) {
        refuse_value(node, key, expected, context);
        return false;
    }
    out = *address;
    return true;
}

bool DelimiterValue::read(const Node& node, const std::string& key, Context& context, char& out) const {
    const std::string& text = node.text;
    const bool one = text.size() == 1 && text.front() >= ' ' && text.front() <= '~' && text.front() != '"';
    if (node.kind != Node::Kind::scalar || !(one || text == "tab" || text == "\t")) {
        refuse_value(node, key, "one ASCII character other than a quote, or tab", context);
        return false;
    }
    out = one ? text.front() : '\t';
    return true;
}

std::optional<std::size_t> read_word(const Node& node, const std::string& key, Context& context,
                                     const std::vector<std::string>& words) {
    const auto word = std::find(words.begin(), words.end(), node.text);
    if (node.kind != Node::Kind::scalar || word == words.end()) {
        refuse_value(node, key, one_of(words), context,
                     node.kind == Node::Kind::scalar ? did_you_mean(node.text, words) : std::string{});
        return std::nullopt;
    }
    return static_cast<std::size_t>(word - words.begin());
}

bool ProfileValue::read(const Node& node, const std::string& key, Context& context, protocol::Profile& out) const {
    const auto profile = protocol::parse_profile(node.text);
    if (node.kind != Node::Kind::scalar || !profile) {
        if (node.kind == Node::Kind::scalar) {
            context.refuse(node.place, key, profile.error().message);
        } else {
            refuse_value(node, key, "a firmware profile", context);
        }
        return false;
    }
    out = *profile;
    return true;
}

bool OrientationValue::read(const Node& node, const std::string& key, Context& context, T& out) const {
    const auto index = read_word(node, key, context, expects().allowed);
    out = index ? static_cast<T>(*index) : out;
    return index.has_value();
}

Expectation OrientationValue::expects() const {
    return {"choice", {"0", "90", "180", "270"}};
}

} // namespace linefeed::config
