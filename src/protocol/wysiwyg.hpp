// The picture behind `?GW` (protocol, section 4, GW): a header of 16 bytes and the strokes, sent as lines of up to 60
// nibbles that `^0!EN` ends. The manual gives neither byte order nor packing of the strokes: they are taken as
// little-endian and packed like graphics (graphic.hpp), and held against the header's plausibility; a picture that is
// plausible only with its header in the other byte order is read so.
#pragma once

#include "protocol/print_messages.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::protocol {

/// What the product will look like, or a detail of it.
struct WysiwygImage {
    std::uint32_t width = 0;  ///< strokes of the whole picture
    std::uint32_t height = 0; ///< dots
    std::uint32_t job_id = 0; ///< with external job select, its number
    std::string strokes{};    ///< those delivered, ceil(height / 8) bytes each

    [[nodiscard]] std::size_t bytes_per_stroke() const { return (height + 7) / 8; }
    /// How many strokes were delivered.
    [[nodiscard]] std::uint32_t delivered() const {
        return height == 0 ? 0 : static_cast<std::uint32_t>(strokes.size() / bytes_per_stroke());
    }
    friend bool operator==(const WysiwygImage&, const WysiwygImage&) = default;
};

/// The lines in which the printer sends the picture. Precondition: whole strokes.
[[nodiscard]] std::vector<WysiwygLine> to_lines(const WysiwygImage& image);

/// Flow: add() each line, image() at `^0!EN`.
class WysiwygAssembly {
public:
    /// A printer that sends more is not believed: a stroke is 4 bytes, a metre at 0.1 mm a stroke 40 000 bytes.
    static constexpr std::size_t max_bytes = std::size_t{1} << 20U;

    void add(const WysiwygLine& line);
    /// The picture, or std::nullopt if the header is not plausible: a height above 255 dots, more strokes than the
    /// width, or another number of bytes than the strokes need.
    [[nodiscard]] std::optional<WysiwygImage> image() const;

private:
    std::string bytes_;
    bool overflowed_ = false;
};

} // namespace linefeed::protocol
