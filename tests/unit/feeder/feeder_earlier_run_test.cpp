// The truth about an earlier run: taken down before anything is flushed, whatever state the printer is found in.
#include "story.hpp"

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(FeederEarlierRun, shouldSettleTheEarlierRunBeforeTheGrant) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 950);
    story.expect("settle the earlier run so far: printed 101-150 by mail status and total print counter");
    story.settled();
    story.expect("!FF; ?RS");
    story.rs(State::ready_to_print);
    story.expect("?SM");
    story.sm(0, 150, 0);
    story.expect("?SM");
    story.sm(0, 150, 0);
    story.expect("?CC");
    story.cc(950);
    story.expect("settle the earlier run: printed none, in doubt none, unused 151-200 by mail status and total print "
                 "counter; begin run, last printed before 150");
}

TEST(FeederEarlierRun, shouldNotFlushWhatIsPrintedInFull) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(200, 1000);
    story.expect("settle the earlier run: printed 101-200, in doubt none, unused none by mail status and total print "
                 "counter; begin run, last printed before 200");
}

TEST(FeederEarlierRun, shouldNotFlushAnotherPrinterForTheEarlierRun) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.start();
    story.rs(State::ready_to_print);
    story.vs("S2");
    story.jl();
    story.locate(150, 950);
    EXPECT_EQ(story.take().find("settle the earlier run: printed none, in doubt 101-200, unused none by no evidence; "
                                "end: records_in_doubt"),
              0U);
}

TEST(FeederEarlierRun, shouldFindRecordsThatSomebodyStartsBeforeTheFlush) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 950);
    story.settled();
    story.take();
    story.rs(State::printing); // started at the panel before the flush came
    story.expect("?SM");
    story.sm(0, 152, 0);
    story.sm(0, 152, 0);
    story.cc(952);
    EXPECT_EQ(story.phase(), Phase::halting);
    story.rs(State::ready_to_print);
    story.take();
    story.locate(153, 953);
    story.expect("settle the earlier run so far: printed 151-153 by mail status and total print counter");
    story.clear_fifo(153, true, 953);
    story.expect("settle the earlier run: printed none, in doubt none, unused 154-200 by mail status and total print "
                 "counter; begin run, last printed before 153");
}

TEST(FeederEarlierRun, shouldKeepTheFirstLookWhenTheFlushMakesThePrinterForgetItsNumber) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 950);
    story.take();
    story.clear_fifo(0, true, 950);
    story.expect("settle the earlier run: printed none, in doubt none, unused 151-200 by mail status and total print "
                 "counter; begin run, last printed before 0");
}

TEST(FeederEarlierRun, shouldNotKeepTheFirstLookWhenTheCounterHasMovedSince) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 950);
    story.take();
    story.clear_fifo(0, true, 951);
    EXPECT_EQ(story.take().find("settle the earlier run: printed none, in doubt 151-152, unused 153-200 by total"), 0U);
}

TEST(FeederEarlierRun, shouldLeaveTheRunOpenWhenTheFifoCannotBeFlushed) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 950);
    story.settled();
    story.take();
    story.rs(State::ready_to_print);
    story.sm(9, 150, 0);
    story.sm(9, 150, 0);
    story.expect("?SM; ?SM");
    story.wait(milliseconds{20});
    story.sm(9, 150, 0);
    story.expect("?SM");
    story.wait(seconds{2});
    story.sm(9, 150, 0);
    story.expect("?SM; end: fifo_not_flushed (ready for print start, error 0)");
}

TEST(FeederEarlierRun, shouldGiveTheEvidenceToTheLedger) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 950);
    const auto& settle = std::get<Settle>(story.actions[0]);
    EXPECT_TRUE(settle.earlier_run);
    EXPECT_EQ(settle.evidence.mail.last_printed, RecordNumber{150});
    EXPECT_EQ(settle.evidence.printer.total_prints, 950U);
    EXPECT_FALSE(settle.evidence.uninterrupted);
    EXPECT_FALSE(settle.evidence.end_message);
}

TEST(FeederEarlierRun, shouldSettleTheEarlierRunEvenWhenItMayNotStart) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify(State::ready);
    story.sm(9, 150, 200);
    story.sm(9, 150, 200);
    story.take();
    story.cc(950);
    story.expect("settle the earlier run so far: printed 101-150 by mail status and total print counter");
    story.settled();
    story.take();
    story.rs(State::ready);
    story.sm(0, 150, 0);
    story.sm(0, 150, 0);
    story.take();
    story.cc(950);
    story.expect("settle the earlier run: printed none, in doubt none, unused 151-200 by mail status and total print "
                 "counter; end: not_ready (ready for action, error 0)");
}

TEST(FeederEarlierRun, shouldPrintNothingWhileRecordsAreInDoubt) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 5000);
    story.expect("settle the earlier run so far: printed none by no evidence");
    story.clear_fifo(150, true, 5000);
    story.expect("settle the earlier run: printed none, in doubt 101-200, unused none by no evidence; "
                 "end: records_in_doubt (ready for print start, error 0)");
}

TEST(FeederEarlierRun, shouldLeaveTheRunOpenWhenTheLedgerOrTheLinkIsGone) {
    const auto reach_recording = [](bool flush) {
        Story story{quick_settings(), plan_with(earlier_run())};
        story.identify();
        story.locate(150, 950);
        if (flush) {
            story.settled();
        }
        story.take();
        EXPECT_EQ(story.phase(), flush ? Phase::clearing : Phase::recording);
        return story;
    };
    for (const bool flush : {false, true}) {
        Story story = reach_recording(flush);
        story.link_lost();
        story.expect("end: link_lost (ready for print start, error 0)");
        story = reach_recording(flush);
        story.storage_failed();
        story.expect("end: storage_failed (ready for print start, error 0)");
        story = reach_recording(flush);
        story.stop();
        story.expect("end: stop_requested (ready for print start, error 0)");
    }
}

TEST(FeederEarlierRun, shouldGoOnWhenTheDoubtIsAboutAnotherJob) {
    Story story{quick_settings(), plan_with(earlier_run(), false)};
    story.identify();
    story.locate(150, 5000);
    story.take();
    story.clear_fifo(150, true, 5000);
    story.expect("settle the earlier run: printed none, in doubt 101-200, unused none by no evidence; "
                 "begin run, last printed before 150");
}

TEST(FeederEarlierRun, shouldWaitForAPrintInProgress) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.sm(0, 150, 0, false);
    story.expect("?SM");
    story.sm(0, 150, 0, false);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?SM");
    story.sm(0, 150, 0, true);
    story.expect("?CC");
}

TEST(FeederEarlierRun, shouldDoubtAPrintThatNeverFinishes) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.sm(0, 150, 0, false);
    story.sm(0, 150, 0, false);
    story.wait(seconds{2});
    story.expect("?SM; ?SM");
    story.sm(0, 150, 0, false);
    story.expect("?CC");
    story.cc(950);
    EXPECT_EQ(story.take().find("settle the earlier run so far: printed 101-149"), 0U);
    story.clear_fifo(150, false, 950);
    EXPECT_EQ(story.take().find("settle the earlier run: printed none, in doubt 150-150, unused 151-200"), 0U);
}

TEST(FeederEarlierRun, shouldNotTakeAnAnswerThatHasLostATabForAFinishedPrint) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.print_gos = 77; // in every answer of this printer
    story.identify();
    story.sm(0, 150, 0, false);
    story.sm(0, 150, 0, false);
    story.wait(milliseconds{20});
    story.take();
    story.print_gos.reset();
    story.sm(0, 150, 0);
    story.expect("?SM");
    story.print_gos = 77;
    story.sm(0, 150, 0, false);
    story.expect(""); // it still gets time to finish

    story.wait(milliseconds{20});
    story.take();
    story.print_gos.reset();
    story.sm(0, 150, 0);
    story.expect("?SM");
    story.sm(0, 150, 0); // it means that
    story.expect("?CC");
}

TEST(FeederEarlierRun, shouldDoubtAPrintThatWasSeenBrokenOffBeforeThePrinterPrintedOn) {
    OpenRun run = earlier_run();
    run.broken_off = RecordNumber{110};
    Story story{quick_settings(), plan_with(run)};
    story.identify();
    story.locate(150, 950);
    story.expect("settle the earlier run so far: printed 101-109 by mail status and total print counter");
    story.clear_fifo(150, true, 950);
    EXPECT_EQ(story.take().find("settle the earlier run: printed none, in doubt 110-150, unused 151-200"), 0U);
}

TEST(FeederEarlierRun, shouldBelieveThatAPrintHasFinishedSinceTheEarlierRunWasLost) {
    OpenRun run = earlier_run();
    run.broken_off = RecordNumber{150};
    Story story{quick_settings(), plan_with(run)};
    story.identify();
    story.locate(150, 950);
    story.expect("settle the earlier run so far: printed 101-150 by mail status and total print counter");
}

TEST(FeederEarlierRun, shouldForgetAnUnfinishedPrintThatIsNotOfTheNewRun) {
    Story story;
    story.identify();
    story.sm(0, 101, 0, false); // printed before, and released by an operator
    story.sm(0, 101, 0, false);
    story.wait(seconds{2});
    story.sm(0, 101, 0, false);
    story.cc(1000);
    story.granted();
    story.take();
    story.link_lost();
    EXPECT_EQ(std::get<End>(story.actions[0]).outcome.broken_off, RecordNumber{});
}

TEST(FeederEarlierRun, shouldHaltAPrinterThatPrintsTheEarlierRunAndFlushNothing) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify(State::printing);
    story.sm(50, 149, 200, false); // it prints: nobody waits for the end of a print
    story.sm(50, 149, 200, false);
    story.expect("?SM; ?CC");
    story.cc(949);
    story.expect(
        "notice: the printer was still printing records of the earlier run: it is stopped to learn where it is; "
        "!ST; ?RS");
    story.rs(State::printing);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS");
    story.rs(State::ready_to_print);
    story.expect("?SM");
    story.sm(0, 152, 0);
    story.sm(0, 152, 0);
    story.expect("?SM; ?CC");
    story.cc(952);
    story.expect("settle the earlier run so far: printed 101-152 by mail status and total print counter");
    story.clear_fifo(152, true, 952);
    story.expect("settle the earlier run: printed none, in doubt none, unused 153-200 by mail status and total print "
                 "counter; begin run, last printed before 152");
}

TEST(FeederEarlierRun, shouldHaltAPrinterThatWasStartedAndHasNotPrintedYet) {
    OpenRun run = earlier_run();
    run.printed_through = RecordNumber{0};
    run.last_printed_before = RecordNumber{77};
    run.issued_through = RecordNumber{50};
    Story story{quick_settings(), plan_with(run)};
    story.identify(State::printing);
    story.locate(77, 800);
    EXPECT_EQ(story.phase(), Phase::halting);
}

TEST(FeederEarlierRun, shouldLeaveAPrinterAloneThatPrintsSomethingElse) {
    const auto outcome = [](const FeederPlan& plan, std::uint32_t last_printed, const std::string& serial = "S1") {
        Story story{quick_settings(), plan};
        story.start();
        story.rs(State::printing);
        story.vs(serial);
        story.jl();
        story.actions.clear();
        story.locate(last_printed, 950);
        return story.take();
    };
    const std::string busy = "end: busy (printing, error 0)";
    EXPECT_EQ(outcome({}, 150), busy) << "no earlier run";
    EXPECT_EQ(outcome(plan_with(earlier_run()), 99), busy) << "before what is confirmed";
    EXPECT_EQ(outcome(plan_with(earlier_run()), 201), busy) << "never issued";
    EXPECT_EQ(outcome(plan_with(earlier_run()), 0), busy) << "not left over: 100 are confirmed";
    EXPECT_EQ(outcome(plan_with(earlier_run()), 150, "S2"), busy) << "the numbers agree, but it is another printer";
    OpenRun later = earlier_run();
    later.first = RecordNumber{50};
    later.printed_through = RecordNumber{49};
    EXPECT_EQ(outcome(plan_with(later), 49), busy) << "neither ours nor the number before";
}

TEST(FeederEarlierRun, shouldGiveUpAPrinterThatDoesNotHalt) {
    Story story = reach(Phase::halting);
    story.rs(State::printing);
    story.wait(seconds{10});
    story.expect("end: did_not_stop (printing, error 0)");
}

TEST(FeederEarlierRun, shouldSettleTheEarlierRunOnlyOnce) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify(State::ready_to_print, raw_error(5043));
    story.locate(150, 950);
    story.clear_fifo(150, true, 950, raw_error(5043));
    EXPECT_NE(story.take().find("settle the earlier run: "), std::string::npos);
    story.rs(State::ready_to_print);
    story.expect("begin run, last printed before 150");
}

TEST(FeederEarlierRun, shouldLookAgainWhenSomebodyStartsThePrinterMeanwhile) {
    Story story = reach(Phase::acknowledging);
    story.rs(State::printing);
    story.expect("?SM");
    story.locate(78, 1001);
    story.expect("end: busy (printing, error 0)");

    story = reach(Phase::opening_nozzle);
    story.rs(State::printing);
    story.expect("?SM");
}

} // namespace
} // namespace linefeed::feeder
