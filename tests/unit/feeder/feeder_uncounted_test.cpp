// A printer without total print counter: nothing counts what it throws away when somebody stops it and starts it again.
// Only its stop point shows that, and the FIFO before the start.
#include "story.hpp"

#include <gmock/gmock.h>

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;

/// The first fill is sent.
Story filled() {
    Story story;
    story.identify();
    story.locate(77, std::nullopt);
    story.granted();
    story.flush_and_set_stop();
    story.supplied(Story::last);
    story.take();
    return story;
}

Story printing() {
    Story story = filled();
    story.sm(3, 77, 110);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.take();
    return story;
}

FeederPlan takeover_plan() {
    FeederPlan plan = plan_with(earlier_run());
    plan.take_over = true;
    plan.open->total_before.reset();
    return plan;
}

TEST(FeederUncounted, shouldConfirmWhatIsReportedWhileTheStopPointStands) {
    Story story = printing();
    story.sm(2, 101, 110);
    story.expect("=MR 105-105"); // one answer may be damaged
    story.sm(3, 101, 110);
    story.expect("printed through 101");
    story.stop();
    story.expect("!ST; ?RS");
    story.judge(1, 103);
    story.expect(
        "settle this run so far: printed 102-103 by mail status; settle this run: printed none, in doubt none, "
        "unused 104-105 by mail status; end: stop_requested (ready for print start, error 0)");
}

TEST(FeederUncounted, shouldNotStartWithARecordLessThanWasSent) {
    Story story = filled();
    story.sm(2, 77, 110); // the first may be lost on a serial line
    story.sm(2, 77, 110);
    story.expect("?SM; !ST; ?RS");
}

TEST(FeederUncounted, shouldTakeAStopPointThatVanishesBehindTheStartForAStop) {
    Story story = printing();
    story.sm(2, 101, 0);
    story.expect("?RS");
    story.rs(State::printing);
    story.wait(milliseconds{500});
    story.take();
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 104);
    EXPECT_NE(story.take().find("in doubt 101-104"), std::string::npos);
}

TEST(FeederUncounted, shouldDoubtWhatIsPrintedBehindAStop) {
    Story story = printing();
    story.sm(2, 101, 110); // 102-104 are in the printer, and 105 is sent
    story.sm(0, 101, 0);   // stopped: they are gone
    story.take();
    story.sm(0, 105, 0); // started again: 105 came too late to be thrown away
    story.judge(0, 105);
    EXPECT_NE(story.take().find("in doubt 101-105"), std::string::npos);

    for (const std::uint32_t number : {104U, 105U}) { // stopped, and perhaps started again, between two answers
        story = printing();
        story.sm(2, 101, 110);
        story.take();
        story.judge(0, number);
        const bool all_were_in_the_printer = story.take().find("in doubt none, unused 105-105") != std::string::npos;
        EXPECT_EQ(all_were_in_the_printer, number == 104);
    }
}

TEST(FeederUncounted, shouldStopWhenARecordIsMissingInThePrinter) {
    Story story = printing();
    story.sm(2, 101, 110);
    story.expect("=MR 105-105");
    for (int answers = 0; answers < 6 && story.phase() == Phase::printing; ++answers) {
        story.take();
        story.wait(milliseconds{40});
        story.sm(2, 101, 110); // it holds 104 at most
    }
    EXPECT_NE(story.take().find("!ST; ?RS"), std::string::npos);
    story.judge(0, 104);
    EXPECT_NE(story.take().find("in doubt none, unused 105-105"), std::string::npos) << "it stops before the gap";
}

TEST(FeederUncounted, shouldDoubtTheNumberOfAPrinterThatFindsItsNumbersOutOfOrder) {
    for (const std::uint32_t error : {1018U, 1019U, 4711U}) {
        Story story = printing();
        story.sm(2, 101, 110);
        story.take();
        story.judge(0, 103, true, std::nullopt, raw_error(error)); // another client's 103, behind our 104?
        const std::string verdict = error == 4711 ? "unused 104-105" : "in doubt 101-105";
        EXPECT_THAT(story.take(), testing::HasSubstr(verdict)) << error;
    }
}

TEST(FeederUncounted, shouldDoubtWhatMayHaveBeenSkippedBehindAnEmptyFifo) {
    for (const std::uint32_t next : {105U, 106U}) {
        Story story = printing();
        story.sm(0, 104, 110); // empty, or one is loaded
        story.supplied(Story::last);
        story.take();
        story.sm(0, next, 110); // 105 is next; 106 may have come first if 105 was lost on its way
        const bool stopped = story.take().find("!ST; ?RS") != std::string::npos;
        EXPECT_EQ(stopped, next == 106);
        story.judge(0, next);
        const std::string doubt = next == 105 ? "in doubt none" : "in doubt 105-108";
        EXPECT_THAT(story.take(), testing::HasSubstr(doubt)) << next;
    }
}

TEST(FeederUncounted, shouldBelieveALeapOverRecordsThatWereSeenInThePrinter) {
    Story story = printing();
    story.sm(0, 101, 110); // perhaps damaged: it held up to 104 before
    story.take();
    story.sm(0, 104, 110);
    EXPECT_EQ(story.take().find("!ST"), std::string::npos);
}

TEST(FeederUncounted, shouldPrintARecordOnceMoreWhoseNumberStandsThereFromBefore) {
    Story story; // the print of 101 was broken off; the operator has it printed again
    story.identify();
    story.locate(101, std::nullopt);
    story.granted();
    story.sm(0, 101, 0, false);
    story.sm(0, 101, 110, false);
    story.supplied(Story::last);
    story.sm(3, 101, 110, false);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    for (int answers = 0; answers < 4; ++answers) {
        story.sm(2, 101, 110); // printed: nothing is missing
    }
    story.take();
    story.sm(1, 102, 110);
    story.expect("=MR 105-106");
}

TEST(FeederUncounted, shouldAskAgainForACounterThatOnlyGotDamaged) {
    Story story;
    story.identify();
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.take();
    story.feeder.on_counters({.product = 0, .stop_after = 1000, .total = {}}, story.now, story.actions);
    story.expect("?CC");
    story.cc(1000);
    EXPECT_EQ(story.phase(), Phase::granting);
    EXPECT_EQ(std::get<BeginRun>(story.actions[0]).printer.total_prints, 1000U);

    story = reach(Phase::printing);
    story.sm(0, 104, 110);
    story.take();
    story.cc(std::nullopt); // proves nothing
    story.expect("");
}

TEST(FeederUncounted, shouldDoubtWhatIsPrintedBetweenTheLooks) {
    Story story = printing();
    story.stop();
    story.judge_unsettled(2, 102);
    story.clear_fifo(104); // somebody has started it before the flush
    EXPECT_NE(story.take().find("in doubt 103-104"), std::string::npos);
}

TEST(FeederUncounted, shouldTakeNoUnfinishedPrintOverForSure) {
    for (const bool finished : {true, false}) {
        Story story{quick_settings(), takeover_plan()};
        story.reported_depth = 16;
        story.identify(State::printing);
        story.sm(3, 150, 200);
        story.sm(3, 150, 200);
        story.take();
        story.cc(std::nullopt);
        story.sm(2, 151, 200, finished);
        story.sm(2, 151, 200, finished);
        const std::string adopted = finished ? "printed through 151" : "printed through 150";
        EXPECT_NE(story.take().find("adopt run, " + adopted), std::string::npos);
    }
}

TEST(FeederUncounted, shouldBelieveTheNumbersOfAPrinterWhoseCounterAppearsInMidRun) {
    Story story = printing();
    story.sm(1, 102, 110);
    story.sm(3, 102, 110);
    EXPECT_NE(story.take().find("printed through 102"), std::string::npos);
    for (int looks = 0; looks < 3; ++looks) {
        story.cc(1); // nobody knows where it began, so it cannot be behind
        story.wait(CounterProof::patience);
        story.sm(3, 102, 110);
    }
    EXPECT_EQ(story.take().find("!ST"), std::string::npos);
    EXPECT_EQ(story.phase(), Phase::printing);
}

TEST(FeederUncounted, shouldTakeOverOnlyWhereTheStopPointStands) {
    for (const std::uint32_t stop_at : {200U, 0U, 151U}) {
        Story story{quick_settings(), takeover_plan()};
        story.reported_depth = 16;
        story.identify(State::printing);
        story.sm(3, 150, stop_at);
        story.sm(3, 150, stop_at);
        story.take();
        story.cc(std::nullopt);
        story.sm(2, 151, stop_at);
        story.sm(2, 151, stop_at);
        const bool taken_over = story.take().find("adopt run") != std::string::npos;
        EXPECT_EQ(taken_over, stop_at == 200) << stop_at;
    }
}

} // namespace
} // namespace linefeed::feeder
