// Frames as bytes, compared with literal ones of the manual.
#include "decoding.hpp"
#include "protocol/frame_encoder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

std::string frame(Group group, std::string_view payload) {
    std::string out;
    append_frame(out, group, payload);
    return out;
}

std::string frame_with_length(Group group, std::string_view payload) {
    std::string out;
    append_frame_with_length(out, group, payload);
    return out;
}

TEST(FrameEncoder, shouldWriteEachGroup) {
    EXPECT_EQ(frame(Group::script, "BEGINLJSCRIPT"), "^0*BEGINLJSCRIPT\r");
    EXPECT_EQ(frame(Group::action, "RC"), "^0!RC\r");
    EXPECT_EQ(frame(Group::inquiry, "PR1"), "^0?PR1\r");
    EXPECT_EQ(frame(Group::parameter, "HS7100\t2400"), "^0=HS7100\t2400\r");
    EXPECT_EQ(frame(Group::file, "DI1\t00"), "^0$DI1\t00\r");
    EXPECT_EQ(frame(Group::parameter, ""), "^0=\r");
}

TEST(FrameEncoder, shouldAppendToWhatIsThere) {
    std::string out;
    append_inquiry(out, Parameter::RS);
    append_inquiry(out, Parameter::SM);
    append_action(out, Action::start_print);
    EXPECT_EQ(out, "^0?RS\r^0?SM\r^0!GO\r");
}

// The !LN vector of the manual.
TEST(FrameEncoder, shouldWriteTheLengthOfLn) {
    EXPECT_EQ(frame_with_length(Group::parameter, "RS2\t6\t0\t0\t0"), "^000013=RS2\t6\t0\t0\t0\r");
    EXPECT_EQ(frame_with_length(Group::action, ""), "^000002!\r");
}

TEST(FrameEncoder, shouldWriteTheLargestLength) {
    const std::string payload(99997, 'x');
    EXPECT_EQ(frame_with_length(Group::script, payload), "^099999*" + payload + "\r");
    EXPECT_DEATH(frame_with_length(Group::script, payload + "x"), "rest == 0");
}

TEST(FrameEncoder, shouldWriteWhatTheDecoderReads) {
    EXPECT_THAT(decode(frame_with_length(Group::parameter, "SM256\t0\t0\t0\t1")),
                testing::ElementsAre("0=SM256\t0\t0\t0\t1 [^000015=SM256\t0\t0\t0\t1] length"));
}

TEST(FrameEncoderDeathTest, shouldAbortOnACarriageReturnInsideThePayload) {
    EXPECT_DEATH(frame(Group::parameter, "MR1\ta\rb"), "payload.find");
    EXPECT_DEATH(frame_with_length(Group::parameter, "MR1\ta\rb"), "payload.find");
}

} // namespace
} // namespace linefeed::protocol
