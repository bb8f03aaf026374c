// A graphic in a field of a mail record or in an extern text: `(height width hex)` (protocol, section 5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// Up to so many dots high; firmware profiles may have less.
inline constexpr std::uint32_t max_graphic_height = 32;

/// A 1-bit picture, stroke by stroke (column by column), ceil(height / 8) bytes a stroke, bit 0 of the first byte being
/// the dot Y.1.
struct Graphic {
    std::uint32_t height = 0; ///< dots, 1…max_graphic_height
    std::uint32_t width = 0;  ///< strokes, 1…
    std::string bytes{};      ///< bytes_per_stroke() × width

    [[nodiscard]] std::size_t bytes_per_stroke() const { return (height + 7) / 8; }
    /// Whether the dot is on; x from 0 (first stroke), y from 0 (dot Y.1). Precondition: within the picture.
    [[nodiscard]] bool dot(std::uint32_t x, std::uint32_t y) const;
    /// Precondition: as above.
    void set(std::uint32_t x, std::uint32_t y);
    /// A picture without a dot. Precondition: a height of 1…max_graphic_height, a width of 1 or more.
    [[nodiscard]] static Graphic blank(std::uint32_t height, std::uint32_t width);

    friend bool operator==(const Graphic&, const Graphic&) = default;
};

/// Appends `(height width hex)`, the digits in upper case.
void append_graphic(std::string& out, const Graphic& graphic);

/// Reads it: the whole of `text`, with exactly the digits that height and width demand, in upper or lower case.
[[nodiscard]] std::optional<Graphic> parse_graphic(std::string_view text);

} // namespace linefeed::protocol
