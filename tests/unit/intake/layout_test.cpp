#include "intake/layout.hpp"
#include "intake_fixture.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace linefeed::intake {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class LayoutTest : public IntakeTest {
protected:
    /// As the drop folder opens it.
    Result<OpenedSource> open_inside(const std::string& name, const Layout& layout = {}) {
        const int folder = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        auto input = FileInput::open_in(folder, name, directory / name);
        ::close(folder);
        return input ? open_with_layout(std::move(*input), layout) : Result<OpenedSource>{input.error()};
    }
};

/// Jobs of earlier versions are found by it.
TEST_F(LayoutTest, shouldHaveOneCanonicalForm) {
    EXPECT_EQ(canonical_json({}), R"({"columns":[],"encodings":[],"profile":"jet3up","header":true,"skip_bad":false,)"
                                  R"("mirrored":false})");
    Layout layout;
    layout.columns = {"na\"me", "2"};
    layout.table = "t";
    layout.query = "SELECT 'ä'";
    layout.delimiter = '\t';
    layout.header = false;
    layout.skip_bad = true;
    layout.encodings = {"latin1"};
    layout.profile = protocol::profile_by_name("jet2neo-v71").value();
    layout.base = 7;
    layout.properties = {true, protocol::Orientation::degrees_90};
    EXPECT_EQ(
        canonical_json(layout),
        R"({"columns":["na\"me","2"],"encodings":["latin1"],"profile":"jet2neo-v71","table":"t",)"
        R"("query":"SELECT 'ä'","delimiter":"\t","header":false,"skip_bad":true,"mirrored":true,"orientation":1})");
}

TEST_F(LayoutTest, shouldTurnNoRecordsForAFirmwareThatCannot) {
    const auto file = write("serial\n1\n");
    Layout layout;
    layout.profile = protocol::parse_profile("jet3up,record-properties=off").value();
    EXPECT_TRUE(open_with_layout(file, layout));
    layout.properties.mirrored = true;
    EXPECT_THAT(open_with_layout(file, layout).error().message,
                HasSubstr("(jet3up,record-properties=off) turns or mirrors no single record"));
    EXPECT_THAT(canonical_json(layout), HasSubstr(R"("profile":"jet3up,record-properties=off")"));
}

TEST_F(LayoutTest, shouldKnowTheSameWayWhateverTheProfile) {
    Layout layout;
    layout.columns = {"\"profile\":\"x"};
    const std::string one = canonical_json(layout);
    layout.profile = protocol::profile_by_name("auto").value();
    const std::string other = canonical_json(layout);
    EXPECT_NE(one, other);
    EXPECT_TRUE(is_same_way(one, other));
    EXPECT_TRUE(is_same_way("{}", "{}"));
    layout.columns = {"\"profile\":\"y"};
    EXPECT_FALSE(is_same_way(one, canonical_json(layout)));
    EXPECT_FALSE(reads_images(one));
    layout.graphics = {"logo"};
    EXPECT_TRUE(reads_images(canonical_json(layout)));
}

TEST_F(LayoutTest, shouldGiveEachColumnItsEncoding) {
    Layout layout;
    layout.encodings = {"windows-1252", "b=unicode-hex"};
    const auto opened = open_with_layout(write("a,b\n1,2\n"), layout);
    ASSERT_TRUE(opened.has_value());
    EXPECT_THAT(opened->options.charsets, ElementsAre(protocol::Charset::windows_1252, protocol::Charset::unicode_hex));
    layout.encodings = {"c=latin1"};
    EXPECT_THAT(open_with_layout(write("a,b\n1,2\n"), layout).error().message, HasSubstr("no column \"c\""));
    layout.encodings = {"utf-7"};
    EXPECT_EQ(open_with_layout(write("a,b\n1,2\n"), layout).error().kind, FailureKind::usage);
}

TEST_F(LayoutTest, shouldReadAFileThatIsOpenAlready) {
    write("a\n1\n", "x.csv");
    auto opened = open_inside("x.csv");
    ASSERT_TRUE(opened.has_value());
    EXPECT_THAT(rows_of(*opened->rows), ElementsAre("2: 1"));
    database("CREATE TABLE t (a TEXT); INSERT INTO t VALUES ('7')");
    opened = open_inside("db.sqlite");
    ASSERT_TRUE(opened.has_value());
    EXPECT_THAT(rows_of(*opened->rows), ElementsAre("1: 7"));
}

TEST_F(LayoutTest, shouldNotFollowSymbolicLinksInAFolder) {
    std::filesystem::create_symlink(write("a\n1\n"), directory / "link.csv");
    const auto opened = open_inside("link.csv");
    ASSERT_FALSE(opened.has_value());
    EXPECT_THAT(opened.error().message, HasSubstr("symbolic link"));
    // A database is opened by its path: not even a folder on the way may be a link.
    std::filesystem::create_directory_symlink(directory, directory / "way");
    database("CREATE TABLE t (a TEXT); INSERT INTO t VALUES ('7')");
    auto input = FileInput::open(directory / "way" / "db.sqlite");
    ASSERT_TRUE(input.has_value());
    EXPECT_FALSE(open_with_layout(std::move(*input), {}).has_value());
    EXPECT_TRUE(open_with_layout(directory / "way" / "db.sqlite", {}).has_value());
}

TEST_F(LayoutTest, shouldReadAFileTwice) {
    auto input = FileInput::open(write("abc"));
    std::array<char, 8> bytes{};
    EXPECT_EQ(input->read(bytes).value(), 3U);
    EXPECT_EQ(input->read(bytes).value(), 0U);
    ASSERT_TRUE(input->rewind().has_value());
    EXPECT_EQ(input->read(bytes).value(), 3U);
    EXPECT_EQ(input->status()->st_size, 3);
}

} // namespace
} // namespace linefeed::intake
