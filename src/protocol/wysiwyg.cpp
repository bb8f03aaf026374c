// Header and strokes of the WYSIWYG picture, see wysiwyg.hpp.
#include "protocol/wysiwyg.hpp"

#include "base/assert.hpp"

#include <utility>

namespace linefeed::protocol {

namespace {

constexpr std::size_t header_bytes = 16;
constexpr std::size_t number_bytes = 4;
constexpr std::uint32_t max_height = 255;

enum class ByteOrder { little, big };

void append_number(std::string& out, std::uint32_t number) {
    for (std::size_t i = 0; i < number_bytes; ++i) {
        out.push_back(static_cast<char>(number >> 8 * i & 0xFFU));
    }
}

std::uint32_t read_number(std::string_view bytes, std::size_t at, ByteOrder order) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < number_bytes; ++i) {
        const std::size_t place = order == ByteOrder::little ? number_bytes - 1 - i : i;
        number = number << 8U | static_cast<unsigned char>(bytes[at + place]);
    }
    return number;
}

std::optional<WysiwygImage> read_image(std::string_view bytes, ByteOrder order) {
    WysiwygImage image{read_number(bytes, 0, order), read_number(bytes, number_bytes, order),
                       read_number(bytes, 2 * number_bytes, order), std::string{bytes.substr(header_bytes)}};
    const std::uint64_t delivered = read_number(bytes, 3 * number_bytes, order);
    const bool plausible = image.height <= max_height && delivered <= image.width &&
                           image.strokes.size() == delivered * image.bytes_per_stroke();
    return plausible ? std::optional{std::move(image)} : std::nullopt;
}

} // namespace

std::vector<WysiwygLine> to_lines(const WysiwygImage& image) {
    LINEFEED_ASSERT(image.height == 0 || image.strokes.size() % image.bytes_per_stroke() == 0);
    std::string bytes;
    for (const std::uint32_t number : {image.width, image.height, image.job_id, image.delivered()}) {
        append_number(bytes, number);
    }
    bytes += image.strokes;
    std::vector<WysiwygLine> lines;
    for (std::size_t at = 0; at < bytes.size(); at += max_wysiwyg_line) {
        lines.push_back({bytes.substr(at, max_wysiwyg_line)});
    }
    return lines;
}

void WysiwygAssembly::add(const WysiwygLine& line) {
    overflowed_ = overflowed_ || bytes_.size() + line.bytes.size() > max_bytes;
    if (!overflowed_) {
        bytes_ += line.bytes;
    }
}

std::optional<WysiwygImage> WysiwygAssembly::image() const {
    if (overflowed_ || bytes_.size() < header_bytes) {
        return std::nullopt;
    }
    auto image = read_image(bytes_, ByteOrder::little);
    return image ? std::move(image) : read_image(bytes_, ByteOrder::big);
}

} // namespace linefeed::protocol
