// Strokes of texts and graphics, see picture.hpp.
#include "simulator/picture.hpp"

#include "protocol/graphic.hpp"
#include "simulator/dot_font.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace linefeed::simulator {
namespace {

constexpr std::size_t field_distance = 3; ///< strokes between fields
constexpr std::uint32_t bits_per_byte = 8;

/// Strokes with room for the highest graphic, bit 0 on top.
using Strokes = std::vector<std::uint32_t>;

void append_character(Strokes& strokes, char c) {
    const auto place = static_cast<std::size_t>(static_cast<unsigned char>(c - dot_font::first_character));
    const auto& shape = place < dot_font::characters ? dot_font::strokes[place] : dot_font::box;
    strokes.insert(strokes.end(), shape.begin(), shape.end());
    strokes.push_back(0);
}

void append_graphic(Strokes& strokes, const protocol::Graphic& graphic) {
    for (std::uint32_t x = 0; x < graphic.width; ++x) {
        std::uint32_t stroke = 0;
        for (std::uint32_t y = 0; y < graphic.height; ++y) {
            stroke |= graphic.dot(x, y) ? 1U << y : 0U;
        }
        strokes.push_back(stroke);
    }
}

/// A text with graphics anywhere in it. Returns how high it is.
std::uint32_t append_field(Strokes& strokes, std::string_view field) {
    std::uint32_t height = dot_font::height;
    while (!field.empty()) {
        const std::size_t end = field.front() == '(' ? field.find(')') : std::string_view::npos;
        const auto graphic =
            end == std::string_view::npos ? std::nullopt : protocol::parse_graphic(field.substr(0, end + 1));
        if (graphic) {
            height = std::max(height, graphic->height);
            append_graphic(strokes, *graphic);
        } else {
            append_character(strokes, field.front());
        }
        field.remove_prefix(graphic ? end + 1 : 1);
    }
    return height;
}

} // namespace

protocol::WysiwygImage draw(std::string_view text, std::uint32_t job_id, std::uint32_t first) {
    Strokes strokes;
    std::uint32_t height = dot_font::height;
    std::optional<std::string_view> rest = text;
    while (rest) {
        const std::size_t end = rest->find('\t');
        const std::string_view field = rest->substr(0, end);
        rest = end == std::string_view::npos ? std::nullopt : std::optional{rest->substr(end + 1)};
        height = std::max(height, append_field(strokes, field));
        if (rest) {
            strokes.insert(strokes.end(), field_distance, 0);
        }
    }
    const auto width = static_cast<std::uint32_t>(strokes.size());
    protocol::WysiwygImage image{width, height, job_id, {}};
    const std::uint32_t begin = std::min(first, width);
    const std::uint32_t end = std::min(width, begin + max_delivered_strokes);
    for (std::uint32_t x = begin; x < end; ++x) {
        for (std::uint32_t byte = 0; byte < image.bytes_per_stroke(); ++byte) {
            image.strokes.push_back(static_cast<char>(strokes[x] >> byte * bits_per_byte & 0xFFU));
        }
    }
    return image;
}

} // namespace linefeed::simulator
