// The picture of the product: put together from details, drawn dot by dot.
#include "printer/picture.hpp"
#include "simulator/picture.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <png.h>

namespace linefeed::printer {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The rectangle of the manual, `(12 4 FF0F01080108FF0F)`, as a picture.
Picture rectangle() {
    return {4, 12, 1, std::string{"\xFF\x0F\x01\x08\x01\x08\xFF\x0F", 8}};
}

TEST(AskPicture, shouldScrollThroughAPictureThatComesInDetails) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(printer.settings()).value();
    const std::string text(200, 'W'); // 1200 strokes: three details
    ASSERT_TRUE(client->send(protocol::Message{protocol::ExternText{text}}));
    std::this_thread::sleep_for(std::chrono::milliseconds{60});
    const auto picture = ask_picture(*client);
    ASSERT_TRUE(picture) << picture.error().message;
    ASSERT_EQ(picture->width, 1200U);
    std::string expected;
    for (std::uint32_t x = 0; x < picture->width; x += simulator::max_delivered_strokes) {
        expected += simulator::draw(text, 1, x).strokes;
    }
    EXPECT_EQ(picture->strokes, expected);
    EXPECT_EQ(ask_picture(*client).value(), *picture) << "the start is where it was";
}

std::string lines_of(const protocol::WysiwygImage& image) {
    std::string frames;
    for (const auto& line : protocol::to_lines(image)) {
        protocol::append_message(frames, line);
    }
    return frames + "^0!EN\r";
}

TEST(AskPicture, shouldSwitchTheDisplayOnWhereNothingComesWithoutIt) {
    Peer printer{[on = false](std::string_view frame) mutable {
        on = on || frame == "^0!W1";
        return Peer::Reaction{frame != "^0?GW" ? "" : on ? lines_of({1, 8, 1, "x"}) : lines_of({0, 0, 0, ""})};
    }};
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_EQ(ask_picture(*client).value(), (Picture{1, 8, 1, "x"}));
    EXPECT_FALSE(client->ask<protocol::MachineStatus>(protocol::Parameter::RS));
    EXPECT_THAT(printer.heard(), HasSubstr("^0!W1\n^0=SW0\n^0?GW\n^0!W0\n^0=SW0\n"));
}

TEST(AskPicture, shouldNotMixTwoPictures) {
    Peer printer{[asked = 0](std::string_view frame) mutable {
        const bool first_half = frame == "^0?GW" && ++asked % 2 == 1;
        return Peer::Reaction{frame != "^0?GW" ? ""
                                               : lines_of({2, 8, asked < 4 ? static_cast<std::uint32_t>(asked) : 9U,
                                                           first_half ? "a" : "b"})};
    }};
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_EQ(ask_picture(*client).value(), (Picture{2, 8, 9, "ab"}));
}

TEST(AskPicture, shouldGiveUpAPictureThatAlwaysChanges) {
    Peer printer{[asked = 0U](std::string_view frame) mutable {
        return Peer::Reaction{frame == "^0?GW" ? lines_of({2, 8, ++asked, "a"}) : ""};
    }};
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_THAT(ask_picture(*client).error().message, HasSubstr("changes"));
}

TEST(AskPicture, shouldRefuseWhatIsNotPlausible) {
    Peer printer{[](std::string_view frame) { return Peer::Reaction{frame == "^0?GW" ? "^0=GWABCD\r^0!EN\r" : ""}; }};
    EXPECT_EQ(ask_picture(*PrinterClient::connect(printer.settings()).value()).error().kind, FailureKind::input);
    Peer silent{[](std::string_view) { return Peer::Reaction{}; }};
    EXPECT_EQ(ask_picture(*PrinterClient::connect(silent.settings()).value()).error().kind, FailureKind::unreachable);
}

TEST(PicturePng, shouldHoldEveryDot) {
    constexpr std::uint32_t scale = 3;
    const Picture picture = rectangle();
    const std::string bytes = to_png(picture, scale).value();
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
    EXPECT_EQ(bytes[24], 1) << "bits a pixel";
    image.format = PNG_FORMAT_GRAY;
    ASSERT_EQ(image.width, 4 * scale);
    ASSERT_EQ(image.height, 12 * scale);
    std::string pixels(PNG_IMAGE_SIZE(image), '\0');
    ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = 0; x < image.width; ++x) {
            EXPECT_EQ(pixels[y * image.width + x] == '\0', picture.dot(x / scale, y / scale)) << x << ' ' << y;
        }
    }
}

TEST(PictureText, shouldDrawEachDotInAscii) {
    EXPECT_EQ(to_text(rectangle(), 80, Drawing::ascii),
              "####\n#..#\n#..#\n#..#\n#..#\n#..#\n#..#\n#..#\n#..#\n#..#\n#..#\n####\n");
}

TEST(PictureText, shouldGoOnBelowWhereTheTerminalIsNarrow) {
    EXPECT_EQ(to_text({3, 2, 0, std::string{"\x01\x02\x03", 3}}, 2, Drawing::ascii), "#.\n.#\n\n#\n#\n");
}

TEST(PictureText, shouldDrawHalfBlocksAndWhereThatIsTooWideBraille) {
    EXPECT_EQ(to_text({4, 3, 0, std::string{"\x01\x02\x03\x04", 4}}, 4, Drawing::unicode), "▀▄█ \n   ▀\n");
    EXPECT_EQ(to_text({4, 3, 0, std::string{"\x01\x02\x03\x04", 4}}, 3, Drawing::unicode), "⠑⠣\n");
    EXPECT_EQ(to_text({4, 4, 0, std::string{"\x08\x08\x0f\x0f", 4}}, 1, Drawing::unicode), "⣀\n\n⣿\n");
}

} // namespace
} // namespace linefeed::printer
