#include "api/media_type.hpp"

#include <algorithm>

namespace linefeed::api {

namespace {

constexpr std::string_view blanks = " \t";

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Cuts the next element of a list off `text`.
std::string_view take(std::string_view& text, char separator) {
    const std::string_view element = text.substr(0, text.find(separator));
    text.remove_prefix(std::min(element.size() + 1, text.size()));
    return trimmed(element);
}

/// q=0, q=0.0 …: this type is not wanted.
bool is_refusal(std::string_view parameter) {
    return (parameter.starts_with("q=0") || parameter.starts_with("Q=0")) &&
           parameter.substr(3).find_first_not_of(".0") == std::string_view::npos;
}

/// How exactly a range names the type, 1…3; 0 = not at all.
int exactness(std::string_view range, std::string_view type) {
    if (range == type) {
        return 3;
    }
    if (range == "*/*") {
        return 1;
    }
    return range.ends_with("/*") && type.starts_with(range.substr(0, range.size() - 1)) ? 2 : 0;
}

} // namespace

std::string media_type_of(std::string_view content_type) {
    std::string type{trimmed(content_type.substr(0, content_type.find(';')))};
    std::transform(type.begin(), type.end(), type.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
    return type;
}

bool accepts(std::string_view accept, std::string_view media_type) {
    if (trimmed(accept).empty()) {
        return true;
    }
    const std::string wanted = media_type_of(media_type);
    int best = 0;
    bool accepted = false;
    while (!accept.empty()) {
        std::string_view element = take(accept, ',');
        const std::string range = media_type_of(take(element, ';'));
        bool refused = false;
        while (!element.empty()) {
            refused = is_refusal(take(element, ';')) || refused;
        }
        if (const int exact = exactness(range, wanted); exact > best) { // the most exact one decides
            best = exact;
            accepted = !refused;
        }
    }
    return accepted;
}

} // namespace linefeed::api
