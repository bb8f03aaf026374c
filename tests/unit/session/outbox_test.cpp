// What waits to be written: order, one write at a time, and which pieces it has.
#include "session/outbox.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace linefeed::session {
namespace {

void stage_command(Outbox& outbox, std::string_view text) {
    outbox.command_text() += text;
    outbox.staged_command();
}

std::vector<std::string> pieces(const Outbox& outbox) {
    std::vector<std::string> texts;
    for (const std::string_view piece : outbox.pieces()) {
        texts.emplace_back(piece);
    }
    return texts;
}

using Texts = std::vector<std::string>;

TEST(Outbox, shouldHaveNothingToWriteAtFirst) {
    Outbox outbox;
    EXPECT_TRUE(outbox.idle());
    EXPECT_FALSE(outbox.begin_write());
    EXPECT_FALSE(outbox.writing());
}

TEST(Outbox, shouldKeepTheOrderOfCommandsAndSlices) {
    Outbox outbox;
    const std::string first_page = "AAAA";
    const std::string second_page = "BBBB";
    stage_command(outbox, "one\r");
    stage_command(outbox, "two\r");
    outbox.stage_slice(first_page);
    outbox.stage_slice(second_page);
    stage_command(outbox, "three\r");
    EXPECT_FALSE(outbox.idle());
    ASSERT_TRUE(outbox.begin_write());
    EXPECT_EQ(pieces(outbox), (Texts{"one\rtwo\r", "AAAA", "BBBB", "three\r"}));
    EXPECT_EQ(outbox.pieces()[1].data(), first_page.data()) << "a slice is not copied";
}

TEST(Outbox, shouldJoinSlicesThatFollowOneAnotherInAPage) {
    Outbox outbox;
    const std::string page = "one\rtwo\rthree\rfour\r";
    const std::string_view view{page};
    outbox.stage_slice(view.substr(0, 4));
    outbox.stage_slice(view.substr(4, 4));
    outbox.stage_slice(view.substr(14, 5));
    ASSERT_TRUE(outbox.begin_write());
    EXPECT_EQ(pieces(outbox), (Texts{"one\rtwo\r", "four\r"}));
}

TEST(Outbox, shouldHaveOneWriteUnderWayAtATime) {
    Outbox outbox;
    const std::string page = "AAAA";
    stage_command(outbox, "one\r");
    ASSERT_TRUE(outbox.begin_write());
    EXPECT_TRUE(outbox.writing());
    stage_command(outbox, "two\r");
    outbox.stage_slice(page);
    EXPECT_FALSE(outbox.begin_write());
    EXPECT_EQ(pieces(outbox), (Texts{"one\r"})) << "what was staged since does not change the write under way";
    outbox.write_done();
    EXPECT_FALSE(outbox.idle());
    ASSERT_TRUE(outbox.begin_write());
    EXPECT_EQ(pieces(outbox), (Texts{"two\r", "AAAA"}));
    outbox.write_done();
    EXPECT_TRUE(outbox.idle());
    EXPECT_FALSE(outbox.begin_write());
}

TEST(Outbox, shouldBeUsableAgainAfterMoreThanItReserved) {
    Outbox outbox;
    const std::string long_command(10000, 'x');
    for (int round = 0; round < 3; ++round) {
        stage_command(outbox, long_command);
        stage_command(outbox, "end\r");
        ASSERT_TRUE(outbox.begin_write());
        EXPECT_EQ(pieces(outbox), (Texts{long_command + "end\r"}));
        outbox.write_done();
    }
}

TEST(Outbox, shouldDropEverythingWhenTheConnectionIsGone) {
    Outbox outbox;
    stage_command(outbox, "one\r");
    ASSERT_TRUE(outbox.begin_write());
    stage_command(outbox, "two\r");
    outbox.clear();
    EXPECT_TRUE(outbox.idle());
    EXPECT_FALSE(outbox.writing());
    EXPECT_TRUE(outbox.pieces().empty());
    stage_command(outbox, "three\r");
    ASSERT_TRUE(outbox.begin_write());
    EXPECT_EQ(pieces(outbox), (Texts{"three\r"}));
}

using OutboxDeathTest = testing::Test;

TEST(OutboxDeathTest, shouldRefuseEmptyPiecesAndAnEndWithoutAWrite) {
    Outbox outbox;
    EXPECT_DEATH(outbox.staged_command(), "added");
    EXPECT_DEATH(outbox.stage_slice({}), "empty");
    EXPECT_DEATH(outbox.write_done(), "writing_");
}

} // namespace
} // namespace linefeed::session
