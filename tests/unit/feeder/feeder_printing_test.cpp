// The feeder while the printer prints: reports, refills, the beat, and the stop point in all its ways.
#include "story.hpp"

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(FeederPrinting, shouldFollowTheManualToTheEnd) {
    Story story = reach(Phase::printing);
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
    story.sm(1, 103, 110);
    story.expect("printed through 103; =MR 106-107");
    story.sm(1, 105, 110);
    story.expect("printed through 105; =MR 108-109");
    story.sm(0, 108, 110);
    story.expect("printed through 108; =MR 110-110");
    story.sm(0, 109, 110);
    story.expect("printed through 109");
    story.sm(0, 110, 0); // the stop has cleared the stop point
    story.expect("?RS");
    story.rs(State::ready_to_print, end_message);
    story.expect("?RS");
    story.rs(State::ready_to_print, end_message);
    story.expect("?SM");
    story.sm(0, 110, 0);
    story.expect("?SM");
    story.sm(0, 110, 0);
    story.expect("?CC");
    story.cc(1010);
    story.expect("settle this run: printed 110-110, in doubt none, unused none by end message 1223; !EQ; ?RS");
    story.rs(State::ready_to_print);
    story.expect("end: finished (ready for print start, error 0)");
}

TEST(FeederPrinting, shouldTellTheStatusAsLastReported) {
    Story story = reach(Phase::printing);
    EXPECT_EQ(story.feeder.machine().machine, State::printing);
    story.rs(State::printing, raw_error(4711, 1), true);
    EXPECT_EQ(story.feeder.machine().error.code(), 4711U);
    EXPECT_TRUE(story.feeder.machine().cover_open);
}

TEST(FeederPrinting, shouldGiveTheReportWithTheConfirmation) {
    Story story = reach(Phase::printing);
    story.sm(1, 102, 110);
    const auto& confirm = std::get<ConfirmPrinted>(story.actions[0]);
    EXPECT_EQ(confirm.evidence, (protocol::MailStatus{4, 1, RecordNumber{102}, RecordNumber{110}, true, {}}));
}

TEST(FeederPrinting, shouldNotTakeTheNumberFromBeforeForAReport) {
    Story story = reach(Phase::printing);
    story.sm(3, 77, 110);
    story.expect("");
    story.sm(3, 0, 110); // a firmware that starts from 0
    story.expect("");
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
}

TEST(FeederPrinting, shouldNotTakeANumberFromBeforeThatLiesWithinTheRunForAReport) {
    Story story;
    story.identify();
    story.locate(103);
    story.granted();
    story.sm(0, 103, 0);
    story.sm(0, 103, 110);
    story.supplied(110);
    story.sm(3, 103, 110);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.actions.clear();
    story.sm(3, 103, 110);
    story.expect("");
    EXPECT_EQ(story.feeder.refill().level(), RecordCount{4}) << "no credit from an old number";
    for (int times = 0; times < 2; ++times) {
        story.sm(3, 10, 110);
        story.expect("");
        story.sm(3, 103, 110);
        story.expect(""); // a digit had been lost on the line
    }
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
    story.sm(1, 103, 110);
    story.expect("printed through 103; =MR 106-107");
}

/// Of `=SM4 3 102 110 1` a serial line may lose a TAB or a digit. What is left does not fit what was sent.
TEST(FeederPrinting, shouldBelieveANumberThatDoesNotFitOnlyWhenItIsRepeated) {
    Story story = reach(Phase::printing);
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
    story.sm(3, 103, 110); // more than were sent
    story.expect("");
    story.sm(2, 10, 110); // it goes back
    story.expect("");
    story.sm(3, 104, 110); // more than were sent, but not as many as before
    story.expect("");
    story.sm(3, 101, 110);
    story.expect("");
    story.sm(2, 102, 110);
    story.expect("printed through 102; =MR 106-106");
    story.sm(3, 103, 110); // there is one more than was sent: somebody else feeds the printer
    story.sm(3, 103, 110);
    story.expect("!ST; ?RS");
    story.judge(0, 103, true, 1003);
    EXPECT_NE(story.take().find("in doubt 103-106"), std::string::npos);
}

TEST(FeederPrinting, shouldStopWhenThePrinterHasNoRoomForWhatItShouldHaveRoomFor) {
    const std::int32_t no_room = raw_error(protocol::error_code::buffer_full, 1);
    Story story = reach(Phase::printing);
    story.sm(2, 101, 110);
    story.take();
    story.wait(milliseconds{500});
    story.take();
    story.rs(State::printing, no_room);
    story.expect("!ST; ?RS");
    story.judge(0, 103, true, 1003, no_room);
    EXPECT_NE(story.take().find("in doubt 102-105"), std::string::npos);

    story = reach(Phase::printing); // the printer has stopped before it could be seen
    story.judge(0, 103, true, 1003, no_room);
    EXPECT_NE(story.take().find("in doubt 101-104"), std::string::npos);
}

/// `=MR 104` gets lost on a serial line: the entries show it, and the counter settles it.
TEST(FeederPrinting, shouldAskTheCounterWhenARecordIsMissingInThePrinter) {
    Story story = reach(Phase::printing);
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
    const auto one_is_missing = [&story](std::uint32_t entries, std::uint32_t last_printed) {
        for (int answers = 0; answers < 6; ++answers) { // each may be as old as the inquiry before
            story.wait(milliseconds{40});
            story.sm(entries, last_printed, 110);
        }
        return story.take();
    };
    EXPECT_NE(one_is_missing(1, 102).find("printed through 102; =MR 106-106"), std::string::npos) << "it is printed";
    const std::string at_105 = one_is_missing(0, 105);
    EXPECT_NE(at_105.find("?CC; ?SM; ?SM"), std::string::npos);
    EXPECT_EQ(at_105.find("printed through"), std::string::npos);
    story.cc(1004);
    EXPECT_EQ(one_is_missing(0, 105).find("printed through"), std::string::npos);
    story.cc(1004);
    story.expect("!ST; ?RS");
}

TEST(FeederPrinting, shouldConfirmARecordOnlyWhenItsPrintHasFinished) {
    Story story = reach(Phase::printing);
    story.sm(2, 101, 110, false);
    story.expect("=MR 105-105"); // it has left the FIFO, but it is not on the product
    story.sm(2, 101, 110);
    story.expect("printed through 101");
    story.sm(1, 103, 110, false);
    story.expect("printed through 102; =MR 106-107");
    story.sm(1, 103, 110, false);
    story.expect("");
}

TEST(FeederPrinting, shouldCountBeforeItBelievesANumberBehindAnAllButEmptyFifo) {
    Story story = reach(Phase::printing);
    story.sm(0, 104, 110);
    story.expect("printed through 104; =MR 105-108");
    story.sm(1, 106, 110); // 105 may be lost on its way
    story.expect("=MR 109-110; ?CC; ?SM; ?SM");
    story.cc(1005); // 106 is only the fifth
    story.sm(1, 106, 110);
    story.sm(1, 106, 110);
    story.expect("");

    story = reach(Phase::printing);
    story.sm(0, 104, 110);
    story.sm(1, 106, 110);
    story.take();
    story.cc(1006);
    story.sm(1, 106, 110);
    story.expect("");
    story.sm(1, 106, 110);
    story.expect("printed through 106");
}

TEST(FeederPrinting, shouldSendNothingBeforeItsIntentIsDurable) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 200, 104);
    story.sm(0, 77, 0);
    story.sm(0, 77, 200);
    story.supplied(200);
    story.sm(3, 77, 200);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.sm(3, 77, 200);
    story.take();
    story.sm(0, 103, 200);
    story.expect("printed through 103");
    story.durable(120);
    story.expect("=MR 105-107");
    story.sm(1, 105, 200);
    story.expect("printed through 105; =MR 108-109");
    story.sm(1, 107, 200);
    story.expect("printed through 107; =MR 110-111");
    story.sm(1, 109, 200);
    story.expect("printed through 109; =MR 112-113");
    story.sm(1, 111, 200);
    story.expect("printed through 111; intent through 129; =MR 114-115");
}

TEST(FeederPrinting, shouldRefillWhenPagesArrive) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 200, 200);
    story.sm(0, 77, 0);
    story.sm(0, 77, 200);
    story.supplied(104);
    story.sm(3, 77, 200);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.sm(3, 77, 200);
    story.sm(0, 104, 200);
    story.take();
    story.supplied(106);
    story.expect("=MR 105-106");
}

TEST(FeederPrinting, shouldIgnorePagesAndIntentsBeforeTheGrant) {
    Story story = reach(Phase::locating);
    story.supplied(110);
    story.durable(110);
    story.expect("");
}

TEST(FeederPrinting, shouldPollAtTheBeatOfTheLine) {
    Story story = reach(Phase::printing);
    story.answer_time = {};
    int polls = 0;
    const Instant begin = story.now;
    while (story.now < begin + seconds{1}) {
        ASSERT_TRUE(story.wake());
        for (const Action& action : story.actions) {
            polls += action == Action{Inquire{protocol::Parameter::SM}} ? 1 : 0;
        }
        story.actions.clear();
        story.sm(3, 77, 110);
        story.actions.clear();
    }
    // 4 records at the burst rate of 1000 a second, 8 polls in that time, but at least 1 ms apart.
    EXPECT_GT(polls, 900);
    EXPECT_LT(polls, 1100);
}

TEST(FeederPrinting, shouldAskForTheMachineStateAtItsOwnBeat) {
    Story story = reach(Phase::printing);
    const Instant begin = story.now;
    int asked = 0;
    while (story.now < begin + seconds{5}) {
        ASSERT_TRUE(story.wake());
        bool status = false;
        for (const Action& action : story.actions) {
            status = status || action == Action{Inquire{protocol::Parameter::RS}};
        }
        story.actions.clear();
        story.sm(3, 77, 110);
        if (status) {
            ++asked;
            story.rs(State::printing);
        }
        story.expect("");
    }
    EXPECT_NEAR(asked, 10, 1);
}

TEST(FeederPrinting, shouldNotPileUpInquiriesThatAreNotAnswered) {
    Story story = reach(Phase::printing);
    int mail = 0;
    int status = 0;
    for (int wakes = 0; wakes < 100 && story.wake(); ++wakes) {
        for (const Action& action : story.actions) {
            mail += action == Action{Inquire{protocol::Parameter::SM}} ? 1 : 0;
            status += action == Action{Inquire{protocol::Parameter::RS}} ? 1 : 0;
        }
        story.actions.clear();
    }
    EXPECT_EQ(mail, 16);
    EXPECT_EQ(status, 1);
    EXPECT_EQ(story.feeder.next_wake(), std::nullopt) << "only an answer or its time-out goes on from here";
    story.sm(3, 77, 110);
    EXPECT_TRUE(story.wake());
    story.expect("?SM");
}

TEST(FeederPrinting, shouldPollSlowlyWhenOnlyTheStopPointIsAwaited) {
    Story story = reach(Phase::printing);
    story.sm(0, 104, 110);
    story.sm(0, 108, 110);
    story.take();
    ASSERT_TRUE(story.feeder.refill().all_sent());
    EXPECT_GE(*story.feeder.next_wake() - story.now, milliseconds{20});
}

TEST(FeederPrinting, shouldMeasureTheRate) {
    Story story;
    story.reported_depth = 256;
    story.arm_to_grant();
    story.granted(1, 100000, 100000);
    story.sm(0, 77, 0);
    story.sm(0, 77, 100000);
    story.supplied(100000);
    story.sm(255, 77, 100000);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.sm(255, 77, 100000);
    for (std::uint32_t step = 1; step <= 100; ++step) {
        story.now += milliseconds{15};
        story.sm(245, step * 10, 100000);
        story.take();
    }
    EXPECT_NEAR(story.feeder.rate(), 500.0, 10.0);
    EXPECT_EQ(story.feeder.mail().last_printed, RecordNumber{1000});
}

TEST(FeederPrinting, shouldTellAWarningOnceAndPrintOn) {
    Story story = reach(Phase::printing);
    story.rs(State::printing, raw_error(10202, 1));
    EXPECT_EQ(story.take().find("notice: the printer reports 10202"), 0U);
    story.rs(State::printing, raw_error(10202, 1));
    story.expect("");
    story.rs(State::printing);
    story.expect("");
    EXPECT_EQ(story.phase(), Phase::printing);
}

} // namespace
} // namespace linefeed::feeder
