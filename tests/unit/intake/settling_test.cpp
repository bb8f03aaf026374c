#include "intake/settling.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::intake {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Kind = SettleDecision::Kind;

class SettlingTest : public testing::Test {
protected:
    SettleDecision decide() { return file.decide(rule, look, mark, Instant{time}); }
    Kind kind() { return decide().kind; }

    SettlingFile file;
    SettleRule rule;
    FileLook look{.size_bytes = 10, .changed_ns = 100};
    std::optional<FileLook> mark;
    Duration time = 1h;
};

TEST_F(SettlingTest, shouldTakeAFileThatIsQuietForTheTime) {
    const auto first = decide();
    EXPECT_EQ(first.kind, Kind::wait);
    EXPECT_EQ(first.until, Instant{1h + 2s});
    time += 1999ms;
    EXPECT_EQ(kind(), Kind::wait);
    time += 1ms;
    EXPECT_EQ(kind(), Kind::ready);
}

TEST_F(SettlingTest, shouldCountAnewAtEveryChange) {
    for (int change = 0; change < 5; ++change) {
        (change % 2 == 0 ? look.size_bytes : look.inode) += 1;
        EXPECT_EQ(decide().until, Instant{time + 2s}) << change;
        time += 1900ms;
    }
    time += 100ms;
    EXPECT_EQ(kind(), Kind::ready);
}

TEST_F(SettlingTest, shouldGiveAnEmptyFileMoreTime) {
    look.size_bytes = 0;
    EXPECT_EQ(decide().until, Instant{time + 10s});
    time += 9s;
    EXPECT_EQ(kind(), Kind::wait);
    time += 1s;
    EXPECT_EQ(kind(), Kind::ready);
}

TEST_F(SettlingTest, shouldHoldAFileThatIsOpenForWritingHoweverQuiet) {
    file.created();
    file.modified();
    time += 10h;
    EXPECT_EQ(kind(), Kind::hold);
    ++look.size_bytes; // the last of it
    file.closed();
    EXPECT_EQ(decide().until, Instant{time + 2s});
    time += 2s;
    EXPECT_EQ(kind(), Kind::ready);
}

TEST_F(SettlingTest, shouldHoldAnEmptyFileThatItsMakerHasNotClosed) {
    look.size_bytes = 0;
    file.created();
    time += 10h;
    EXPECT_THAT(decide().why, HasSubstr("not closed"));
    look.size_bytes = 1; // made by a link: what was complete elsewhere has no writer here
    EXPECT_EQ(kind(), Kind::wait);
    look.size_bytes = 0;
    file.closed();
    EXPECT_EQ(kind(), Kind::wait);
    file.created();
    file.events_lost();
    EXPECT_EQ(kind(), Kind::wait) << "perhaps it was closed meanwhile";
}

TEST_F(SettlingTest, shouldNotTrustTheQuietBeforeEventsWereLost) {
    decide();
    file.modified();
    time += 1h;
    file.events_lost();
    EXPECT_EQ(decide().until, Instant{time + 2s});
}

TEST_F(SettlingTest, shouldTakeARenamedFileAtOnceIfThatIsTheRule) {
    rule.by = SettleBy::renaming;
    EXPECT_EQ(kind(), Kind::ready);
    file.created();
    EXPECT_EQ(kind(), Kind::wait) << "this one was made in place";
    file.moved_in();
    EXPECT_EQ(kind(), Kind::ready);
    file.modified();
    EXPECT_EQ(kind(), Kind::hold);
}

TEST_F(SettlingTest, shouldWaitForAMarkThatIsNotOlderThanTheFile) {
    rule.by = SettleBy::done_mark;
    EXPECT_THAT(decide().why, HasSubstr("missing"));
    mark = FileLook{.changed_ns = 99};
    EXPECT_THAT(decide().why, HasSubstr("older"));
    mark->changed_ns = 100;
    EXPECT_EQ(kind(), Kind::ready);
    mark->kind = FileKind::symbolic_link;
    EXPECT_EQ(kind(), Kind::hold);
}

TEST_F(SettlingTest, shouldTakeAMarkedFileAtOnceUnderAnyRule) {
    mark = FileLook{.changed_ns = 200};
    EXPECT_EQ(kind(), Kind::ready);
    file.modified();
    EXPECT_EQ(kind(), Kind::hold) << "it is written on";
}

TEST_F(SettlingTest, shouldHoldDirectoriesAndFilesWithSeveralNames) {
    look.names = 2;
    mark = FileLook{.changed_ns = 200};
    EXPECT_THAT(decide().why, HasSubstr("2 names"));
    look.kind = FileKind::directory;
    EXPECT_THAT(decide().why, HasSubstr("directory"));
}

TEST_F(SettlingTest, shouldTakeWhatIsNoFileAtOnceToRefuseIt) {
    for (const FileKind what : {FileKind::symbolic_link, FileKind::other}) {
        look.kind = what;
        EXPECT_EQ(kind(), Kind::ready);
    }
}

TEST(SettleRule, shouldBeRead) {
    EXPECT_EQ(parse_settle_rule("rename")->by, SettleBy::renaming);
    EXPECT_EQ(parse_settle_rule("done")->by, SettleBy::done_mark);
    EXPECT_EQ(parse_settle_rule("quiet")->quiet, Duration{2s});
    EXPECT_EQ(parse_settle_rule("quiet=500ms")->quiet, Duration{500ms});
    EXPECT_EQ(parse_settle_rule("quiet=3s")->quiet, Duration{3s});
    EXPECT_EQ(parse_settle_rule("quiet=1440min")->quiet, Duration{24h});
    for (const char* const wrong : {"", "quick", "quiet=", "quiet=2", "quiet=s", "quiet=0s", "quiet=-1s", "quiet=2h",
                                    "quiet=1441min", "quiet=99999999999999999999ms", "quiet=1 s", "done=1s"}) {
        EXPECT_FALSE(parse_settle_rule(wrong)) << wrong;
    }
}

} // namespace
} // namespace linefeed::intake
