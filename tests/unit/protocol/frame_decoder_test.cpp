// Frames as the manual and real printers send them: every ending, filling, mode and group.
#include "decoding.hpp"
#include "protocol/frame_decoder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

using namespace std::string_view_literals;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(FrameDecoder, shouldDecodeEachOfTheFiveGroups) {
    EXPECT_THAT(decode("^0*BEGINLJSCRIPT\r^0!GO\r^0?SM\r^0=CM100000\r^0$RDFFSDISK\\Jobs\r"),
                ElementsAre("0*BEGINLJSCRIPT [^0*BEGINLJSCRIPT]", "0!GO [^0!GO]", "0?SM [^0?SM]",
                            "0=CM100000 [^0=CM100000]", "0$RDFFSDISK\\Jobs [^0$RDFFSDISK\\Jobs]"));
}

TEST(FrameDecoder, shouldGiveThePartsOfAFrame) {
    FrameDecoder decoder;
    std::string_view input = "^0=RS2\t6\t-1711274809\t0\t9\t0\r^0!GO\r";
    const DecodeResult result = decoder.next(input);
    const auto& frame = std::get<Frame>(result);
    EXPECT_EQ(frame.address, '0');
    EXPECT_EQ(frame.group, Group::parameter);
    EXPECT_EQ(frame.payload, "RS2\t6\t-1711274809\t0\t9\t0");
    EXPECT_EQ(frame.raw, "^0=RS2\t6\t-1711274809\t0\t9\t0");
    EXPECT_FALSE(frame.has_length);
    EXPECT_FALSE(frame.truncated);
    EXPECT_EQ(input, "^0!GO\r") << "the next frame is left for the next call";
}

TEST(FrameDecoder, shouldAcceptEveryAddress) {
    for (const char address : "0123456789ABCDEF"sv) {
        const std::string frame = std::string{"^"} + address + "!GO";
        EXPECT_THAT(decode(frame + "\r"), ElementsAre(address + std::string{"!GO ["} + frame + "]"));
    }
}

TEST(FrameDecoder, shouldAcceptEveryEndOfLine) {
    EXPECT_THAT(decode("^0!GO\r^0!ST\r"), ElementsAre("0!GO [^0!GO]", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^0!GO\r\n^0!ST\r\n"), ElementsAre("0!GO [^0!GO]", "0!ST [^0!ST]"));
    EXPECT_THAT(decode("^0!GO\n\r^0!ST\n\r"), ElementsAre("0!GO [^0!GO\n]", "0!ST [^0!ST\n]"));
    EXPECT_THAT(decode("\n\r^0!GO\n\r\n\r^0!ST\n\r"), ElementsAre("0!GO [^0!GO\n]", "0!ST [^0!ST\n]"));
}

TEST(FrameDecoder, shouldDropOnlyOneLineFeedBeforeTheCarriageReturn) {
    EXPECT_THAT(decode("^0=ETa\nb\n\n\r"), ElementsAre("0=ETa\nb\n [^0=ETa\nb\n\n]"));
    EXPECT_THAT(decode("^0=\n\r"), ElementsAre("0= [^0=\n]"));
}

TEST(FrameDecoder, shouldIgnoreEmptyCommands) {
    EXPECT_THAT(decode("\r\r\r"), IsEmpty());
    EXPECT_THAT(decode("\r^0!GO\r\r\r\n\r^0!ST\r\r"), ElementsAre("0!GO [^0!GO]", "0!ST [^0!ST]"));
}

TEST(FrameDecoder, shouldIgnoreTheFillingOfBlocks) {
    const std::string filling(2048 - 7, ' ');
    EXPECT_THAT(decode("^0=RS2\r" + filling + "^0=SM2\r" + filling), ElementsAre("0=RS2 [^0=RS2]", "0=SM2 [^0=SM2]"));
    EXPECT_THAT(decode("^0=RS2\r\0\0 \n\0^0!GO\r\0"sv), ElementsAre("0=RS2 [^0=RS2]", "0!GO [^0!GO]"));
}

TEST(FrameDecoder, shouldPassAllOtherBytesOfData) {
    std::string data;
    for (int byte = 1; byte < 256; ++byte) {
        if (byte != '\r' && byte != '^' && byte != '\\') {
            data.push_back(static_cast<char>(byte));
        }
    }
    data.push_back('\0');
    EXPECT_THAT(decode("^0=ET" + data + "\r"), ElementsAre("0=ET" + data + " [^0=ET" + data + "]"));
}

TEST(FrameDecoder, shouldDecodeAFrameWithoutPayload) {
    EXPECT_THAT(decode("^0!\r"), ElementsAre("0! [^0!]"));
}

TEST(FrameDecoder, shouldWaitForTheEndOfAFrame) {
    EXPECT_THAT(decode(""), IsEmpty());
    EXPECT_THAT(decode("^"), IsEmpty());
    EXPECT_THAT(decode("^0"), IsEmpty());
    EXPECT_THAT(decode("^0="), IsEmpty());
    EXPECT_THAT(decode("^0=RS2\t6"), IsEmpty());
    EXPECT_THAT(decode("^00001"), IsEmpty());
}

// The !LN vector of the manual.
TEST(FrameDecoder, shouldRecogniseTheLengthOfLn) {
    EXPECT_THAT(
        decode("^0=RS2\t6\t0\t0\t0\r^000013=RS2\t6\t0\t0\t0\r"),
        ElementsAre("0=RS2\t6\t0\t0\t0 [^0=RS2\t6\t0\t0\t0]", "0=RS2\t6\t0\t0\t0 [^000013=RS2\t6\t0\t0\t0] length"));
}

TEST(FrameDecoder, shouldRecogniseTheLengthAtAnyAddress) {
    EXPECT_THAT(decode("^A00004!GO\r^900002!\r"), ElementsAre("A!GO [^A00004!GO] length", "9! [^900002!] length"));
}

TEST(FrameDecoder, shouldCountEscapesAndLineFeedInTheLength) {
    EXPECT_THAT(decode("^000007=JL\\^x\r"), ElementsAre("0=JL\\^x [^000007=JL\\^x] length"))
        << "bytes as sent, with the backslash";
    EXPECT_THAT(decode("^000005!GO\n\r"), ElementsAre("0!GO [^000005!GO\n] length"));
}

TEST(FrameDecoder, shouldAcceptALengthThatLeavesOutTheLineFeedBeforeTheCarriageReturn) {
    EXPECT_THAT(decode("^000013=RS2\t6\t0\t0\t0\n\r^000014=RS2\t6\t0\t0\t0\n\r"),
                ElementsAre("0=RS2\t6\t0\t0\t0 [^000013=RS2\t6\t0\t0\t0\n] length",
                            "0=RS2\t6\t0\t0\t0 [^000014=RS2\t6\t0\t0\t0\n] length"));
    EXPECT_THAT(decode("^000004!GO\n\r\n^000002!\n\r"),
                ElementsAre("0!GO [^000004!GO\n] length", "0! [^000002!\n] length"));
    EXPECT_THAT(decode("^000007=JLA\\\\\n\r^0!GO\r"),
                ElementsAre("0=JLA\\\\ [^000007=JLA\\\\\n] length", "0!GO [^0!GO]"));
}

TEST(FrameDecoder, shouldTakeAnEscapedCaretForData) {
    EXPECT_THAT(decode("^0=MR1\ta\\^b\r"), ElementsAre("0=MR1\ta\\^b [^0=MR1\ta\\^b]"));
    EXPECT_THAT(decode("^0=MR1\t\\\\\\^b\r"), ElementsAre("0=MR1\t\\\\\\^b [^0=MR1\t\\\\\\^b]"));
}

TEST(FrameDecoder, shouldTakeTheCaretBehindAnEscapedBackslashForAStart) {
    EXPECT_THAT(decode("^0=MR1\ta\\\\^0!GO\r"), ElementsAre("interrupted 10", "0!GO [^0!GO]"));
}

TEST(FrameDecoder, shouldNotLetABackslashReachBeyondTheNextByte) {
    EXPECT_THAT(decode("^0=JL\\x^0!GO\r"), ElementsAre("interrupted 7", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^0=JLA\\\r^0!GO\r"), ElementsAre("0=JLA\\ [^0=JLA\\]", "0!GO [^0!GO]"));
}

TEST(FrameDecoder, shouldTakeEveryCaretForAStartWithoutEscapes) {
    EXPECT_THAT(decode("^0=MR1\ta\\^0!GO\r", EscapeMode::none), ElementsAre("interrupted 9", "0!GO [^0!GO]"));
    EXPECT_THAT(decode("^0=JL\\FFSDISK\\JOBS\\Testprint.job\r", EscapeMode::none),
                ElementsAre("0=JL\\FFSDISK\\JOBS\\Testprint.job [^0=JL\\FFSDISK\\JOBS\\Testprint.job]"));
}

TEST(FrameDecoder, shouldDecodeTheLargestFrameWhole) {
    const std::string data(max_frame_bytes - 3, 'x');
    EXPECT_THAT(decode("^0=" + data + "\r"), ElementsAre("0=" + data + " [^0=" + data + "]"));
}

TEST(FrameDecoder, shouldForgetAFrameBegunOnReset) {
    FrameDecoder decoder;
    std::string_view input = "^0=JL\\";
    EXPECT_TRUE(std::holds_alternative<std::monostate>(decoder.next(input)));
    decoder.reset();
    input = "^0!GO\r";
    const DecodeResult result = decoder.next(input);
    EXPECT_EQ(story(std::get<Frame>(result)), "0!GO [^0!GO]");
}

TEST(FrameDecoder, shouldForgetGarbageAndReplayOnReset) {
    FrameDecoder decoder;
    // A wrong length whose frame hides another one: the second is not read after the reset.
    std::string_view input = "^000099=JL\\^0!GO\r";
    EXPECT_EQ(story(std::get<FrameError>(decoder.next(input))), "bad_length 11");
    decoder.reset();
    input = "^0!ST\r";
    const DecodeResult result = decoder.next(input);
    EXPECT_EQ(story(std::get<Frame>(result)), "0!ST [^0!ST]");
}

} // namespace
} // namespace linefeed::protocol
