// Escapes of data, see escapes.hpp. Runs without special characters are copied whole.
#include "protocol/escapes.hpp"

namespace linefeed::protocol {

void append_escaped(std::string& out, std::string_view text, EscapeMode mode) {
    if (mode == EscapeMode::none) {
        out.append(text);
        return;
    }
    while (true) {
        const std::size_t special = text.find_first_of("^\\");
        if (special == std::string_view::npos) {
            out.append(text);
            return;
        }
        out.append(text.substr(0, special));
        out.push_back('\\');
        out.push_back(text[special]);
        text.remove_prefix(special + 1);
    }
}

std::string unescape(std::string_view text, EscapeMode mode) {
    if (mode == EscapeMode::none || text.find('\\') == std::string_view::npos) {
        return std::string{text};
    }
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == '\\' || text[i + 1] == '^');
        if (escape) {
            ++i;
        }
        out.push_back(text[i]);
    }
    return out;
}

} // namespace linefeed::protocol
