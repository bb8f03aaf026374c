// Graphics in fields: as hex, checked, or made of an image; and no name leads out of the folder.
#include "intake/graphic_fields.hpp"
#include "intake/image_file.hpp"
#include "intake/layout.hpp"
#include "intake/page_maker.hpp"
#include "intake_fixture.hpp"

#include <png.h>

namespace linefeed::intake {
namespace {

using testing::HasSubstr;

/// The rectangle of the manual.
const std::string rectangle = "(12 4 FF0F01080108FF0F)";
const std::string rectangle_pbm = "P1\n# rectangle\n4 12\n1111"
                                  "1001"
                                  "1001"
                                  "1001"
                                  "1001"
                                  "1001"
                                  "1001"
                                  "1001"
                                  "1001"
                                  "1001"
                                  "1001"
                                  "1111\n";

std::string png_of(const std::vector<png_byte>& pixels, std::uint32_t width, std::uint32_t format = PNG_FORMAT_GRAY) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = static_cast<std::uint32_t>(pixels.size() / width / PNG_IMAGE_PIXEL_CHANNELS(format));
    image.format = format;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr), 0);
    bytes.resize(size);
    return bytes;
}

std::string text_of(const Result<protocol::Graphic>& graphic) {
    std::string text;
    if (graphic) {
        protocol::append_graphic(text, *graphic);
    } else {
        text = graphic.error().message;
    }
    return text;
}

TEST(ReadImage, shouldReadEveryKindOfPbm) {
    EXPECT_EQ(text_of(read_image(rectangle_pbm, 32)), rectangle);
    EXPECT_EQ(text_of(read_image(std::string{"P4 9 2\n\x80\x80\x00\x80", 11}, 32)), "(2 9 010000000000000003)");
}

TEST(ReadImage, shouldReadBlackPixelsOfAPng) {
    EXPECT_EQ(text_of(read_image(png_of({0, 255, 255, 0, 0, 255}, 2), 32)), "(3 2 0502)");
    EXPECT_EQ(text_of(read_image(png_of({0, 255, 0, 0}, 2, PNG_FORMAT_GA), 32)), "(1 2 0100)") << "transparent = white";
}

TEST(ReadImage, shouldRefuseWhatThePrinterCannotPrint) {
    EXPECT_THAT(text_of(read_image(png_of({0, 77}, 2), 32)), HasSubstr("pixel at 1,0 is neither black nor white"));
    EXPECT_THAT(text_of(read_image("P1 1 25 1", 24)), HasSubstr("25 dots high, the printer takes 24"));
    EXPECT_THAT(text_of(read_image("P1 1025 1 1", 24)), HasSubstr("1025 dots wide"));
    EXPECT_THAT(text_of(read_image("P1 99999999999999999999 1", 24)), HasSubstr("dots wide"));
    EXPECT_THAT(text_of(read_image("P1 0 1", 24)), HasSubstr("no pixels"));
    EXPECT_THAT(text_of(read_image("P1 2", 24)), HasSubstr("neither width nor height"));
    EXPECT_THAT(text_of(read_image("P1 2 2 1012", 24)), HasSubstr("ends before"));
    EXPECT_THAT(text_of(read_image("P1 2 2 101", 24)), HasSubstr("ends before"));
    EXPECT_THAT(text_of(read_image("P4 9 2\n\x01\x01\x01", 24)), HasSubstr("ends before"));
    EXPECT_THAT(text_of(read_image("GIF89a", 24)), HasSubstr("neither PNG nor PBM"));
    EXPECT_THAT(text_of(read_image(png_of({0, 255}, 2).substr(0, 45), 24)), HasSubstr("cannot be read"));
    EXPECT_THAT(text_of(read_image("\x89PNG", 24)), HasSubstr("cannot be read"));
    EXPECT_THAT(text_of(read_image(png_of(std::vector<png_byte>(25), 1), 24)), HasSubstr("25 dots high"));
}

class GraphicFieldsTest : public IntakeTest {
protected:
    /// The field afterwards, or why not.
    std::string applied(std::string_view field, std::uint32_t max_height = 32) {
        GraphicFields graphics{{{1}, max_height, directory}};
        std::vector<std::string_view> fields{"text", field};
        const auto problem = graphics.apply(fields);
        EXPECT_EQ(fields.front(), "text");
        return problem ? problem->reason : std::string{fields[1]};
    }
};

TEST_F(GraphicFieldsTest, shouldTakeHexAsItIsButChecked) {
    EXPECT_EQ(applied(rectangle), rectangle);
    EXPECT_EQ(applied(""), "");
    EXPECT_THAT(applied("(12 4 FF0F)"), HasSubstr("no graphic"));
    EXPECT_THAT(applied("(33 1 0000000000)"), HasSubstr("no graphic"));
    EXPECT_THAT(applied("(25 1 00000000)", 24), HasSubstr("25 dots high, the printer takes 24"));
}

TEST_F(GraphicFieldsTest, shouldMakeAGraphicOfAnImage) {
    std::filesystem::create_directory(directory / "sub");
    write(rectangle_pbm, "sub/a.pbm");
    EXPECT_EQ(applied("sub/a.pbm"), rectangle);
    EXPECT_EQ(applied("./sub/./a.pbm"), rectangle);
    EXPECT_THAT(applied("none.pbm"), HasSubstr("there is no such file"));
    EXPECT_THAT(applied("none/a.pbm"), HasSubstr("No such file"));
    write(std::string(max_image_bytes + 1, 'x'), "big.png");
    EXPECT_THAT(applied("big.png"), HasSubstr("too large"));
    write("x", "bad.png");
    EXPECT_THAT(applied("bad.png"), HasSubstr("bad.png: the image is neither"));
}

TEST_F(GraphicFieldsTest, shouldNotLeaveItsFolder) {
    write(rectangle_pbm, "a.pbm");
    std::filesystem::create_symlink(directory / "a.pbm", directory / "link.pbm");
    std::filesystem::create_directory_symlink(directory, directory / "loop");
    EXPECT_THAT(applied("../" + directory.filename().string() + "/a.pbm"), HasSubstr("with .."));
    EXPECT_THAT(applied((directory / "a.pbm").string()), HasSubstr("absolute"));
    EXPECT_THAT(applied("link.pbm"), HasSubstr("symbolic link"));
    EXPECT_THAT(applied("loop/a.pbm"), HasSubstr("loop/a.pbm"));
    EXPECT_THAT(applied("a.pbm/"), HasSubstr("no name"));
    EXPECT_THAT(applied(std::string_view{"a.pbm\0x", 7}), HasSubstr("no name"));
    GraphicFields nowhere{{{0}, 32, {}}};
    std::vector<std::string_view> fields{"a.pbm"};
    EXPECT_THAT(nowhere.apply(fields)->reason, HasSubstr("graphics_folder"));
}

TEST_F(GraphicFieldsTest, shouldMakeRecordsAndReportRows) {
    write(rectangle_pbm, "a.pbm");
    Layout layout;
    layout.graphics = {"logo"};
    layout.encodings = {"unicode-hex"};
    layout.skip_bad = true;
    auto opened = open_with_layout(write("name,logo\nA,a.pbm\nB,(8 1 F)\nC,(8 1 0F)\n"), layout);
    ASSERT_TRUE(opened) << opened.error().message;
    PageMaker maker{*opened->rows, RecordNumber{}, opened->options};
    RecordPage page;
    ASSERT_TRUE(maker.next(page).value());
    EXPECT_EQ(page.frames, "^0=MR1\t0041\t" + rectangle + "\r^0=MR2\t0043\t(8 1 0F)\r");
    ASSERT_EQ(maker.report().reported.size(), 1U);
    EXPECT_EQ(maker.report().reported[0].line, 3U);
    EXPECT_EQ(maker.report().reported[0].column, "logo");
    layout.graphics = {"none"};
    EXPECT_EQ(open_with_layout(directory / "source.csv", layout).error().kind, FailureKind::usage);
}

TEST_F(GraphicFieldsTest, shouldBePartOfTheLayout) {
    Layout layout;
    layout.graphics = {"logo"};
    layout.graphics_folder = "/srv/logos";
    EXPECT_THAT(canonical_json(layout), HasSubstr(R"("graphics":["logo"],"graphics_folder":"/srv/logos")"));
}

} // namespace
} // namespace linefeed::intake
