#include "config/effective.hpp"

#include "config/names.hpp"
#include "config/settings_json.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace linefeed::config {

namespace {

using Json = nlohmann::ordered_json;

constexpr int indent = 2;

bool is_digit(char character) {
    return character >= '0' && character <= '9';
}

/// A letter, a digit, or one of `others`.
bool is_one_of(char character, std::string_view others) {
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') || is_digit(character) ||
           others.find(character) != std::string_view::npos;
}

/// Whether every YAML parser reads the text without quotes as this text.
bool is_plain(std::string_view text) {
    constexpr std::array<std::string_view, 9> reserved{"TRUE", "FALSE", "YES", "NO", "ON", "OFF", "Y", "N", "NULL"};
    return !text.empty() && is_one_of(text.front(), "/") && !is_digit(text.front()) &&
           std::all_of(text.begin(), text.end(), [](char character) { return is_one_of(character, "/_.-"); }) &&
           std::find(reserved.begin(), reserved.end(), variable_word(text)) == reserved.end();
}

/// `250 ms`.
bool is_quantity(std::string_view text) {
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    return digits > 0 && digits + 1 < text.size() && text[digits] == ' ' &&
           std::all_of(text.begin() + static_cast<std::ptrdiff_t>(digits) + 1, text.end(),
                       [](char character) { return is_one_of(character, {}) && !is_digit(character); });
}

/// JSON's quotes are YAML's double quotes.
std::string scalar(const Json& value) {
    if (value.is_string()) {
        const auto& text = value.get_ref<const std::string&>();
        if (is_plain(text) || is_quantity(text)) {
            return text;
        }
    }
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Error numbers are keys without quotes.
std::string key_text(const std::string& key) {
    const bool number = !key.empty() && key.front() != '0' && std::all_of(key.begin(), key.end(), is_digit);
    return number ? key : scalar(Json(key));
}

void append(std::string& out, const Json& value, int depth) {
    const std::string space(static_cast<std::size_t>(depth * indent), ' ');
    if (value.is_object()) {
        if (value.empty()) {
            out += " {}\n";
            return;
        }
        out += '\n';
        for (const auto& [key, inner] : value.items()) {
            out += space + key_text(key) + ':';
            append(out, inner, depth + 1);
        }
    } else if (value.is_array()) {
        out += " [";
        for (std::size_t i = 0; i < value.size(); ++i) {
            out += (i == 0 ? "" : ", ") + scalar(value[i]);
        }
        out += "]\n";
    } else {
        out += ' ' + scalar(value) + '\n';
    }
}

} // namespace

std::string effective_yaml(const Settings& settings) {
    std::string out;
    append(out, to_json(settings), 0);
    return out.substr(1);
}

std::string effective_json(const Settings& settings) {
    return to_json(settings).dump(indent, ' ', false, Json::error_handler_t::replace) + '\n';
}

} // namespace linefeed::config
