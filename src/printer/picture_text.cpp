// Pictures for the terminal, see picture.hpp.
#include "base/assert.hpp"
#include "printer/picture.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace linefeed::printer {

namespace {

/// How many dots a character stands for.
struct Cell {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
};

constexpr Cell half_blocks{1, 2};
constexpr Cell braille{2, 4};
constexpr Cell one_dot{1, 1};

bool is_on(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    return x < picture.width && y < picture.height && picture.dot(x, y);
}

void append_half_block(std::string& out, const Picture& picture, std::uint32_t x, std::uint32_t y) {
    constexpr std::array<std::string_view, 4> blocks{" ", "▀", "▄", "█"};
    out += blocks[(is_on(picture, x, y) ? 1U : 0U) + (is_on(picture, x, y + 1) ? 2U : 0U)];
}

/// U+2800 and a bit for each dot; in UTF-8.
void append_braille(std::string& out, const Picture& picture, std::uint32_t x, std::uint32_t y) {
    constexpr std::array<std::array<unsigned, 4>, 2> bits{{{0, 1, 2, 6}, {3, 4, 5, 7}}};
    unsigned dots = 0;
    for (std::uint32_t column = 0; column < braille.width; ++column) {
        for (std::uint32_t row = 0; row < braille.height; ++row) {
            dots |= is_on(picture, x + column, y + row) ? 1U << bits[column][row] : 0U;
        }
    }
    out += {'\xE2', static_cast<char>(0xA0U | dots >> 6U), static_cast<char>(0x80U | (dots & 0x3FU))};
}

/// The strokes from `begin` up to `end`.
void append_strip(std::string& out, const Picture& picture, std::uint32_t begin, std::uint32_t end, const Cell& cell) {
    for (std::uint32_t y = 0; y < picture.height; y += cell.height) {
        for (std::uint32_t x = begin; x < end; x += cell.width) {
            if (cell.width == braille.width) {
                append_braille(out, picture, x, y);
            } else if (cell.height == half_blocks.height) {
                append_half_block(out, picture, x, y);
            } else {
                out += is_on(picture, x, y) ? '#' : '.';
            }
        }
        out += '\n';
    }
}

} // namespace

std::string to_text(const Picture& picture, std::uint32_t columns, Drawing drawing) {
    LINEFEED_ASSERT(columns >= 1);
    const Cell cell = drawing == Drawing::ascii ? one_dot : picture.width <= columns ? half_blocks : braille;
    const std::uint32_t strip = columns * cell.width;
    std::string out;
    for (std::uint32_t begin = 0; begin < picture.width; begin += strip) {
        out += begin == 0 ? "" : "\n";
        append_strip(out, picture, begin, std::min(picture.width, begin + strip), cell);
    }
    return out;
}

} // namespace linefeed::printer
