#include "intake/image_file.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <optional>
#include <png.h>
#include <string>
#include <vector>

namespace linefeed::intake {

using protocol::Graphic;

namespace {

constexpr unsigned bits_per_byte = 8;

Failure refused(std::string why) {
    return {FailureKind::input, std::move(why)};
}

Result<Graphic> blank_of(std::uint64_t width, std::uint64_t height, std::uint32_t max_height) {
    if (width == 0 || height == 0) {
        return refused("the image has no pixels");
    }
    if (height > max_height) {
        return refused("the image is " + std::to_string(height) + " dots high, the printer takes " +
                       std::to_string(max_height));
    }
    if (width > max_image_width) {
        return refused("the image is " + std::to_string(width) + " dots wide, a record holds no more than " +
                       std::to_string(max_image_width));
    }
    return Graphic::blank(static_cast<std::uint32_t>(height), static_cast<std::uint32_t>(width));
}

Result<Graphic> read_png(std::string_view bytes, std::uint32_t max_height) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    const auto damaged = [&image] {
        std::string why = std::string{"the PNG cannot be read: "} + image.message;
        png_image_free(&image);
        return refused(std::move(why));
    };
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
        return damaged();
    }
    auto graphic = blank_of(image.width, image.height, max_height);
    if (!graphic) {
        png_image_free(&image);
        return graphic;
    }
    constexpr png_byte black = 0;
    constexpr png_byte white = 255;
    constexpr png_color background{white, white, white};
    image.format = PNG_FORMAT_GRAY;
    std::vector<png_byte> pixels(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, &background, pixels.data(), 0, nullptr) == 0) {
        return damaged();
    }
    for (std::uint32_t y = 0; y < graphic->height; ++y) {
        for (std::uint32_t x = 0; x < graphic->width; ++x) {
            const png_byte pixel = pixels[std::size_t{y} * graphic->width + x];
            if (pixel != black && pixel != white) {
                return refused("the pixel at " + std::to_string(x) + ',' + std::to_string(y) +
                               " is neither black nor white: the printer knows dots only");
            }
            if (pixel == black) {
                graphic->set(x, y);
            }
        }
    }
    return graphic;
}

/// Netpbm's format: numbers between white space and comments, then pixels, 1 = black.
class PbmReader {
public:
    explicit PbmReader(std::string_view bytes)
        : rest_(bytes) {}

    Result<Graphic> read(std::uint32_t max_height) {
        const bool plain = rest_.starts_with("P1");
        rest_.remove_prefix(2);
        const auto width = number();
        const auto height = width ? number() : std::nullopt;
        if (!height) {
            return refused("the PBM says neither width nor height");
        }
        auto graphic = blank_of(*width, *height, max_height);
        if (!graphic) {
            return graphic;
        }
        const bool whole = plain ? plain_pixels(*graphic) : packed_pixels(*graphic);
        return whole ? graphic : refused("the PBM ends before its last pixel, or has something else among them");
    }

private:
    void skip_space() {
        while (!rest_.empty()) {
            if (rest_.front() == '#') {
                rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size()));
            } else if (std::string_view{" \t\r\n\v\f"}.find(rest_.front()) != std::string_view::npos) {
                rest_.remove_prefix(1);
            } else {
                return;
            }
        }
    }
    std::optional<std::uint64_t> number() {
        constexpr std::uint64_t absurd = 1'000'000'000;
        skip_space();
        std::optional<std::uint64_t> value;
        while (!rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9') {
            value = std::min(value.value_or(0) * 10 + static_cast<unsigned>(rest_.front() - '0'), absurd);
            rest_.remove_prefix(1);
        }
        return value;
    }
    bool plain_pixels(Graphic& graphic) {
        for (std::uint32_t y = 0; y < graphic.height; ++y) {
            for (std::uint32_t x = 0; x < graphic.width; ++x) {
                skip_space();
                if (rest_.empty() || (rest_.front() != '0' && rest_.front() != '1')) {
                    return false;
                }
                if (rest_.front() == '1') {
                    graphic.set(x, y);
                }
                rest_.remove_prefix(1);
            }
        }
        return true;
    }
    /// One white space, then rows of whole bytes, the highest bit first.
    bool packed_pixels(Graphic& graphic) {
        const std::size_t row_bytes = (graphic.width + bits_per_byte - 1) / bits_per_byte;
        if (rest_.size() < 1 + row_bytes * graphic.height) {
            return false;
        }
        rest_.remove_prefix(1);
        for (std::uint32_t y = 0; y < graphic.height; ++y) {
            for (std::uint32_t x = 0; x < graphic.width; ++x) {
                const auto byte = static_cast<unsigned char>(rest_[y * row_bytes + x / bits_per_byte]);
                if ((byte >> (bits_per_byte - 1 - x % bits_per_byte) & 1U) != 0) {
                    graphic.set(x, y);
                }
            }
        }
        return true;
    }

    std::string_view rest_;
};

} // namespace

Result<Graphic> read_image(std::string_view bytes, std::uint32_t max_height) {
    LINEFEED_ASSERT(max_height <= protocol::max_graphic_height);
    if (bytes.starts_with("\x89PNG")) {
        return read_png(bytes, max_height);
    }
    if (bytes.starts_with("P1") || bytes.starts_with("P4")) {
        return PbmReader{bytes}.read(max_height);
    }
    return refused("the image is neither PNG nor PBM");
}

} // namespace linefeed::intake
