#include "client/terminal.hpp"

#include "base/assert.hpp"
#include "protocol/charset.hpp"

#include <clocale>
#include <cstdlib>
#include <cwchar>
#include <sys/ioctl.h>
#include <unistd.h>

namespace linefeed::client {

namespace {

constexpr std::string_view ellipsis = "…";

std::string_view variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::string_view{} : std::string_view{value};
}

std::string_view sequence(Colour colour) {
    switch (colour) {
    case Colour::none:
        return "";
    case Colour::good:
        return "\033[32m";
    case Colour::warning:
        return "\033[33m";
    case Colour::bad:
        return "\033[31m";
    case Colour::faint:
        return "\033[2m";
    case Colour::strong:
        return "\033[1m";
    }
    assertion_failed("Colour", __FILE__, __LINE__);
}

/// wcwidth() knows the width of a character by the locale; C.UTF-8 is part of Debian's libc.
std::size_t width_of(char32_t character) {
    static const locale_t unicode = ::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
    if (unicode == nullptr) {
        return 1;
    }
    const locale_t before = ::uselocale(unicode);
    const int width = ::wcwidth(static_cast<wchar_t>(character));
    ::uselocale(before);
    return width < 0 ? 1 : static_cast<std::size_t>(width);
}

struct Character {
    std::size_t bytes = 1;
    std::size_t columns = 1;
};

Character first_of(std::string_view text) {
    const auto decoded = protocol::decode_utf8(text);
    return decoded ? Character{decoded->bytes, width_of(decoded->code_point)} : Character{};
}

} // namespace

Screen stdout_screen() {
    Screen screen;
    if (::isatty(STDOUT_FILENO) == 0) {
        return screen;
    }
    constexpr std::size_t usual_columns = 80;
    winsize size{};
    const bool known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0;
    screen.columns = known ? size.ws_col : usual_columns;
    screen.rows = known ? size.ws_row : screen.rows;
    const std::string_view term = variable("TERM");
    screen.colours = variable("NO_COLOR").empty() && !term.empty() && term != "dumb";
    return screen;
}

std::string coloured(std::string_view text, Colour colour, const Screen& screen) {
    if (!screen.colours || colour == Colour::none || text.empty()) {
        return std::string{text};
    }
    return std::string{sequence(colour)} + std::string{text} + "\033[0m";
}

std::size_t display_width(std::string_view text) {
    std::size_t columns = 0;
    while (!text.empty()) {
        const Character character = first_of(text);
        columns += character.columns;
        text.remove_prefix(character.bytes);
    }
    return columns;
}

std::string cut(std::string_view text, std::size_t columns) {
    LINEFEED_ASSERT(columns >= 1);
    if (display_width(text) <= columns) {
        return std::string{text};
    }
    std::size_t kept = 0;
    for (std::size_t used = 0; kept < text.size();) {
        const Character character = first_of(text.substr(kept));
        if (used + character.columns + 1 > columns) {
            break;
        }
        used += character.columns;
        kept += character.bytes;
    }
    return std::string{text.substr(0, kept)} + std::string{ellipsis};
}

} // namespace linefeed::client
