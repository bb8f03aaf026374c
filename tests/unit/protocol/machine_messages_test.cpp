// What the printer tells about its machine: ranges, gaps, and words.
#include "parsing.hpp"

namespace linefeed::protocol {
namespace {

TEST(ClockTime, shouldDemandAllSevenPartsInTheirRanges) {
    EXPECT_EQ(reason("^0=DL2015\t10\t1\t26\t7\t45\r"), "=DL: parameter 7 is missing: a second");
    EXPECT_EQ(reason("^0=DL2015\t\t1\t26\t7\t45\t23\r"), "=DL: parameter 2 is missing: a month");
    EXPECT_EQ(reason("^0=DL1600\t10\t1\t26\t7\t45\t23\r"), "=DL: parameter 1 is not a year: \"1600\"");
    EXPECT_EQ(reason("^0=DL2015\t13\t1\t26\t7\t45\t23\r"), "=DL: parameter 2 is not a month: \"13\"");
    EXPECT_EQ(reason("^0=DL2015\t0\t1\t26\t7\t45\t23\r"), "=DL: parameter 2 is not a month: \"0\"");
    EXPECT_EQ(reason("^0=DL2015\t10\t7\t26\t7\t45\t23\r"), "=DL: parameter 3 is not a weekday: \"7\"");
    EXPECT_EQ(reason("^0=DL2015\t10\t1\t32\t7\t45\t23\r"), "=DL: parameter 4 is not a day: \"32\"");
    EXPECT_EQ(reason("^0=DL2015\t10\t1\t26\t24\t45\t23\r"), "=DL: parameter 5 is not an hour: \"24\"");
    EXPECT_EQ(reason("^0=DL2015\t10\t1\t26\t7\t60\t23\r"), "=DL: parameter 6 is not a minute: \"60\"");
    EXPECT_EQ(reason("^0=DL2015\t10\t1\t26\t7\t45\t60\r"), "=DL: parameter 7 is not a second: \"60\"");
}

TEST(HydraulicState, shouldLeaveMissingValuesOpenAndKeepTheUndocumentedOne) {
    EXPECT_EQ(parsed_as<HydraulicState>("^0=HS7100\t\t35\t1000\t0\tA7 b\r"),
              (HydraulicState{7100, std::nullopt, 35, 1000, 0, "A7 b"}));
    EXPECT_EQ(rewritten("^0=HS7100\t\t35\t1000\t0\tA7 b\r"), "^0=HS7100\t\t35\t1000\t0\tA7 b\r");
    EXPECT_EQ(reason("^0=HS7100\thigh\r"), "=HS: parameter 2 is not a pressure: \"high\"");
}

TEST(MainConfiguration, shouldSkipWhatIsReserved) {
    const auto main = parsed_as<MainConfiguration>("^0=MC1\t2\tx\ty\tz\t7100\t2400\tr\t-3\t66\t70000\t630\t2215\r");
    EXPECT_EQ(main, (MainConfiguration{true, EncoderLevel::htl_24_v, 7100, 2400, -3, 66, 70000, 630, 2215}));
    EXPECT_EQ(encoded(main), "^0=MC1\t2\t0\t0\t0\t7100\t2400\t0\t-3\t66\t70000\t630\t2215\r");
    EXPECT_EQ(parsed_as<MainConfiguration>("^0=MC0\t7\r").encoder, EncoderLevel{7}) << "newer firmware";
    EXPECT_EQ(reason("^0=MC0\t2\t0\t0\t0\t1\t1\t0\t1.5\r"), "=MC: parameter 9 is not a correction: \"1.5\"");
    EXPECT_EQ(reason("^0=MC0\t2\t0\t0\t0\t1\t1\t0\t1\t1\t1\t2360\r"),
              "=MC: parameter 12 is not a time of day: \"2360\"");
}

TEST(ActorStates, shouldReadElevenValues) {
    const auto states = parsed_as<ActorStates>("^0=MS1\t2\t3\t4\t5\t6\t7\t8\t5\t1\t0\r");
    EXPECT_EQ(states, (ActorStates{1, 2, 3, 4, 5, 6, 7, 8, HeadMotor::in_between, true}));
    EXPECT_EQ(parsed_as<ActorStates>("^0=MS1\r").head_motor, std::nullopt);
    EXPECT_EQ(reason("^0=MS1\t-\r"), "=MS: parameter 2 is not an actor state: \"-\"");
}

TEST(ServiceHistory, shouldTakeThePackedDateSignedAndUnsigned) {
    // 2063-12-31 23:59:59: all bits of the year set, so the sign is too
    const auto history = parsed_as<ServiceHistory>("^0=SH1\t2\t-12615941\r");
    EXPECT_EQ(history.last_service_date, -12615941);
    EXPECT_EQ(parsed_as<ServiceHistory>("^0=SH1\t2\t4282351355\r"), history);
    EXPECT_EQ(to_string(unpack_date(static_cast<std::uint32_t>(*history.last_service_date))), "2063-12-31 23:59:59");
    EXPECT_EQ(parsed_as<ServiceHistory>("^0=SH1\r").last_service_date, std::nullopt);
}

TEST(FreeFlash, shouldBeANumber) {
    EXPECT_EQ(parsed_as<FreeFlash>("^0=DS24576\r").kbyte, 24576U);
    EXPECT_EQ(reason("^0=DSmuch\r"), "=DS: parameter 1 is not a size in kByte: \"much\"");
}

TEST(MachineWords, shouldSayEveryState) {
    EXPECT_EQ(to_string(EncoderLevel::rs422), "RS422");
    EXPECT_EQ(to_string(EncoderLevel::ttl_5_v), "TTL 5 V");
    EXPECT_EQ(to_string(EncoderLevel::htl_24_v), "HTL 24 V");
    EXPECT_EQ(to_string(EncoderLevel{9}), "unknown");
    EXPECT_EQ(to_string(HeadMotor::opening), "opening");
    EXPECT_EQ(to_string(HeadMotor::opened), "opened");
    EXPECT_EQ(to_string(HeadMotor::closing), "closing");
    EXPECT_EQ(to_string(HeadMotor::closed), "closed");
    EXPECT_EQ(to_string(HeadMotor::in_between), "in between");
    EXPECT_EQ(to_string(HeadMotor{9}), "unknown");
}

TEST(MessageEncoderDeathTest, shouldAbortOnValuesOutOfTheirRange) {
    EXPECT_DEATH(encoded(ClockTime{{2015, 13, 1, 0, 0, 0}, 0}), "limits");
    EXPECT_DEATH(encoded(OutputChange{9, true}), "limits");
    EXPECT_DEATH(encoded(BlockLength{0}), "limits");
    EXPECT_DEATH(encoded(HydraulicState{1, 1, 1, 1, 1, "a\tb"}), "find_first_of");
}

} // namespace
} // namespace linefeed::protocol
