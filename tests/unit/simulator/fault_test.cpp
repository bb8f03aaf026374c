// The words of faults and scenarios.
#include "simulator/fault.hpp"

#include <gtest/gtest.h>

namespace linefeed::simulator {
namespace {

template <typename T>
T deed(std::string_view text) {
    const auto fault = parse_fault(text);
    EXPECT_TRUE(fault) << text;
    const auto* what = fault ? std::get_if<T>(&fault->what) : nullptr;
    EXPECT_NE(what, nullptr) << text;
    return what != nullptr ? *what : T{};
}

TEST(Fault, shouldKnowWhen) {
    EXPECT_EQ(parse_fault("print 100 stop")->when.count, 100U);
    EXPECT_EQ(parse_fault("print 100 stop")->when.unit, Moment::Unit::print);
    EXPECT_EQ(parse_fault("  frame\t7   cut \r")->when.unit, Moment::Unit::frame);
    EXPECT_EQ(parse_fault("time 2.5 cut")->when.unit, Moment::Unit::time);
    EXPECT_EQ(parse_fault("time 2.5 cut")->when.time, std::chrono::milliseconds{2500});
    EXPECT_EQ(parse_fault("time 0 cut")->when.time, Duration{});
}

TEST(Fault, shouldKnowWhat) {
    using protocol::Action;
    EXPECT_EQ(deed<PressKey>("print 1 start").action, Action::start_print);
    EXPECT_EQ(deed<PressKey>("print 1 stop").action, Action::stop_print);
    EXPECT_EQ(deed<PressKey>("print 1 open-nozzle").action, Action::nozzle_open);
    EXPECT_EQ(deed<PressKey>("print 1 close-nozzle").action, Action::nozzle_close);
    EXPECT_EQ(deed<PressKey>("print 1 acknowledge").action, Action::acknowledge_errors);
    EXPECT_EQ(deed<PressKey>("print 1 power-on").action, Action::power_on);
    EXPECT_EQ(deed<PressKey>("print 1 power-off").action, Action::power_off);
    EXPECT_EQ(deed<RaiseError>("print 1 error 12113").code, 12113U);
    EXPECT_TRUE(deed<MoveCover>("print 1 cover open").open);
    EXPECT_FALSE(deed<MoveCover>("print 1 cover closed").open);
    EXPECT_EQ(deed<LoadJob>("print 1 job FFSDISK\\Jobs\\LJ24 Test.job").path, "FFSDISK\\Jobs\\LJ24 Test.job");
    EXPECT_EQ(deed<SetInput>("print 1 input x4.22 on").input, protocol::Input::x4_22);
    EXPECT_FALSE(deed<SetInput>("print 1 input X4.9 off").on);
    EXPECT_FALSE(deed<MoveStick>("print 1 stick out").present);
    EXPECT_TRUE(deed<MoveStick>("print 1 stick in").present);
    deed<CutConnections>("print 1 cut");
    EXPECT_TRUE(deed<Mute>("print 1 mute").muted);
    EXPECT_FALSE(deed<Mute>("print 1 unmute").muted);
    deed<PowerCycle>("print 1 power-cycle");
    EXPECT_EQ(deed<ExpectTrouble>("print 1 lose-answer").times, 1U);
    EXPECT_EQ(deed<ExpectTrouble>("print 1 damage-answer 5").times, 5U);
    EXPECT_EQ(deed<ExpectTrouble>("print 1 damage-answer 5").trouble, Trouble::damaged_answer);
    EXPECT_EQ(deed<ExpectTrouble>("print 1 wrong-crc").trouble, Trouble::wrong_crc);
    EXPECT_EQ(deed<ExpectTrouble>("print 1 refuse-crc").trouble, Trouble::refused_crc);
    EXPECT_EQ(deed<ExpectTrouble>("print 1 damage-block").trouble, Trouble::damaged_block);
    EXPECT_EQ(deed<ExpectTrouble>("print 1 refuse-block").trouble, Trouble::refused_block);
    EXPECT_EQ(deed<ExpectTrouble>("print 1 cancel-transfer").trouble, Trouble::cancelled_transfer);
}

TEST(Fault, shouldSayWhatWasExpected) {
    for (const char* const text :
         {"", "stop", "print stop", "print 0 stop", "print -1 stop", "print 1.5 stop", "time x stop", "time -1 stop",
          "time nan stop", "time inf stop", "time 1e3 stop", "time 1000001 stop", "hour 1 stop", "frame 0 cut"}) {
        const auto fault = parse_fault(text);
        ASSERT_FALSE(fault) << text;
        EXPECT_EQ(fault.error().kind, FailureKind::usage);
        EXPECT_NE(fault.error().message.find("print N"), std::string::npos) << fault.error().message;
    }
    for (const char* const text :
         {"print 1", "print 1 explode", "print 1 stop now", "print 1 error", "print 1 error 0",
          "print 1 error 33554432", "print 1 cover", "print 1 cover ajar", "print 1 job", "print 1 input X4.9",
          "print 1 input X4.21 on", "print 1 stick", "print 1 cut all", "print 1 mute 1", "print 1 power-cycle 2",
          "print 1 lose-answer 0", "print 1 lose-answer x"}) {
        const auto fault = parse_fault(text);
        ASSERT_FALSE(fault) << text;
        EXPECT_EQ(fault.error().message, '"' + std::string{text} + "\": no such fault; see --help");
    }
}

TEST(Scenario, shouldBeAFaultALine) {
    const auto faults = parse_scenario("# warming up\n\nprint 10 stop\r\n  time 2 cover open\n#end\nframe 3 cut");
    ASSERT_TRUE(faults) << faults.error().message;
    ASSERT_EQ(faults->size(), 3U);
    EXPECT_EQ((*faults)[2].when.count, 3U);
    EXPECT_TRUE(parse_scenario("")->empty());
    const auto wrong = parse_scenario("print 1 stop\n\nprint 2 jump\n");
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().message, "line 3: \"print 2 jump\": no such fault; see --help");
}

} // namespace
} // namespace linefeed::simulator
