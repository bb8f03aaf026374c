// What stdout is, and what fits on it: width in columns, colours, and texts that are cut instead of wrapped.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::client {

/// Where something is shown.
struct Screen {
    bool colours = false;
    std::optional<std::size_t> columns{}; ///< absent = no terminal: nothing is cut
    std::size_t rows = 24;

    friend bool operator==(const Screen&, const Screen&) = default;
};

/// Stdout as it is now: a terminal may change its size. No colours if NO_COLOR is set, or TERM is dumb or missing.
[[nodiscard]] Screen stdout_screen();

enum class Colour {
    none,
    good,    ///< green
    warning, ///< yellow
    bad,     ///< red
    faint,
    strong,
};

/// `text` in a colour, if the screen has any.
[[nodiscard]] std::string coloured(std::string_view text, Colour colour, const Screen& screen);

/// How many columns a terminal needs for a text. Precondition: printable() has made it.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// The text, or what of it fits in `columns` (at least 1) with "…" behind it. Precondition: printable() has made it.
[[nodiscard]] std::string cut(std::string_view text, std::size_t columns);

} // namespace linefeed::client
