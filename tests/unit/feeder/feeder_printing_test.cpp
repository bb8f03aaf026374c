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
    story.sm(3, 107, 110);
    story.expect("printed through 107; =MR 108-110");
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
    story.expect("settle: printed 110-110, in doubt none, unused none by end message 1223; !EQ; ?RS");
    story.rs(State::ready_to_print);
    story.expect("end: finished (ready for print start, error 0)");
}

TEST(FeederPrinting, shouldGiveTheReportWithTheConfirmation) {
    Story story = reach(Phase::printing);
    story.sm(2, 102, 110);
    const auto& confirm = std::get<ConfirmPrinted>(story.actions[0]);
    EXPECT_EQ(confirm.evidence, (protocol::MailStatus{4, 2, RecordNumber{102}, RecordNumber{110}, true, {}}));
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
    story.rs(State::printing);
    story.actions.clear();
    story.sm(3, 103, 110);
    story.expect("");
    EXPECT_EQ(story.feeder.refill().level(), RecordCount{4}) << "no credit from an old number";
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
    story.sm(1, 103, 110);
    story.expect("printed through 103; =MR 106-107");
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

TEST(FeederPrinting, shouldSendNothingBeforeItsIntentIsDurable) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 200, 104);
    story.sm(0, 77, 0);
    story.sm(0, 77, 200);
    story.supplied(200);
    story.sm(3, 77, 200);
    story.rs(State::printing);
    story.sm(3, 77, 200);
    story.take();
    story.sm(1, 103, 200);
    story.expect("printed through 103");
    story.durable(120);
    story.expect("=MR 105-107");
    story.sm(1, 107, 200);
    story.expect("printed through 107; =MR 108-111");
    story.sm(1, 111, 200);
    story.expect("printed through 111; =MR 112-115");
    story.sm(1, 115, 200);
    story.expect("printed through 115; intent through 131; =MR 116-119");
}

TEST(FeederPrinting, shouldRefillWhenPagesArrive) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 200, 200);
    story.sm(0, 77, 0);
    story.sm(0, 77, 200);
    story.supplied(104);
    story.sm(3, 77, 200);
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
    EXPECT_EQ(mail, 4);
    EXPECT_EQ(status, 1);
    EXPECT_EQ(story.feeder.next_wake(), std::nullopt) << "only an answer or its time-out goes on from here";
    story.sm(3, 77, 110);
    EXPECT_TRUE(story.wake());
    story.expect("?SM");
}

TEST(FeederPrinting, shouldPollSlowlyWhenOnlyTheStopPointIsAwaited) {
    Story story = reach(Phase::printing);
    story.sm(1, 104, 110);
    story.sm(1, 108, 110);
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
    story.rs(State::printing);
    story.sm(255, 77, 100000);
    for (std::uint32_t step = 1; step <= 100; ++step) {
        story.now += milliseconds{20};
        story.sm(246, step * 10, 100000);
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

// The stop point.

TEST(FeederPrinting, shouldStopBehindTheLastRecordWhenThePrinterKeepsItsStopPointButPrintsOn) {
    Story story = reach(Phase::printing);
    story.sm(1, 104, 110);
    story.sm(1, 108, 110);
    story.take();
    story.sm(0, 110, 110);
    story.expect("printed through 110; ?RS");
    story.sm(0, 110, 110);
    story.expect(""); // asked already
    story.rs(State::printing);
    story.now += milliseconds{501};
    story.sm(0, 110, 110);
    story.expect("!ST; ?RS");
    story.judge(0, 110, true, 1010);
    story.expect("settle: printed none, in doubt none, unused none by nothing was issued; "
                 "end: finished (ready for print start, error 0)");
}

/// Prints up to the answer in which the stop point is missing for the first time; the printer ignored it before the start.
Story printing_without_stop_point() {
    Story story = reach(Phase::setting_stop);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.supplied(110);
    story.sm(3, 77, 0);
    story.rs(State::printing);
    story.actions.clear();
    return story;
}

TEST(FeederPrinting, shouldSetTheStopPointAgainForAPrinterThatKeepsItOnlyWhilePrinting) {
    Story story = printing_without_stop_point();
    story.sm(3, 77, 0); // one inquiry old
    story.expect("");
    story.sm(3, 77, 110);
    story.expect("");
    story.sm(2, 101, 110);
    story.expect("printed through 101; =MR 105-105");
    story.sm(1, 104, 110);
    story.sm(1, 108, 110);
    story.sm(0, 110, 0);
    story.take();
    story.rs(State::ready_to_print, end_message);
    story.judge(0, 110, true, 1010, end_message);
    EXPECT_NE(story.take().find("by end message 1223; !EQ"), std::string::npos);
}

TEST(FeederPrinting, shouldQueueAnEndMarkerForAPrinterThatIgnoresTheStopPoint) {
    Story story = printing_without_stop_point();
    story.sm(3, 77, 0);
    story.expect("");
    story.sm(3, 77, 0);
    story.expect("=CM 110");
    story.sm(3, 77, 0);
    story.sm(3, 77, 0);
    story.expect("=CM 110");
    story.sm(3, 77, 0);
    story.expect("");
    story.sm(3, 77, 0);
    EXPECT_EQ(story.take().find("notice: the printer does not keep the stop point"), 0U);
    story.sm(3, 77, 0);
    story.expect("");
    story.sm(1, 103, 0);
    story.expect("printed through 103; =MR 105-107");
    story.sm(1, 105, 0);
    story.expect("printed through 105; =MR 108-109");
    story.sm(1, 106, 0);
    story.expect("printed through 106; =MR 110-110"); // full: the marker must wait for room
    story.sm(2, 107, 0);
    story.expect("printed through 107; end marker 111");
    story.sm(2, 109, 0);
    story.expect("printed through 109");
    story.sm(1, 110, 0);
    story.expect("printed through 110; !ST; ?RS");
    story.judge(0, 110, true, 1010);
    story.expect("settle: printed none, in doubt none, unused none by nothing was issued; "
                 "end: finished (ready for print start, error 0)");
}

Story printing_with_marker() {
    Story story = printing_without_stop_point();
    for (int answers = 0; answers < 6; ++answers) {
        story.sm(3, 77, 0);
    }
    story.sm(1, 104, 0);
    story.sm(1, 108, 0);
    EXPECT_NE(story.take().find("end marker 111"), std::string::npos);
    return story;
}

TEST(FeederPrinting, shouldTakeAPrintedEndMarkerForTheProofOfTheLastRecord) {
    Story story = printing_with_marker();
    story.sm(0, 111, 0, false);
    story.expect("printed through 110; !ST; ?RS");
    story.rs(State::ready_to_print);
    story.rs(State::ready_to_print);
    story.sm(0, 111, 0, false);
    story.expect("?RS; ?SM; ?SM");
    story.sm(0, 111, 0, false);
    story.expect(""); // the blank product is given the time to be finished
    story.wait(milliseconds{20});
    story.sm(0, 111, 0);
    story.expect("?SM; ?CC");
}

TEST(FeederPrinting, shouldFinishWithAPrintedEndMarker) {
    Story story = printing_with_marker();
    story.sm(0, 111, 0);
    story.expect("printed through 110; !ST; ?RS");
    story.judge(0, 111, true, 1011);
    story.expect("settle: printed none, in doubt none, unused none by nothing was issued; "
                 "end: finished (ready for print start, error 0)");
}

TEST(FeederPrinting, shouldFindTheEndMarkerPrintedOnlyWhenJudging) {
    Story story = printing_with_marker();
    story.rs(State::ready_to_print, raw_error(5043));
    story.judge(0, 111, true, 1011, raw_error(5043));
    story.expect("settle: printed 109-110, in doubt none, unused none by mail status; end: finished (ready for print start, "
                 "error " + std::to_string(raw_error(5043)) + ")");
}

TEST(FeederPrinting, shouldNotTakeAnyNumberBehindTheLastForItsEndMarker) {
    Story story = printing_with_marker();
    story.sm(0, 112, 0);
    story.expect("!ST; ?RS");
    story.judge(0, 112, true, 1012);
    story.expect("settle: printed none, in doubt 109-110, unused none by no evidence; "
                 "end: impossible_report (ready for print start, error 0)");
}

TEST(FeederPrinting, shouldQueueNoEndMarkerBehindTheLargestNumber) {
    constexpr std::uint32_t max = 4294967295U;
    Story story;
    story.arm_to_grant();
    story.granted(max - 1, max, max);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.supplied(max);
    story.sm(1, 77, 0);
    story.rs(State::printing);
    story.take();
    for (int answers = 0; answers < 7; ++answers) {
        story.sm(1, 77, 0);
    }
    const std::string told = story.take();
    EXPECT_NE(told.find("does not keep the stop point"), std::string::npos);
    EXPECT_EQ(told.find("; end marker"), std::string::npos);
    story.sm(0, max, 0);
    story.expect("printed through 4294967295; !ST; ?RS");
}

TEST(FeederPrinting, shouldStopAtOnceBehindTheLastRecordWhileTheStopPointIsUncertain) {
    Story story = printing_without_stop_point();
    story.sm(3, 77, 0);
    story.sm(1, 104, 0);
    story.sm(1, 108, 0);
    story.take();
    story.sm(0, 110, 0);
    story.expect("printed through 110; =CM 110; !ST; ?RS");
}

TEST(FeederPrinting, shouldSuspectAStopWhenTheStopPointVanishes) {
    Story story = reach(Phase::printing);
    story.sm(1, 103, 0);
    story.expect("?RS"); // no refill into a FIFO that the stop has emptied, and no number is believed
    story.sm(1, 104, 0);
    story.supplied(110);
    story.durable(110);
    story.expect("");
    story.rs(State::ready_to_print);
    story.expect("?RS");
    story.judge(0, 104, true, 1004);
    story.expect("settle: printed 101-104, in doubt none, unused none by mail status and total print counter; "
                 "end: stopped_at_printer (ready for print start, error 0)");
}

TEST(FeederPrinting, shouldForgetTheSuspicionWhenTheStopPointIsBack) {
    Story story = reach(Phase::printing);
    story.sm(1, 103, 0);
    story.sm(1, 103, 110);
    story.expect("?RS; printed through 103; =MR 105-107");
    story.rs(State::printing);
    story.expect("");
    EXPECT_EQ(story.phase(), Phase::printing);
}

TEST(FeederPrinting, shouldSetAStopPointAgainThatWasKeptOnlyBeforeTheStart) {
    Story story = reach(Phase::starting);
    story.rs(State::printing);
    story.take();
    story.sm(3, 77, 0);
    story.expect("?RS");
    story.rs(State::printing);
    story.expect("");
    story.sm(3, 77, 0);
    story.expect("");
    story.sm(2, 101, 0);
    story.expect("printed through 101; =CM 110; =MR 105-105");
    story.sm(2, 102, 110);
    story.expect("printed through 102; =MR 106-106");
}

TEST(FeederPrinting, shouldStopAPrinterThatWasStoppedAndStartedAgainBehindOurBack) {
    Story story = reach(Phase::printing);
    story.sm(1, 103, 110);
    story.expect("printed through 103; =MR 105-107");
    // A stop has thrown 104 away; 105-107 arrived behind it; then somebody started the printer again.
    story.sm(1, 105, 0);
    story.expect("?RS");
    story.rs(State::printing);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS; ?SM");
    story.rs(State::printing);
    story.sm(0, 106, 0);
    story.expect("");
    story.wait(milliseconds{500});
    story.take();
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 106, true, 1005);
    story.expect("settle: printed none, in doubt 104-107, unused none by no evidence; "
                 "end: stopped_at_printer (ready for print start, error 0)");
}

TEST(FeederPrinting, shouldFinishWhenAPrinterClearsTheStopPointBehindTheLastRecordAndSaysThatItPrints) {
    Story story = reach(Phase::printing);
    story.sm(1, 104, 110);
    story.sm(1, 108, 110);
    story.take();
    story.sm(0, 110, 0);
    story.expect("?RS");
    story.rs(State::printing);
    story.wait(milliseconds{501});
    story.take();
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 110);
    story.expect("settle: printed 109-110, in doubt none, unused none by mail status; "
                 "end: finished (ready for print start, error 0)");
}

TEST(FeederPrinting, shouldStopWhenSomebodyElseSetsTheStopPoint) {
    Story story = reach(Phase::printing);
    story.sm(1, 103, 500);
    story.expect("?RS");
    story.rs(State::printing);
    story.wait(milliseconds{501});
    story.take();
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 104, true, 1004);
    EXPECT_NE(story.take().find("end: impossible_report"), std::string::npos);
}

} // namespace
} // namespace linefeed::feeder
