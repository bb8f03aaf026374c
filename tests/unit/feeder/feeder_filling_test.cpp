// From the grant to the first print: flush, stop point with read-back, first fill, start.
#include "story.hpp"

#include <gmock/gmock.h>

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(FeederFilling, shouldFlushOnlyWhatTheLedgerHasGranted) {
    Story story = reach(Phase::granting);
    story.rs(State::ready_to_print);
    story.sm(0, 77, 0);
    story.supplied(110);
    story.durable(110);
    story.settled();
    story.expect("");
    EXPECT_EQ(story.feeder.next_wake(), std::nullopt);
    story.granted();
    story.expect("!FF; ?SM");
}

TEST(FeederFilling, shouldWaitUntilTheFifoIsEmpty) {
    Story story = reach(Phase::flushing);
    story.sm(3, 77, 0); // one inquiry old
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.expect("=CM 110; ?SM");
}

TEST(FeederFilling, shouldStopWhenTheFifoDoesNotBecomeEmpty) {
    Story story = reach(Phase::flushing);
    story.sm(3, 77, 0);
    story.wait(seconds{2});
    story.expect("!ST; ?RS");
    story.judge(3, 77, true, 1000);
    story.expect("settle this run: printed none, in doubt none, unused none by nothing was issued; end: "
                 "fifo_not_flushed (ready for print start, error 0)");
}

TEST(FeederFilling, shouldNotGoOnWhenThePrinterHasPrintedSinceTheTruthWasTakenDown) {
    Story story = reach(Phase::flushing);
    story.sm(0, 78, 0);
    story.expect("!ST; ?RS");
    story.judge(0, 78, true, 1001);
    story.expect("settle this run: printed none, in doubt none, unused none by nothing was issued; "
                 "end: busy (ready for print start, error 0)");

    story = reach(Phase::flushing);
    story.sm(0, 0, 0); // a firmware that forgets the number with the FIFO
    story.expect("=CM 110; ?SM");
}

TEST(FeederFilling, shouldNotStartWhenThePrinterHasPrintedForSomebodyElseMeanwhile) {
    Story story = reach(Phase::verifying);
    story.sm(3, 78, 110); // once: it may be a damaged answer
    story.expect("?SM");
    story.sm(3, 77, 110);
    EXPECT_EQ(story.phase(), Phase::starting);

    story = reach(Phase::verifying);
    story.sm(3, 78, 110);
    story.sm(3, 78, 110);
    story.expect("?SM; !ST; ?RS");
    story.judge(3, 78, true, 1001);
    EXPECT_THAT(story.take(), testing::HasSubstr("in doubt 101-104")) << "the number tells nothing of ours";

    story = reach(Phase::setting_stop); // before anything is sent
    story.sm(0, 78, 110);
    story.expect("?SM");
    story.sm(0, 78, 110);
    story.expect("!ST; ?RS");
    story.judge(0, 78, true, 1001);
    EXPECT_THAT(story.take(), testing::HasSubstr("unused none by nothing was issued; end: busy"));
}

TEST(FeederFilling, shouldBelieveOnlyTheSecondAnswerAboutTheStopPoint) {
    Story story = reach(Phase::setting_stop);
    story.sm(0, 77, 0);
    story.expect("?SM");
    story.sm(0, 77, 110);
    EXPECT_EQ(story.phase(), Phase::loading);
}

TEST(FeederFilling, shouldGoOnWithoutAStopPointAndTryAgainWhilePrinting) {
    Story story = reach(Phase::setting_stop);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.expect("?SM");
    EXPECT_EQ(story.phase(), Phase::loading);
    story.supplied(110);
    story.sm(3, 77, 0);
    story.wait(milliseconds{4});
    story.take();
    story.rs(State::printing);
    story.expect("notice: printing; =CM 110");
}

TEST(FeederFilling, shouldWaitForTheWholeFirstFill) {
    Story story = reach(Phase::loading);
    story.supplied(103);
    story.durable(110);
    story.expect("");
    EXPECT_EQ(story.feeder.next_wake(), std::nullopt);
    story.supplied(104);
    story.expect("=MR 101-104; ?SM");
}

TEST(FeederFilling, shouldAskForTheIntentsOfTheFirstFill) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 200, 102);
    story.sm(0, 77, 0);
    story.take();
    story.sm(0, 77, 200);
    story.expect("intent through 116");
    story.supplied(200);
    story.expect("");
    story.durable(103);
    story.expect("");
    story.durable(116);
    story.expect("=MR 101-104; ?SM");
}

TEST(FeederFilling, shouldStartALongFifoWithTheRecordsAtHand) {
    Story story;
    story.reported_depth = 2000;
    story.arm_to_grant();
    story.granted(1, 100000, 512);
    story.sm(0, 77, 0);
    story.take();
    story.sm(0, 77, 100000);
    story.expect("intent through 8000");
    story.supplied(255);
    story.expect("");
    story.supplied(512);
    story.expect("=MR 1-512; ?SM");
}

TEST(FeederFilling, shouldBelieveOnlyTheSecondAnswerAboutTheFill) {
    Story story = reach(Phase::verifying);
    story.sm(0, 77, 110); // one inquiry old
    story.expect("?SM");
    story.sm(3, 77, 110);
    story.expect("");
    story.wait(milliseconds{3}); // the first product may come with the start
    story.expect("");
    story.wait(milliseconds{1});
    story.expect("!GO; ?RS; ?SM");
}

TEST(FeederFilling, shouldSayWhenThePrinterHoldsAnotherNumberOfEntries) {
    Story story = reach(Phase::verifying);
    story.sm(4, 77, 110);
    story.sm(4, 77, 110);
    story.expect("?SM; notice: the printer reports another number of FIFO entries than was sent");
    story.wait(milliseconds{4});
    story.expect("!GO; ?RS; ?SM");
}

TEST(FeederFilling, shouldNotStartWhenTheStopPointHasVanishedUnderTheFill) {
    Story story = reach(Phase::verifying); // somebody has started the printer and stopped it again
    story.sm(1, 77, 0);
    story.expect("?SM");
    story.sm(1, 77, 0);
    story.expect("!ST; ?RS");
    story.judge(1, 77, true, 1000);
    story.expect("settle this run so far: printed none by mail status; "
                 "settle this run: printed none, in doubt none, unused 101-104 by mail status; "
                 "end: stopped_at_printer (ready for print start, error 0)");

    story = reach(Phase::verifying);
    story.sm(3, 77, 0); // one inquiry old
    story.sm(3, 77, 110);
    EXPECT_EQ(story.phase(), Phase::starting);
}

/// Without a stop point only the entries tell that a stop may have thrown a part of the fill away.
TEST(FeederFilling, shouldAskTheCounterWhenEntriesAreMissingAndNoStopPointStands) {
    Story story;
    story.fill_without_stop_point();
    story.sm(2, 77, 0);
    story.sm(2, 77, 0);
    EXPECT_NE(story.take().find("another number of FIFO entries"), std::string::npos);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.sm(2, 77, 110); // kept from now on
    story.take();
    story.sm(0, 103, 110);
    EXPECT_NE(story.take().find("?CC; ?SM; ?SM"), std::string::npos);
    EXPECT_EQ(story.feeder.refill().printed_through(), RecordNumber{103});
}

/// Somebody has started and stopped a printer that keeps no stop point: the line would run dry at once.
TEST(FeederFilling, shouldNotStartWithAPartOfTheFill) {
    Story story = reach(Phase::verifying);
    story.sm(1, 77, 110);
    story.expect("?SM");
    story.sm(1, 77, 110);
    story.expect("!ST; ?RS");
    story.judge(1, 77, true, 1000);
    EXPECT_NE(story.take().find("unused 101-104 by mail status"), std::string::npos);
}

TEST(FeederFilling, shouldNotStartWithRecordsOfSomebodyElseInThePrinter) {
    Story story = reach(Phase::verifying);
    story.sm(5, 77, 110);
    story.expect("?SM");
    story.sm(5, 77, 110);
    story.expect("!ST; ?RS");
    story.judge(0, 77, true, 1000);
    EXPECT_NE(story.take().find("unused 101-104"), std::string::npos) << "nothing was printed";
}

/// As the manual's own example has it once.
TEST(FeederFilling, shouldGetUsedToAPrinterThatCountsTheLoadedRecordToo) {
    Story story = reach(Phase::verifying);
    story.sm(4, 77, 110);
    story.sm(4, 77, 110);
    story.wait(milliseconds{4});
    story.rs(State::printing);
    story.take();
    story.sm(3, 101, 110);
    story.sm(3, 101, 110);
    EXPECT_NE(story.take().find("=MR 105-105"), std::string::npos);
    story.sm(0, 106, 110); // it was not sent
    story.expect("!ST; ?RS");
}

TEST(FeederFilling, shouldStopWhenThePrinterTakesNoRecords) {
    Story story = reach(Phase::verifying);
    story.sm(0, 77, 110);
    story.sm(0, 77, 110);
    story.expect("?SM");
    for (int times = 0; times < 3; ++times) {
        story.wait(milliseconds{20});
        story.sm(0, 77, 110);
        story.expect("?SM");
    }
    story.wait(seconds{5});
    EXPECT_EQ(story.take().find("!ST; ?RS"), 0U);
    story.judge(0, 77, true, 1000);
    story.expect("settle this run so far: printed none by mail status; settle this run: printed none, in doubt none, "
                 "unused 101-104 by mail status; end: records_not_taken (ready for print start, error 0)");
}

TEST(FeederFilling, shouldStartWithASingleRecordThatIsLoadedAlready) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 101, 101);
    story.sm(0, 77, 0);
    story.sm(0, 77, 101);
    story.actions.clear();
    story.supplied(101);
    story.expect("=MR 101-101; ?SM");
    story.sm(0, 77, 101);
    story.wait(milliseconds{4});
    story.expect("!GO; ?RS; ?SM");
}

TEST(FeederFilling, shouldWaitForTheStart) {
    Story story = reach(Phase::starting);
    story.rs(State::ready_to_print);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS; ?SM");
    story.rs(State::ready_to_print, raw_error(10202, 1));
    EXPECT_EQ(story.take().find("notice: the printer reports 10202"), 0U) << "a warning is no reason to end";
    story.rs(State::ready_to_print, raw_error(10202, 1));
    story.expect("");
    story.wait(milliseconds{20});
    story.rs(State::printing, raw_error(10202, 1));
    story.expect("?RS; ?SM; notice: printing");
}

/// A printer that stands a second behind `!GO`; nothing that was asked before is still to be answered.
Story reach_standing_behind_go() {
    Story story = reach(Phase::starting);
    story.sm(3, 77, 104);
    story.now += seconds{1};
    story.rs(State::ready_to_print);
    story.take();
    return story;
}

bool starts_again(Story& story, std::uint32_t entries) {
    story.wait(milliseconds{50});
    story.sm(entries, 77, entries == 0 ? 0 : 104);
    return story.take().find("!GO") != std::string::npos;
}

/// On a serial line `!GO` may get lost.
TEST(FeederFilling, shouldStartAPrinterAgainThatStandsWithTheWholeFill) {
    Story story = reach_standing_behind_go();
    EXPECT_FALSE(starts_again(story, 3)) << "=SM may be one inquiry old";
    EXPECT_TRUE(starts_again(story, 3));
    story.rs(State::ready_to_print);
    EXPECT_FALSE(starts_again(story, 3) || starts_again(story, 3)) << "not so soon";
    story.now += seconds{1};
    story.rs(State::ready_to_print);
    EXPECT_FALSE(starts_again(story, 3));
    EXPECT_TRUE(starts_again(story, 3));
}

/// It may have begun, and an operator may have stopped it: that has emptied the FIFO.
TEST(FeederFilling, shouldNotStartAPrinterAgainThatWasStopped) {
    Story story = reach_standing_behind_go();
    EXPECT_FALSE(starts_again(story, 3));
    EXPECT_FALSE(starts_again(story, 0) || starts_again(story, 0));
}

/// A part of the fill is gone: what is left might be printed as if it were all.
TEST(FeederFilling, shouldNotStartAPrinterAgainThatHasAPartOfTheFill) {
    Story story = reach_standing_behind_go();
    EXPECT_FALSE(starts_again(story, 2) || starts_again(story, 2));
}

TEST(FeederFilling, shouldNotStartAPrinterAgainByAnswersFromBeforeItStood) {
    Story story = reach(Phase::starting);
    story.now += seconds{1}; // the first ?SM is not answered yet
    story.rs(State::ready_to_print);
    EXPECT_FALSE(starts_again(story, 3) || starts_again(story, 3)) << "the first was asked before";
    EXPECT_TRUE(starts_again(story, 3));
}

TEST(FeederFilling, shouldGiveUpAPrinterThatDoesNotStart) {
    Story story = reach(Phase::starting);
    story.rs(State::ready_to_print);
    story.wait(seconds{15});
    story.expect("!ST; ?RS");
    story.judge(3, 77, true, 1000);
    story.expect("settle this run so far: printed none by mail status; settle this run: printed none, in doubt none, "
                 "unused 101-104 by mail status; end: did_not_start (ready for print start, error 0)");
}

TEST(FeederFilling, shouldFindTheTruthWhenTheStartEndsInAnError) {
    Story story = reach(Phase::starting);
    story.rs(State::ready_to_print, raw_error(1018));
    story.expect("?RS");
    story.rs(State::ready_to_print, raw_error(1018));
    story.sm(0, 77, 0); // asked with the start
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.expect("?SM; ?SM; ?CC");
    story.cc(1000);
    story.clear_fifo(77, true, 1000, raw_error(1018));
    story.expect("settle this run so far: printed none by mail status; settle this run: printed none, in doubt none, "
                 "unused 101-104 by mail status; end: printer_error (ready for print start, error " +
                 std::to_string(raw_error(1018)) + ")");
}

TEST(FeederFilling, shouldFinishAShortRunThatIsOverBeforeAnyoneLooked) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 102, 102);
    story.sm(0, 77, 0);
    story.sm(0, 77, 102);
    story.supplied(102);
    story.sm(1, 77, 102);
    story.wait(milliseconds{4});
    story.take();
    story.rs(State::ready_to_print, end_message);
    story.rs(State::ready_to_print, end_message);
    story.say_where(0, 102);
    story.cc(1002);
    story.expect("settle this run: printed 101-102, in doubt none, unused none by end message 1223; !EQ; ?RS");
}

TEST(FeederFilling, shouldFinishAShortRunOfAPrinterWithoutEndMessage) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 102, 102);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0); // nor does it keep the stop point
    story.supplied(102);
    story.sm(1, 77, 0);
    story.wait(milliseconds{4});
    story.sm(0, 102, 0);
    story.cc(1002);
    story.take();
    story.rs(State::ready_to_print);
    story.expect("?RS");
    story.rs(State::ready_to_print);
    story.say_where(0, 102);
    story.cc(1002);
    story.expect("settle this run: printed 101-102, in doubt none, unused none by mail status and total print counter; "
                 "end: finished (ready for print start, error 0)");
}

TEST(FeederFilling, shouldRefillBeforeThePrinterSaysThatItPrints) {
    Story story = reach(Phase::starting);
    story.sm(3, 77, 110);
    story.expect("");
    story.sm(1, 102, 110);
    story.expect("printed through 102; =MR 105-106");
    story.sm(0, 103, 0); // has it been stopped? ?RS will tell
    story.expect("");
    story.rs(State::printing);
    EXPECT_EQ(story.take().find("notice: printing"), 0U);
    EXPECT_EQ(story.phase(), Phase::printing);
}

TEST(FeederFilling, shouldAnswerNothingThatWasNotAskedBeforeTheStart) {
    Story story = reach(Phase::verifying);
    story.sm(3, 77, 110);
    story.sm(1, 102, 110);
    story.rs(State::printing);
    story.expect("");
    EXPECT_EQ(story.phase(), Phase::starting);
}

using FeederDeathTest = testing::Test;

TEST(FeederDeathTest, shouldStartOnlyOnce) {
    Story story;
    story.start();
    EXPECT_DEATH(story.start(), "idle");
}

} // namespace
} // namespace linefeed::feeder
