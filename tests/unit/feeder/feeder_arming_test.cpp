// The feeder from the connection to the first print: in the manual's order, and every reason not to start.
#include "feeder/mailing_error.hpp"
#include "story.hpp"

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(FeederArming, shouldFollowTheManualUpToTheFirstPrint) {
    Story story;
    story.start();
    story.expect("?RS");
    story.rs(State::ready_to_print);
    story.expect("?VS; ?JL");
    story.vs("S1");
    story.expect("");
    story.jl();
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.expect("?CC");
    story.cc(1000);
    story.expect("begin run, last printed before 77");
    story.granted();
    story.expect("!FF; ?SM");
    story.sm(0, 77, 0);
    story.expect("=CM 110; ?SM");
    story.sm(0, 77, 110);
    story.expect("");
    story.supplied(103);
    story.expect("");
    story.supplied(105);
    story.expect("=MR 101-104; ?SM");
    story.sm(3, 77, 110);
    story.expect("!GO; ?RS");
    story.rs(State::printing);
    story.expect("notice: printing; ?SM");
    EXPECT_EQ(story.phase(), Phase::printing);
}

TEST(FeederArming, shouldTellTheLedgerWhichPrinterItIs) {
    Story story;
    story.identify();
    story.locate();
    ASSERT_EQ(story.actions.size(), 1U);
    const auto& begin = std::get<BeginRun>(story.actions[0]);
    EXPECT_EQ(begin.printer.version->serial_number, "S1");
    EXPECT_EQ(begin.printer.job_name, "\\FFSDISK\\JOBS\\A.job");
    EXPECT_EQ(begin.printer.total_prints, 1000U);
    EXPECT_EQ(begin.last_printed_before, RecordNumber{77});
}

TEST(FeederArming, shouldStartWithoutIdentityAndCounter) {
    Story story;
    story.start();
    story.rs(State::ready_to_print);
    story.take();
    story.no_answer(protocol::Parameter::JL);
    story.expect("");
    story.no_answer(protocol::Parameter::VS);
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.take();
    story.no_answer(protocol::Parameter::CC);
    ASSERT_EQ(story.actions.size(), 1U);
    EXPECT_EQ(std::get<BeginRun>(story.actions[0]).printer, PrinterFacts{});
}

// Every refusal before the start.

TEST(FeederArming, shouldRefuseAPrinterInStandbyAtOnce) {
    Story story;
    story.start();
    story.take();
    story.rs(State::standby);
    story.expect("end: not_ready (standby, error 0)");
}

TEST(FeederArming, shouldRefuseAPrinterThatIsNotReady) {
    for (const auto& [state, words] : {std::pair{State::initialising, "initialising"},
                                       std::pair{State::service, "interval or service panel"},
                                       std::pair{State::ready, "ready for action"}}) {
        Story story;
        story.identify(state);
        story.locate();
        story.expect(std::string{"end: not_ready ("} + words + ", error 0)");
    }
}

TEST(FeederArming, shouldOpenTheNozzleWhenItMay) {
    FeederSettings settings = quick_settings();
    settings.open_nozzle = true;
    Story story{settings};
    story.identify(State::ready);
    story.locate();
    story.expect("notice: opening the nozzle: this takes 30 to 60 s; !NO; ?RS");
    for (int second = 0; second < 40; ++second) {
        story.rs(State::ready);
        story.expect("");
        story.wait(settings.retry_interval);
        story.expect("?RS");
    }
    story.rs(State::ready_to_print);
    story.expect("begin run, last printed before 77");
}

TEST(FeederArming, shouldGiveUpANozzleThatDoesNotOpen) {
    FeederSettings settings = quick_settings();
    settings.open_nozzle = true;
    Story story{settings};
    story.identify(State::ready);
    story.locate();
    story.rs(State::ready);
    story.take();
    story.wait(settings.nozzle_timeout);
    story.expect("end: not_ready (ready for action, error 0)");
}

TEST(FeederArming, shouldSeeTroubleWhileTheNozzleOpens) {
    Story story = reach(Phase::opening_nozzle);
    story.rs(State::ready, raw_error(4711));
    story.expect("end: error_pending (ready for action, error " + std::to_string(raw_error(4711)) + ")");

    story = reach(Phase::opening_nozzle);
    story.rs(State::ready, 0, true);
    story.wait(milliseconds{20});
    story.rs(State::service);
    story.expect("?RS; end: not_ready (interval or service panel, error 0)");

    // A warning is told once, and the nozzle goes on opening.
    story = reach(Phase::opening_nozzle);
    story.rs(State::ready, raw_error(10202, 1));
    EXPECT_EQ(story.take().find("notice: the printer reports 10202"), 0U);
    story.rs(State::ready, raw_error(10202, 1));
    story.expect("");
    story.rs(State::ready_to_print, raw_error(10202, 1));
    story.expect("begin run, last printed before 77");
}

TEST(FeederArming, shouldRefuseAnOpenCover) {
    Story story;
    story.start();
    story.rs(State::ready_to_print, 0, true);
    story.vs("S1");
    story.jl();
    story.actions.clear();
    story.locate();
    story.expect("end: cover_open (ready for print start, error 0)");
}

TEST(FeederArming, shouldRefuseToStartOverAPendingError) {
    Story story;
    story.identify(State::ready_to_print, raw_error(4711));
    story.locate();
    story.expect("end: error_pending (ready for print start, error " + std::to_string(raw_error(4711)) + ")");
}

TEST(FeederArming, shouldStartOverAWarningAndSayIt) {
    for (const std::uint32_t window : {1U, 2U, 3U}) {
        Story story;
        story.identify(State::ready_to_print, raw_error(10202, window));
        story.locate();
        EXPECT_EQ(story.take().find("notice: the printer reports 10202 (battery low)"), 0U);
        EXPECT_EQ(story.phase(), Phase::granting);
    }
}

TEST(FeederArming, shouldAcknowledgeAnErrorThatTheOperatorAllows) {
    for (const std::uint32_t bit_24 : {0U, 1U << 24U}) {
        FeederSettings settings = quick_settings();
        settings.acknowledge.push_back(4711);
        Story story{settings};
        story.identify(State::ready_to_print, raw_error(4711 | bit_24));
        story.locate();
        const std::string told = story.take();
        EXPECT_NE(told.find("acknowledged 4711"), bit_24 == 0 ? std::string::npos : 0U);
        EXPECT_NE(told.find("!EQ; ?RS"), std::string::npos);
        story.rs(State::ready_to_print);
        story.expect("begin run, last printed before 77");
    }
}

TEST(FeederArming, shouldAcknowledgeWhatMailingLeftOnlyBehindTheTruth) {
    for (const std::uint32_t code : {1015U, 1018U, 1019U, 1223U, 5043U, 1223U | 1U << 24U}) {
        Story story{quick_settings(), plan_with(earlier_run())};
        story.identify(State::ready_to_print, raw_error(code));
        story.locate(150, 950);
        const std::string told = story.take();
        const auto settle = told.find("settle the earlier run: printed 101-150, in doubt none, unused 151-200");
        const auto acknowledge = told.find("!EQ");
        ASSERT_NE(settle, std::string::npos) << told;
        ASSERT_NE(acknowledge, std::string::npos) << told;
        EXPECT_LT(settle, acknowledge);
        story.rs(State::ready_to_print);
        story.expect("begin run, last printed before 150");
    }
}

TEST(FeederArming, shouldKnowMailingErrors) {
    for (const std::uint32_t code : {1015U, 1018U, 1019U, 1223U, 5043U}) {
        EXPECT_TRUE(is_mailing_error({raw_error(code)}));
        EXPECT_TRUE(is_mailing_error({raw_error(code | 1U << 24U)}));
        EXPECT_TRUE(is_error({raw_error(code)}, code));
    }
    EXPECT_FALSE(is_mailing_error({raw_error(1305)}));
    EXPECT_FALSE(is_mailing_error({}));
}

TEST(FeederArming, shouldAskUntilTheErrorIsGone) {
    Story story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, end_message);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS");
    story.rs(State::ready_to_print, end_message);
    story.wait(milliseconds{20});
    story.take();
    story.rs(State::ready_to_print);
    story.expect("begin run, last printed before 77");
}

TEST(FeederArming, shouldGiveUpAnErrorThatStays) {
    Story story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, end_message);
    story.take();
    story.wait(seconds{2});
    story.expect("end: error_pending (ready for print start, error " + std::to_string(end_message) + ")");
}

TEST(FeederArming, shouldLookAtTheErrorBehindTheAcknowledgedOne) {
    Story story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, raw_error(4711));
    EXPECT_EQ(story.take().find("end: error_pending"), 0U);

    story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, raw_error(10202, 1));
    EXPECT_NE(story.take().find("battery low), warning from RIP; begin run"), std::string::npos);

    // One mailing error behind another is acknowledged too, but not for ever.
    story = reach(Phase::acknowledging);
    story.rs(State::ready_to_print, raw_error(5043));
    EXPECT_NE(story.take().find("!EQ; ?RS"), std::string::npos);
    story.wait(seconds{1});
    story.rs(State::ready_to_print, end_message);
    EXPECT_NE(story.take().find("!EQ; ?RS"), std::string::npos);
    story.wait(seconds{1});
    EXPECT_EQ(story.take().find("end: error_pending"), 0U);
}

TEST(FeederArming, shouldRefuseAFifoWithoutDepthBeforeAnythingIsGranted) {
    Story story;
    story.reported_depth = 0;
    story.identify();
    story.locate();
    story.expect("end: records_not_taken (ready for print start, error 0)");
}

TEST(FeederArming, shouldEndWhenTheLedgerGrantsNothing) {
    for (const OutcomeCode why : {OutcomeCode::nothing_to_print, OutcomeCode::records_in_doubt}) {
        Story story = reach(Phase::granting);
        story.refused(why);
        story.expect("end: " + std::string{to_string(why)} + " (ready for print start, error 0)");
    }
    Story story = reach(Phase::loading);
    story.refused(OutcomeCode::nothing_to_print);
    story.expect("");
    story.granted(); // nobody asked a second time
    story.expect("");
}

// The earlier run.

TEST(FeederArming, shouldSettleTheEarlierRunBeforeTheGrant) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 950);
    story.expect("settle the earlier run: printed 101-150, in doubt none, unused 151-200 by mail status and total print "
                 "counter; begin run, last printed before 150");
}

TEST(FeederArming, shouldGiveTheEvidenceToTheLedger) {
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

TEST(FeederArming, shouldSettleTheEarlierRunEvenWhenItMayNotStart) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify(State::ready);
    story.locate(150, 950);
    const std::string told = story.take();
    EXPECT_EQ(told.find("settle the earlier run: printed 101-150"), 0U);
    EXPECT_NE(told.find("end: not_ready"), std::string::npos);
}

TEST(FeederArming, shouldPrintNothingWhileRecordsAreInDoubt) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.locate(150, 5000);
    story.expect("settle the earlier run: printed none, in doubt 101-200, unused none by no evidence; "
                 "end: records_in_doubt (ready for print start, error 0)");
}

TEST(FeederArming, shouldGoOnWhenTheDoubtIsAboutAnotherJob) {
    Story story{quick_settings(), plan_with(earlier_run(), false)};
    story.identify();
    story.locate(150, 5000);
    story.expect("settle the earlier run: printed none, in doubt 101-200, unused none by no evidence; "
                 "begin run, last printed before 150");
}

TEST(FeederArming, shouldWaitForAPrintInProgress) {
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

TEST(FeederArming, shouldDoubtAPrintThatNeverFinishes) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify();
    story.sm(0, 150, 0, false);
    story.sm(0, 150, 0, false);
    story.wait(seconds{2});
    story.expect("?SM; ?SM");
    story.sm(0, 150, 0, false);
    story.expect("?CC");
    story.cc(950);
    EXPECT_EQ(story.take().find("settle the earlier run: printed 101-149, in doubt 150-150, unused 151-200"), 0U);
}

TEST(FeederArming, shouldHaltAPrinterThatPrintsTheEarlierRunAndFlushNothing) {
    Story story{quick_settings(), plan_with(earlier_run())};
    story.identify(State::printing);
    story.sm(50, 149, 200, false); // it prints: nobody waits for the end of a print
    story.sm(50, 149, 200, false);
    story.expect("?SM; ?CC");
    story.cc(949);
    story.expect("notice: the printer was still printing records of the earlier run: it is stopped to learn where it is; "
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
    story.expect("settle the earlier run: printed 101-152, in doubt none, unused 153-200 by mail status and total print "
                 "counter; begin run, last printed before 152");
}

TEST(FeederArming, shouldHaltAPrinterThatWasStartedAndHasNotPrintedYet) {
    OpenRun run = earlier_run();
    run.printed_through = RecordNumber{0};
    run.last_printed_before = RecordNumber{77};
    run.issued_through = RecordNumber{50};
    Story story{quick_settings(), plan_with(run)};
    story.identify(State::printing);
    story.locate(77, 800);
    EXPECT_EQ(story.phase(), Phase::halting);
}

TEST(FeederArming, shouldLeaveAPrinterAloneThatPrintsSomethingElse) {
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

TEST(FeederArming, shouldGiveUpAPrinterThatDoesNotHalt) {
    Story story = reach(Phase::halting);
    story.rs(State::printing);
    story.wait(seconds{10});
    story.expect("end: did_not_stop (printing, error 0)");
}

// Flush, stop point, fill.

TEST(FeederArming, shouldFlushOnlyWhatTheLedgerHasGranted) {
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

TEST(FeederArming, shouldWaitUntilTheFifoIsEmpty) {
    Story story = reach(Phase::flushing);
    story.sm(3, 77, 0); // one inquiry old
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.expect("=CM 110; ?SM");
}

TEST(FeederArming, shouldStopWhenTheFifoDoesNotBecomeEmpty) {
    Story story = reach(Phase::flushing);
    story.sm(3, 77, 0);
    story.wait(seconds{2});
    story.expect("!ST; ?RS");
    story.judge(3, 77, true, 1000);
    story.expect("settle: printed none, in doubt none, unused none by nothing was issued");
    story.settled();
    story.expect("!FF; end: fifo_not_flushed (ready for print start, error 0)");
}

TEST(FeederArming, shouldNotGoOnWhenThePrinterHasPrintedSinceTheTruthWasTakenDown) {
    Story story = reach(Phase::flushing);
    story.sm(0, 78, 0);
    story.expect("!ST; ?RS");
    story.judge(0, 78, true, 1001);
    story.expect("settle: printed none, in doubt none, unused none by nothing was issued; "
                 "end: busy (ready for print start, error 0)");

    story = reach(Phase::flushing);
    story.sm(0, 0, 0); // a firmware that forgets the number with the FIFO
    story.expect("=CM 110; ?SM");
}

TEST(FeederArming, shouldBelieveOnlyTheSecondAnswerAboutTheStopPoint) {
    Story story = reach(Phase::setting_stop);
    story.sm(0, 77, 0);
    story.expect("?SM");
    story.sm(0, 77, 110);
    EXPECT_EQ(story.phase(), Phase::loading);
}

TEST(FeederArming, shouldGoOnWithoutAStopPointAndTryAgainWhilePrinting) {
    Story story = reach(Phase::setting_stop);
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.expect("?SM");
    EXPECT_EQ(story.phase(), Phase::loading);
    story.supplied(110);
    story.sm(3, 77, 0);
    story.take();
    story.rs(State::printing);
    story.expect("notice: printing; =CM 110; ?SM");
}

TEST(FeederArming, shouldWaitForTheWholeFirstFill) {
    Story story = reach(Phase::loading);
    story.supplied(103);
    story.durable(110);
    story.expect("");
    EXPECT_EQ(story.feeder.next_wake(), std::nullopt);
    story.supplied(104);
    story.expect("=MR 101-104; ?SM");
}

TEST(FeederArming, shouldAskForTheIntentsOfTheFirstFill) {
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

TEST(FeederArming, shouldStartALongFifoWithTheRecordsAtHand) {
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

TEST(FeederArming, shouldBelieveOnlyTheSecondAnswerAboutTheFill) {
    Story story = reach(Phase::verifying);
    story.sm(0, 77, 110); // one inquiry old
    story.expect("?SM");
    story.sm(3, 77, 110);
    story.expect("!GO; ?RS");
}

TEST(FeederArming, shouldSayWhenThePrinterHoldsAnotherNumberOfEntries) {
    Story story = reach(Phase::verifying);
    story.sm(4, 77, 110);
    story.sm(4, 77, 110);
    story.expect("?SM; notice: the printer reports another number of FIFO entries than was sent; !GO; ?RS");
}

TEST(FeederArming, shouldStopWhenThePrinterTakesNoRecords) {
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
    story.expect("settle: printed none, in doubt none, unused 101-104 by mail status; "
                 "end: records_not_taken (ready for print start, error 0)");
}

TEST(FeederArming, shouldStartWithASingleRecordThatIsLoadedAlready) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 101, 101);
    story.sm(0, 77, 0);
    story.sm(0, 77, 101);
    story.actions.clear();
    story.supplied(101);
    story.expect("=MR 101-101; ?SM");
    story.sm(0, 77, 101);
    story.expect("!GO; ?RS");
}

TEST(FeederArming, shouldWaitForTheStart) {
    Story story = reach(Phase::starting);
    story.rs(State::ready_to_print);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS");
    story.rs(State::ready_to_print, raw_error(10202, 1));
    EXPECT_EQ(story.take().find("notice: the printer reports 10202"), 0U) << "a warning is no reason to end";
    story.rs(State::ready_to_print, raw_error(10202, 1));
    story.expect("");
    story.wait(milliseconds{20});
    story.rs(State::printing, raw_error(10202, 1));
    story.expect("?RS; notice: printing; ?SM");
}

TEST(FeederArming, shouldGiveUpAPrinterThatDoesNotStart) {
    Story story = reach(Phase::starting);
    story.rs(State::ready_to_print);
    story.wait(seconds{15});
    story.expect("!ST; ?RS");
    story.judge(3, 77, true, 1000);
    story.expect("settle: printed none, in doubt none, unused 101-104 by mail status");
    story.settled();
    story.expect("!FF; end: did_not_start (ready for print start, error 0)");
}

TEST(FeederArming, shouldFindTheTruthWhenTheStartEndsInAnError) {
    Story story = reach(Phase::starting);
    story.rs(State::ready_to_print, raw_error(1018));
    story.expect("?RS");
    story.rs(State::ready_to_print, raw_error(1018));
    story.sm(0, 77, 0);
    story.sm(0, 77, 0);
    story.expect("?SM; ?SM; ?CC");
    story.cc(1000);
    story.expect("settle: printed none, in doubt none, unused 101-104 by mail status; end: printer_error (ready for print "
                 "start, error " + std::to_string(raw_error(1018)) + ")");
}

TEST(FeederArming, shouldFinishAShortRunThatIsOverBeforeAnyoneLooked) {
    Story story;
    story.arm_to_grant();
    story.granted(101, 102, 102);
    story.sm(0, 77, 0);
    story.sm(0, 77, 102);
    story.supplied(102);
    story.sm(1, 77, 102);
    story.take();
    story.rs(State::ready_to_print, end_message);
    story.rs(State::ready_to_print, end_message);
    story.sm(0, 102, 0);
    story.sm(0, 102, 0);
    story.take();
    story.cc(1002);
    story.expect("settle: printed 101-102, in doubt none, unused none by end message 1223; !EQ; ?RS");
}

using FeederDeathTest = testing::Test;

TEST(FeederDeathTest, shouldStartOnlyOnce) {
    Story story;
    story.start();
    EXPECT_DEATH(story.start(), "idle");
}

} // namespace
} // namespace linefeed::feeder
