// Graphics of fields, dot by dot and as text; and bytes as nibbles.
#include "protocol/graphic.hpp"
#include "protocol/nibbles.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

TEST(Graphic, shouldBeBuiltDotByDot) {
    Graphic rectangle = Graphic::blank(12, 4);
    for (std::uint32_t x = 0; x < 4; ++x) {
        for (std::uint32_t y = 0; y < 12; ++y) {
            if (x == 0 || x == 3 || y == 0 || y == 11) {
                rectangle.set(x, y);
            }
        }
    }
    std::string out = ">";
    append_graphic(out, rectangle);
    EXPECT_EQ(out, ">(12 4 FF0F01080108FF0F)"); // the manual's
    EXPECT_EQ(parse_graphic("(12 4 ff0f01080108ff0f)"), rectangle);
}

TEST(Graphic, shouldTakeHeightsFrom1To32) {
    EXPECT_TRUE(parse_graphic("(1 1 01)"));
    EXPECT_TRUE(parse_graphic("(32 1 FFFFFFFF)"));
    EXPECT_FALSE(parse_graphic("(0 1 )"));
    EXPECT_FALSE(parse_graphic("(33 1 FFFFFFFFFF)"));
    EXPECT_FALSE(parse_graphic("(8 0 )"));
}

TEST(Graphic, shouldRefuseWhatIsNoGraphic) {
    for (const char* const text :
         {"", "(", "()", "8 3 FF81FF", "(8 3 FF81FF", "8 3 FF81FF)", "(8 3 FF81F)", "(8 3 FF81)", "(8 3 FF81FFFF)",
          "(8 3 FF81GG)", "(8 3 GGFF81)", "(8  3 FF81FF)", "(8 3FF81FF)", "(83FF81FF)", "(-8 3 FF81FF)",
          "(8 4294967295 FF)", "( 8 3 FF81FF)", "(8 3 FF81FF) "}) {
        EXPECT_FALSE(parse_graphic(text)) << text;
    }
}

TEST(GraphicDeathTest, shouldAbortBeyondThePicture) {
    Graphic graphic = Graphic::blank(8, 3);
    EXPECT_DEATH(static_cast<void>(graphic.dot(3, 0)), "width");
    EXPECT_DEATH(graphic.set(0, 8), "height");
    EXPECT_DEATH(static_cast<void>(Graphic::blank(33, 1)), "max_graphic_height");
}

TEST(Nibbles, shouldPutTheHighOneFirst) {
    std::string out = ">";
    append_nibbles(out, std::string_view{"\x00\x0F\xF0\xFF\x12", 5});
    EXPECT_EQ(out, ">AAAPPAPPBC");
    EXPECT_EQ(read_nibbles("AAAPPAPPBC"), (std::string{"\x00\x0F\xF0\xFF\x12", 5}));
    EXPECT_EQ(read_nibbles(""), "");
}

TEST(Nibbles, shouldRefuseOtherCharactersAndOddLengths) {
    for (const char* const text : {"A", "AAA", "AQ", "QA", "a.", "@A", "A@",
                                   "\xFF"
                                   "A"}) {
        EXPECT_EQ(read_nibbles(text), std::nullopt) << text;
    }
}

} // namespace
} // namespace linefeed::protocol
