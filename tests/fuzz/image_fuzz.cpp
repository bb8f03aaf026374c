// Images that are to become graphics: what is read fits a record's field, and reads the same there.
#include "base/assert.hpp"
#include "intake/image_file.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace linefeed;
    const std::string bytes(data, data + size);
    constexpr std::uint32_t max_height = 24;
    if (const auto graphic = intake::read_image(bytes, max_height)) {
        LINEFEED_ASSERT(graphic->height <= max_height && graphic->width <= intake::max_image_width);
        std::string text;
        protocol::append_graphic(text, *graphic);
        LINEFEED_ASSERT(protocol::parse_graphic(text) == *graphic);
    }
    return 0;
}
