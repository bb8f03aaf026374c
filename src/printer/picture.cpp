// From `?GW` to the whole picture, see picture.hpp.
#include "printer/picture.hpp"

#include "base/assert.hpp"
#include "printer/exchange.hpp"

#include <optional>
#include <utility>

namespace linefeed::printer {

using protocol::Message;
using protocol::WysiwygImage;
using Heard = PrinterClient::Heard;

namespace {

constexpr std::uint32_t bits_per_byte = 8;

/// One detail from stroke `x` on.
Result<WysiwygImage> ask_detail(PrinterClient& printer, std::uint32_t x) {
    protocol::WysiwygAssembly assembly;
    const std::string frames = printer.frame_of(protocol::WysiwygStart{x}) +
                               printer.frame_of(protocol::InquiryMessage{protocol::Parameter::GW, {}});
    const bool complete = printer.converse(frames, [&assembly](const Message& message, std::string_view /*raw*/) {
        if (const auto* const line = std::get_if<protocol::WysiwygLine>(&message)) {
            assembly.add(*line);
            return Heard::more;
        }
        const auto* const action = std::get_if<protocol::ActionMessage>(&message);
        return action != nullptr && action->action == protocol::Action::end_of_data ? Heard::done : Heard::ignored;
    });
    if (!complete) {
        return no_answer(printer, protocol::Parameter::GW);
    }
    auto image = assembly.image();
    if (!image || image->width == 0 || image->height == 0 || image->delivered() == 0) {
        return Failure{FailureKind::input,
                       printer.settings().address + ": the printer's picture is not plausible, or empty"};
    }
    return *std::move(image);
}

bool same_picture(const Picture& picture, const WysiwygImage& image) {
    return picture.width == image.width && picture.height == image.height && picture.job_id == image.job_id;
}

/// std::nullopt: it has changed meanwhile.
Result<std::optional<Picture>> ask_whole(PrinterClient& printer) {
    std::optional<Picture> picture;
    for (std::uint32_t x = 0; !picture || x < picture->width;) {
        const auto detail = ask_detail(printer, x);
        if (!detail) {
            return detail.error();
        }
        if (!picture) {
            picture = Picture{detail->width, detail->height, detail->job_id, {}};
        } else if (!same_picture(*picture, *detail) || detail->delivered() > picture->width - x) {
            return std::optional<Picture>{};
        }
        picture->strokes += detail->strokes;
        x += detail->delivered();
    }
    return picture;
}

Result<Picture> ask_until_it_stands(PrinterClient& printer) {
    constexpr int attempts = 5;
    for (int i = 0; i < attempts; ++i) {
        auto whole = ask_whole(printer);
        if (!whole) {
            return whole.error();
        }
        if (*whole) {
            return **std::move(whole);
        }
    }
    return Failure{FailureKind::input, printer.settings().address +
                                           ": the picture changes while it is read; ask again between two products"};
}

} // namespace

bool Picture::dot(std::uint32_t x, std::uint32_t y) const {
    LINEFEED_ASSERT(x < width && y < height);
    const std::size_t bytes_per_stroke = (height + bits_per_byte - 1) / bits_per_byte;
    const auto byte = static_cast<unsigned char>(strokes[x * bytes_per_stroke + y / bits_per_byte]);
    return (byte >> y % bits_per_byte & 1U) != 0;
}

Result<Picture> ask_picture(PrinterClient& printer) {
    auto picture = ask_until_it_stands(printer);
    if (!picture && printer.open()) {
        printer.send(protocol::Action::display_on);
        picture = ask_until_it_stands(printer);
        printer.send(protocol::Action::display_off);
    }
    printer.send(Message{protocol::WysiwygStart{0}});
    return picture;
}

} // namespace linefeed::printer
