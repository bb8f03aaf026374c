#include "printer/printer_path.hpp"

#include "protocol/charset.hpp"

#include <algorithm>

namespace linefeed::printer {

namespace {

using protocol::Charset;

constexpr std::size_t max_path = 260;
constexpr char32_t undefined = 0xFFFD;

Failure wrong(std::string_view path, std::string_view why) {
    return {FailureKind::usage, "the path \"" + std::string{path} + "\" " + std::string{why}};
}

char upper(char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

std::string_view without_outer_backslashes(std::string_view path) {
    while (path.starts_with('\\')) {
        path.remove_prefix(1);
    }
    while (path.ends_with('\\')) {
        path.remove_suffix(1);
    }
    return path;
}

/// Bytes that Windows-1252 leaves undefined are the characters of the same number.
std::optional<char> byte_of(char32_t character) {
    if (const auto byte = protocol::to_single_byte(character, Charset::windows_1252)) {
        return static_cast<char>(*byte);
    }
    if (character >= 0x80 && character <= 0x9F &&
        protocol::from_single_byte(static_cast<unsigned char>(character), Charset::windows_1252) == undefined) {
        return static_cast<char>(character);
    }
    return std::nullopt;
}

void append_utf8(std::string& out, char32_t character) {
    const auto push = [&out](char32_t bits) { out.push_back(static_cast<char>(static_cast<unsigned char>(bits))); };
    if (character < 0x80) {
        push(character);
    } else if (character < 0x800) {
        push(0xC0U | character >> 6U);
        push(0x80U | (character & 0x3FU));
    } else {
        push(0xE0U | character >> 12U);
        push(0x80U | (character >> 6U & 0x3FU));
        push(0x80U | (character & 0x3FU));
    }
}

bool has_dot_part(std::string_view path) {
    while (!path.empty()) {
        const std::string_view part = path.substr(0, path.find('\\'));
        if (part == "." || part == "..") {
            return true;
        }
        path.remove_prefix(std::min(path.size(), part.size() + 1));
    }
    return false;
}

} // namespace

Result<std::string> printer_path(std::string_view text, protocol::EscapeMode escapes) {
    const auto converted = path_bytes(text);
    if (!converted) {
        return wrong(text, "has a character that the printer does not know in names (UTF-8, Windows-1252)");
    }
    std::string bytes = *converted;
    if (std::ranges::any_of(bytes, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; })) {
        return wrong(text, "has a control character");
    }
    if (escapes == protocol::EscapeMode::none && bytes.find('^') != std::string::npos) {
        return wrong(text, "has a ^, which firmware without escapes cannot be told");
    }
    std::ranges::replace(bytes, '/', '\\');
    bytes = without_outer_backslashes(bytes);
    if (bytes.empty()) {
        return wrong(text, "is empty");
    }
    if (bytes.size() > max_path) {
        return wrong(text, "is longer than " + std::to_string(max_path) + " bytes");
    }
    if (has_dot_part(bytes)) {
        return wrong(text, "has a part \".\" or \"..\"");
    }
    return bytes;
}

Result<std::string> printer_file(std::string_view text, protocol::EscapeMode escapes) {
    auto path = printer_path(text, escapes);
    if (path && path->find_first_of("*?") != std::string::npos) {
        return wrong(text, "has a joker: one file must be named");
    }
    return path;
}

Result<std::string> printer_job(std::string_view text, protocol::EscapeMode escapes) {
    auto path = printer_file(text, escapes);
    return path && path->find('\\') == std::string::npos ? "FFSDISK\\Jobs\\" + *path : path;
}

std::optional<std::string> path_bytes(std::string_view text) {
    std::string bytes;
    while (!text.empty()) {
        const auto character = protocol::decode_utf8(text);
        const auto byte = character ? byte_of(character->code_point) : std::nullopt;
        if (!byte) {
            return std::nullopt;
        }
        bytes.push_back(*byte);
        text.remove_prefix(character->bytes);
    }
    return bytes;
}

std::string path_text(std::string_view bytes) {
    std::string text;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        const char32_t character = protocol::from_single_byte(byte, Charset::windows_1252);
        append_utf8(text, character == undefined ? byte : character);
    }
    return text;
}

bool same_path(std::string_view a, std::string_view b) {
    return std::ranges::equal(without_outer_backslashes(a), without_outer_backslashes(b), {}, upper, upper);
}

bool in_default_directory(std::string_view path) {
    path = without_outer_backslashes(path);
    return std::ranges::any_of(default_directories, [path](std::string_view directory) {
        return path.size() > directory.size() + 1 && path[directory.size()] == '\\' &&
               same_path(path.substr(0, directory.size()), directory);
    });
}

} // namespace linefeed::printer
