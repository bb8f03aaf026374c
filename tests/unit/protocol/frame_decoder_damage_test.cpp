// Damaged streams: whatever comes, the decoder goes on at the next `^` and says how much it dropped.
#include "decoding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

using namespace std::string_view_literals;
using testing::ElementsAre;

const std::string long_data(max_frame_bytes, 'x');

TEST(FrameDecoderDamage, shouldReportGarbageBetweenFrames) {
    EXPECT_THAT(decode("noise^0!GO\r"), ElementsAre("garbage 5", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^0!GO\rno ise\r\n^0!ST\r"), ElementsAre("0!GO [^0!GO]", "garbage 5", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("noise"), ElementsAre("garbage 5"));
    EXPECT_THAT(decode("\xFF\t\x01"), ElementsAre("garbage 3"));
}

TEST(FrameDecoderDamage, shouldReportGarbageOnceForEachChunk) {
    FrameDecoder decoder;
    std::string_view input = "noise";
    EXPECT_EQ(story(std::get<FrameError>(decoder.next(input))), "garbage 5");
    EXPECT_TRUE(std::holds_alternative<std::monostate>(decoder.next(input)));
}

TEST(FrameDecoderDamage, shouldStartAgainAtACaretInsideAFrame) {
    EXPECT_THAT(decode("^0=SM256\t0^0!GO\r"), ElementsAre("interrupted 10", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^^0!GO\r"), ElementsAre("interrupted 1", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^0^0!GO\r"), ElementsAre("interrupted 2", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^00001^0!GO\r"), ElementsAre("interrupted 6", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^0=^0?^0!GO\r"), ElementsAre("interrupted 3", "interrupted 3", "0!GO [^0!GO]"));
}

TEST(FrameDecoderDamage, shouldRefuseAnAddressThatIsNone) {
    EXPECT_THAT(decode("^G!GO\r^0!ST\r"), ElementsAre("bad_address 5", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^a!GO\r"), ElementsAre("bad_address 5"));
    EXPECT_THAT(decode("^!GO\r"), ElementsAre("bad_address 4"));
    EXPECT_THAT(decode("^\r^0!ST\r"), ElementsAre("bad_address 1", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^\0\r"sv), ElementsAre("bad_address 2"));
}

TEST(FrameDecoderDamage, shouldRefuseAGroupThatIsNone) {
    EXPECT_THAT(decode("^0GO\r^0!ST\r"), ElementsAre("bad_group 4", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^0\r^0!ST\r"), ElementsAre("bad_group 2", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^0\0!\r"sv), ElementsAre("bad_group 4"));
    EXPECT_THAT(decode("^000013x\r"), ElementsAre("bad_group 8"));
    EXPECT_THAT(decode("^0000137=RS2\t6\r"), ElementsAre("bad_group 14")) << "six digits";
}

TEST(FrameDecoderDamage, shouldReportADamagedHeadOnceUpToTheNextStart) {
    EXPECT_THAT(decode("^xyz\\^0!GO\r"), ElementsAre("bad_address 5", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^0xyz^0!GO\r"), ElementsAre("bad_group 5", "0!GO [^0!GO]"));
}

TEST(FrameDecoderDamage, shouldRefuseALengthOfFewerThanFiveDigits) {
    EXPECT_THAT(decode("^01=RS2\r"), ElementsAre("bad_length 7"));
    EXPECT_THAT(decode("^00013=RS2\t6\t0\t0\t0\r^0!GO\r"), ElementsAre("bad_length 18", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^00013\r"), ElementsAre("bad_length 6"));
}

TEST(FrameDecoderDamage, shouldRefuseALengthThatHoldsNoGroup) {
    EXPECT_THAT(decode("^000000=\r^000001=\r^000002=\r"),
                ElementsAre("bad_length 8", "bad_length 8", "0= [^000002=] length"));
}

TEST(FrameDecoderDamage, shouldRefuseAFrameThatEndsBeforeItsLength) {
    EXPECT_THAT(decode("^000013=RS2\t6\t0\t0\r^0!GO\r"), ElementsAre("bad_length 17", "0!GO [^0!GO]"));
}

TEST(FrameDecoderDamage, shouldRefuseAFrameThatGoesOnBehindItsLength) {
    EXPECT_THAT(decode("^000013=RS2\t6\t0\t0\t01\r^0!GO\r"), ElementsAre("bad_length 20", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^000013=RS2\t6\t0\t0\t0^0!GO\r"), ElementsAre("bad_length 19", "0!GO [^0!GO]")) << "a lost CR";
}

TEST(FrameDecoderDamage, shouldAcceptNothingButOneLineFeedBetweenTheLengthAndTheCarriageReturn) {
    EXPECT_THAT(decode("^000004!GO\n\n\r^0!ST\r"), ElementsAre("bad_length 12", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^000004!GO\nx\r^0!ST\r"), ElementsAre("bad_length 12", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^000003!GO\n\r^0!ST\r"), ElementsAre("bad_length 11", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^000004!GO\n^0!ST\r"), ElementsAre("bad_length 11", "0!ST [^0!ST]")) << "a lost CR";
    EXPECT_THAT(decode("^000006!GO\n\r^0!ST\r"), ElementsAre("bad_length 11", "0!ST [^0!ST]")) << "too long by one";
    // What lies behind the line feed is decoded once more where it looked escaped.
    EXPECT_THAT(decode("^000030=JLA\\^000004!GO\n\r"), ElementsAre("bad_length 12", "0!GO [^000004!GO\n] length"));
}

TEST(FrameDecoderDamage, shouldFindTheFrameThatBeginsWhereTheCarriageReturnWasDue) {
    // The path ends in a single backslash and its CR is lost: only the length tells that `\^` is no escape.
    EXPECT_THAT(decode("^000006=JLA\\^000004!GO\r"), ElementsAre("bad_length 12", "0!GO [^000004!GO] length"));
}

TEST(FrameDecoderDamage, shouldFindAFrameInsideTheDamagedOne) {
    // Bytes and the CR are lost; the next frame looks escaped and lies in the buffer when the length turns out wrong.
    EXPECT_THAT(decode("^000030=JLA\\^000013=RS2\t6\t0\t0\t0\r^0!GO\r"),
                ElementsAre("bad_length 12", "0=RS2\t6\t0\t0\t0 [^000013=RS2\t6\t0\t0\t0] length", "0!GO [^0!GO]"));
    // The same where the length is up in the middle of the frame inside.
    EXPECT_THAT(decode("^000010=JLA\\^000013=RS2\t6\t0\t0\t0\r^0!GO\r"),
                ElementsAre("bad_length 12", "0=RS2\t6\t0\t0\t0 [^000013=RS2\t6\t0\t0\t0] length", "0!GO [^0!GO]"));
}

TEST(FrameDecoderDamage, shouldFindAFrameInsideAFrameInsideTheDamagedOne) {
    EXPECT_THAT(decode("^000090=JLA\\^000080=JLB\\^000004!GO\r^0!ST\r"),
                ElementsAre("bad_length 12", "bad_length 12", "0!GO [^000004!GO] length", "0!ST [^0!ST]"));
    // The second turns out wrong while its bytes are still being decoded once more, with the third among the rest.
    EXPECT_THAT(decode("^000090=JLA\\^000007=JLB\\^000004!GO\r^0!ST\r"),
                ElementsAre("bad_length 12", "bad_length 12", "0!GO [^000004!GO] length", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^000090=JLA\\^0x\\^0!GO\r^0!ST\r"),
                ElementsAre("bad_length 12", "bad_group 4", "0!GO [^0!GO]", "0!ST [^0!ST]"));
}

TEST(FrameDecoderDamage, shouldGoOnWithDataThatOnlyLookedLikeAStart) {
    EXPECT_THAT(decode("^000090=JLa\\^b\r^0!GO\r"), ElementsAre("bad_length 12", "bad_address 2", "0!GO [^0!GO]"));
}

TEST(FrameDecoderDamage, shouldDeliverTheBeginningOfAnOverlongFrame) {
    const std::string kept = "^0=" + long_data.substr(3);
    EXPECT_THAT(decode("^0=" + long_data + "\r^0!GO\r"),
                ElementsAre("0=" + kept.substr(3) + " [" + kept + "] truncated", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^0=" + long_data + "^0!GO\r"),
                ElementsAre("0=" + kept.substr(3) + " [" + kept + "] truncated", "0!GO [^0!GO]"));
}

TEST(FrameDecoderDamage, shouldTruncateFromTheFirstByteTooMany) {
    const std::string fits = "^0=" + long_data.substr(3);
    EXPECT_THAT(decode(fits + "\r"), ElementsAre("0=" + fits.substr(3) + " [" + fits + "]"));
    EXPECT_THAT(decode(fits + "\n\r"), ElementsAre("0=" + fits.substr(3) + " [" + fits + "] truncated"));
}

TEST(FrameDecoderDamage, shouldKeepALineFeedThatIsTheLastByteStoredOfAnOverlongFrame) {
    std::string kept = "^0=" + long_data.substr(3);
    kept.back() = '\n';
    EXPECT_THAT(decode(kept + "x\r"), ElementsAre("0=" + kept.substr(3) + " [" + kept + "] truncated"));
}

TEST(FrameDecoderDamage, shouldFollowEscapesBeyondTheBuffer) {
    const std::string kept = "^0=" + long_data.substr(3);
    EXPECT_THAT(decode("^0=" + long_data + "\\^0!ST\r^0!GO\r"),
                ElementsAre("0=" + kept.substr(3) + " [" + kept + "] truncated", "0!GO [^0!GO]"));
}

TEST(FrameDecoderDamage, shouldCheckTheLengthOfAnOverlongFrameToo) {
    const std::string kept = "^009000=" + long_data.substr(8);
    const std::string rest(9000 - 2 - (max_frame_bytes - 8), 'x');
    EXPECT_THAT(decode(kept + rest + "\r"), ElementsAre("0=" + kept.substr(8) + " [" + kept + "] length truncated"));
    EXPECT_THAT(decode(kept + rest + "\n\r"), ElementsAre("0=" + kept.substr(8) + " [" + kept + "] length truncated"));
    EXPECT_THAT(decode(kept + rest + "x\r"), ElementsAre("bad_length 9007"));
    // What is not in the buffer cannot be decoded once more.
    const std::string hiding = "^099000=\\^0" + long_data;
    EXPECT_THAT(decode(hiding + "\r^0!GO\r"),
                ElementsAre("bad_length " + std::to_string(hiding.size()), "0!GO [^0!GO]"));
}

TEST(FrameDecoderDamage, shouldSurviveEndlessInputWithoutAnEnd) {
    FrameDecoder decoder;
    const std::string megabyte(1 << 20, 'x');
    std::vector<std::string> stories;
    std::uint64_t garbage = 0;
    feed(decoder, "^0=", stories, garbage);
    for (int i = 0; i < 16; ++i) {
        feed(decoder, megabyte, stories, garbage);
    }
    EXPECT_TRUE(stories.empty());
    feed(decoder, "\r^0!GO\r", stories, garbage);
    ASSERT_EQ(stories.size(), 2U);
    EXPECT_TRUE(stories[0].ends_with("] truncated"));
    EXPECT_EQ(stories[1], "0!GO [^0!GO]");
}

} // namespace
} // namespace linefeed::protocol
