// The WYSIWYG picture: lines of 30 bytes, header, plausibility.
#include "protocol/nibbles.hpp"
#include "protocol/wysiwyg.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

std::optional<WysiwygImage> put_together(const std::vector<WysiwygLine>& lines) {
    WysiwygAssembly assembly;
    for (const WysiwygLine& line : lines) {
        assembly.add(line);
    }
    return assembly.image();
}

std::optional<WysiwygImage> of_bytes(const std::string& bytes) {
    return put_together({{bytes}});
}

TEST(Wysiwyg, shouldTravelInLinesOf30Bytes) {
    const WysiwygImage image{100, 12, 7, std::string(40, '\x5A')};
    const auto lines = to_lines(image);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].bytes.size(), 30U);
    EXPECT_EQ(lines[1].bytes.size(), 26U);
    std::string header;
    append_nibbles(header, lines[0].bytes.substr(0, 16));
    EXPECT_EQ(header, "GEAAAAAA"
                      "AMAAAAAA"
                      "AHAAAAAA"
                      "BEAAAAAA"); // 100, 12, 7, 20 strokes
    EXPECT_EQ(put_together(lines), image);
}

TEST(Wysiwyg, shouldReadTheOtherByteOrderWhereOnlyItIsPlausible) {
    const std::string header{"\0\0\0\x02\0\0\0\x08\0\0\0\x01\0\0\0\x02", 16};
    const auto image = of_bytes(header + "\x0F\xF0");
    ASSERT_TRUE(image);
    EXPECT_EQ(*image, (WysiwygImage{2, 8, 1, "\x0F\xF0"}));
}

TEST(Wysiwyg, shouldRefuseWhatIsNotPlausible) {
    const auto header = [](char width, char height, char strokes) {
        return std::string{width, 0, 0, 0, height, 0, 0, 0, 1, 0, 0, 0, strokes, 0, 0, 0};
    };
    EXPECT_TRUE(of_bytes(header(2, 8, 2) + "ab"));
    EXPECT_TRUE(of_bytes(header(0, 0, 0)));
    EXPECT_FALSE(of_bytes(header(2, 8, 2) + "a")) << "a byte is missing";
    EXPECT_FALSE(of_bytes(header(2, 8, 2) + "abc")) << "a byte too many";
    EXPECT_FALSE(of_bytes(header(1, 8, 2) + "ab")) << "more strokes than the picture is wide";
    EXPECT_FALSE(of_bytes(header(2, 8, 2).substr(0, 15))) << "no whole header";
    EXPECT_FALSE(of_bytes("")) << "nothing came";
    EXPECT_FALSE(of_bytes(std::string{"\x02\0\0\0\0\x01\0\0\x01\0\0\0\x02\0\0\0", 16} + std::string(64, 'x')))
        << "256 dots high";
}

TEST(Wysiwyg, shouldNotGrowWithoutEnd) {
    WysiwygAssembly assembly;
    for (std::size_t bytes = 0; bytes <= WysiwygAssembly::max_bytes; bytes += max_wysiwyg_line) {
        assembly.add({std::string(max_wysiwyg_line, '\0')});
    }
    EXPECT_FALSE(assembly.image());
}

} // namespace
} // namespace linefeed::protocol
