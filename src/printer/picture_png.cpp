// Pictures as PNG, see picture.hpp. Two colours make libpng write one bit a pixel.
#include "base/assert.hpp"
#include "printer/picture.hpp"

#include <array>
#include <png.h>
#include <vector>

namespace linefeed::printer {

namespace {

constexpr std::uint32_t max_scale = 32;
constexpr std::array<png_byte, 6> white_and_black{255, 255, 255, 0, 0, 0};

} // namespace

Result<std::string> to_png(const Picture& picture, std::uint32_t scale) {
    LINEFEED_ASSERT(picture.width > 0 && picture.height > 0 && scale >= 1 && scale <= max_scale);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width * scale;
    image.height = picture.height * scale;
    image.format = PNG_FORMAT_RGB_COLORMAP;
    image.colormap_entries = 2;
    std::vector<png_byte> pixels(std::size_t{image.width} * image.height);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = 0; x < image.width; ++x) {
            pixels[std::size_t{y} * image.width + x] = picture.dot(x / scale, y / scale) ? 1 : 0;
        }
    }
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, white_and_black.data()) == 0) {
        return Failure{FailureKind::internal, std::string{"the picture cannot be written: "} + image.message};
    }
    bytes.resize(size);
    return bytes;
}

} // namespace linefeed::printer
