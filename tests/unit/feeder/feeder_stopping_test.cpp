// What the printer, the operator and the ledger do to a run: the line is stopped, and the verdict says what happened to
// each record.
#include "story.hpp"

#include <gmock/gmock.h>

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using std::chrono::milliseconds;
using std::chrono::seconds;

std::string ended(OutcomeCode code, const std::string& state = "ready for print start, error 0") {
    return "end: " + std::string{to_string(code)} + " (" + state + ")";
}

TEST(FeederStopping, shouldFindTheTruthAfterAStopOnRequest) {
    Story story = reach(Phase::printing);
    story.sm(1, 102, 110);
    story.take();
    story.stop();
    story.expect("!ST; ?RS");
    story.rs(State::printing);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS");
    story.sm(1, 103, 0); // asked before the stop
    story.expect("");
    story.rs(State::ready_to_print);
    story.expect("?RS");
    story.rs(State::ready_to_print);
    story.expect("?SM");
    story.sm(0, 103, 0);
    story.expect("?SM");
    story.sm(0, 104, 0);
    story.expect("?CC");
    story.cc(1004);
    story.clear_fifo(104, true, 1004);
    story.expect("settle this run so far: printed 103-104 by mail status and total print counter; settle this run: "
                 "printed none, in doubt none, unused 105-106 by mail status and total print counter; " +
                 ended(OutcomeCode::stop_requested));
}

TEST(FeederStopping, shouldRepeatAStopThatGotLost) {
    Story story = reach(Phase::printing);
    story.sm(1, 102, 110);
    story.take();
    story.stop();
    story.expect("!ST; ?RS");
    story.wait(milliseconds{490});
    story.rs(State::printing);
    story.take();
    story.wait(milliseconds{20});
    story.take();
    story.rs(State::printing);
    story.expect("!ST");
    story.wait(milliseconds{20});
    story.take();
    story.rs(State::printing);
    story.expect("");
    story.wait(milliseconds{500});
    story.take();
    story.rs(State::printing);
    story.expect("!ST");
}

TEST(FeederStopping, shouldStopBeforeAnUnprovenRecord) {
    Story story = reach(Phase::printing);
    story.sm(1, 102, 110);
    story.take();
    story.feeder.on_unproven_record(RecordNumber{106}, story.now, story.actions);
    story.expect("!ST; ?RS");
    story.judge(0, 104, true, 1004);
    story.expect("settle this run so far: printed 103-104 by mail status and total print counter; settle this run: "
                 "printed none, in doubt none, unused 105-106 by mail status and total print counter; " +
                 ended(OutcomeCode::line_noise));
}

TEST(FeederStopping, shouldDoubtAnUnprovenRecordThatIsPrinted) {
    Story story = reach(Phase::printing);
    story.sm(1, 102, 110);
    story.take();
    story.feeder.on_unproven_record(RecordNumber{105}, story.now, story.actions);
    story.judge(0, 106, true, 1006);
    story.expect("settle this run so far: printed 103-104 by mail status and total print counter; settle this run: "
                 "printed none, in doubt 105-106, unused none by mail status and total print counter; " +
                 ended(OutcomeCode::line_noise));
}

TEST(FeederStopping, shouldDoubtAnUnprovenRecordBeforeAnUnfinishedPrint) {
    Story story = reach(Phase::printing);
    story.sm(1, 102, 110);
    story.take();
    story.feeder.on_unproven_record(RecordNumber{105}, story.now, story.actions);
    story.judge(0, 106, false, 1006);
    story.expect("settle this run so far: printed 103-104 by mail status and total print counter; settle this run: "
                 "printed none, in doubt 105-106, unused none by mail status and total print counter; " +
                 ended(OutcomeCode::line_noise));
}

TEST(FeederStopping, shouldNotConfirmAnUnprovenRecord) {
    Story story = reach(Phase::printing);
    story.sm(1, 102, 110);
    story.take();
    story.feeder.on_unproven_record(RecordNumber{103}, story.now, story.actions);
    story.judge(0, 103, true, 1003);
    story.expect("settle this run so far: printed none by mail status and total print counter; settle this run: "
                 "printed none, in doubt 103-103, unused 104-106 by mail status and total print counter; " +
                 ended(OutcomeCode::line_noise));
}

TEST(FeederStopping, shouldGiveAllEvidenceWithTheVerdict) {
    Story story = reach(Phase::stopping);
    story.judge(0, 104, true, 1004);
    const auto& settle = std::get<Settle>(story.actions[0]);
    EXPECT_FALSE(settle.earlier_run);
    EXPECT_EQ(settle.evidence.mail.last_printed, RecordNumber{104});
    EXPECT_EQ(settle.evidence.printer.total_prints, 1004U);
    EXPECT_EQ(settle.evidence.printer.version->serial_number, "S1");
    EXPECT_TRUE(settle.evidence.uninterrupted);
    EXPECT_FALSE(settle.evidence.restarted);
    EXPECT_FALSE(settle.evidence.end_message);
}

TEST(FeederStopping, shouldJudgeOnlyByAnswersFromBehindTheStop) {
    Story story = reach(Phase::printing);
    story.wait(milliseconds{1});
    story.wait(milliseconds{1});
    story.expect("?SM; ?SM");
    story.stop();
    story.rs(State::ready_to_print);
    story.rs(State::ready_to_print);
    story.take();
    story.sm(1, 102, 110); // these two were asked before the stop
    story.expect("");
    story.sm(1, 102, 110);
    story.expect("");
    story.sm(1, 102, 110); // the first of two may be old
    story.expect("?SM");
    story.sm(0, 104, 0);
    story.expect("?CC");
    story.cc(1004);
    EXPECT_EQ(story.take().find("settle this run: printed 101-104, in doubt none, unused none"), 0U);
}

TEST(FeederStopping, shouldDoubtTheRecordWhosePrintWasBrokenOff) {
    Story story = reach(Phase::stopping);
    story.rs(State::ready_to_print);
    story.rs(State::ready_to_print);
    story.sm(0, 102, 0, false);
    story.sm(0, 102, 0, false);
    story.expect("?RS; ?SM; ?SM");
    story.wait(milliseconds{20});
    story.expect("?SM");
    story.sm(0, 102, 0, false);
    story.wait(seconds{2}); // its print will not finish any more
    story.expect("?SM");
    story.sm(0, 102, 0, false);
    story.expect("?CC");
    story.cc(1002);
    story.clear_fifo(102, false, 1002);
    story.expect("settle this run so far: printed 101-101 by mail status and total print counter; settle this run: "
                 "printed none, in doubt 102-102, unused 103-104 by mail status and total print counter; " +
                 ended(OutcomeCode::stop_requested));
}

TEST(FeederStopping, shouldNoticeAStopAtThePrinter) {
    Story story = reach(Phase::printing);
    story.rs(State::ready_to_print);
    story.expect("?RS");
    story.judge(0, 102, true, 1002);
    story.expect("settle this run so far: printed 101-102 by mail status and total print counter; settle this run: "
                 "printed none, in doubt none, unused 103-104 by mail status and total print counter; " +
                 ended(OutcomeCode::stopped_at_printer));
}

TEST(FeederStopping, shouldStopForAnErrorOfThePrinter) {
    Story story = reach(Phase::printing);
    story.rs(State::printing, raw_error(4711));
    story.expect("!ST; ?RS");
    story.judge(0, 102, true, 1002, raw_error(4711));
    EXPECT_NE(story.take().find("end: printer_error"), std::string::npos);
}

TEST(FeederStopping, shouldReportTheErrorThatStoppedThePrinter) {
    for (const std::uint32_t code : {5043U, 1018U, 1019U, 4711U}) {
        Story story = reach(Phase::printing);
        story.rs(State::ready_to_print, raw_error(code));
        story.judge(0, 104, true, 1004, raw_error(code));
        story.expect(
            "settle this run: printed 101-104, in doubt none, unused none by mail status and total print counter; " +
            ended(OutcomeCode::printer_error, "ready for print start, error " + std::to_string(raw_error(code))));
    }
}

TEST(FeederStopping, shouldReportAnEndMessageBeforeTheEndAsAnError) {
    Story story = reach(Phase::printing);
    story.rs(State::ready_to_print, end_message);
    story.judge(0, 103, true, 1003, end_message);
    story.expect("settle this run so far: printed 101-103 by mail status and total print counter; settle this run: "
                 "printed none, in doubt none, unused 104-104 by mail status and total print counter; " +
                 ended(OutcomeCode::printer_error, "ready for print start, error " + std::to_string(end_message)));
}

TEST(FeederStopping, shouldNotTakeAWarningOfBeforeForTheCause) {
    Story story = reach(Phase::printing);
    story.rs(State::printing, raw_error(10202, 1));
    story.take();
    story.rs(State::ready_to_print, raw_error(10202, 1));
    story.judge(0, 102, true, 1002, raw_error(10202, 1));
    EXPECT_NE(story.take().find("end: stopped_at_printer"), std::string::npos);
}

TEST(FeederStopping, shouldDoubtAPrintThatSomebodyBrokeOffBeforePrintingOn) {
    Story story = reach(Phase::printing);
    story.rs(State::ready_to_print);
    story.rs(State::ready_to_print);
    for (int answers = 0; answers < 4; ++answers) {
        story.sm(0, 102, 0, false);
        story.wait(milliseconds{20}); // it gets time to finish
    }
    story.take();
    story.sm(0, 104, 0);
    story.expect("?CC");
    story.cc(1004);
    EXPECT_EQ(std::get<Settle>(story.actions[0]).confirmed_through, RecordNumber{100}) << "before this verdict";
    story.expect("settle this run so far: printed 101-101 by mail status and total print counter");
    story.clear_fifo(104, true, 1004);
    story.expect(
        "settle this run: printed none, in doubt 102-104, unused none by mail status and total print counter; " +
        ended(OutcomeCode::stopped_at_printer));
}

TEST(FeederStopping, shouldSayOfWhatItLeavesOpenThatAPrintMayBeBrokenOff) {
    for (const bool finished : {false, true}) {
        Story story = reach(Phase::stopping);
        story.rs(State::ready_to_print);
        story.rs(State::ready_to_print);
        story.sm(0, 102, 0, false);
        story.sm(0, 102, 0, false);
        story.wait(milliseconds{20});
        story.sm(0, 102, 0, finished);
        story.take();
        story.link_lost();
        EXPECT_EQ(std::get<End>(story.actions[0]).outcome.broken_off, RecordNumber{finished ? 0U : 102U});
    }
}

TEST(FeederStopping, shouldReportAnOpenCover) {
    Story story = reach(Phase::printing);
    story.rs(State::ready_to_print, 0, true);
    story.rs(State::ready_to_print, 0, true);
    story.say_where(0, 102);
    story.cc(1002);
    story.clear_fifo(102, true, 1002, 0, true);
    EXPECT_NE(story.take().find("end: cover_open"), std::string::npos);
}

TEST(FeederStopping, shouldStopWhenThePrinterHasLostItsMemory) {
    for (const std::uint32_t back_to : {0U, 77U, 101U}) {
        Story story = reach(Phase::printing);
        story.sm(1, 102, 110);
        story.take();
        story.sm(0, back_to, 110);
        story.expect(""); // a damaged answer?
        story.sm(0, back_to, 110);
        story.expect("!ST; ?RS");
        story.judge(0, back_to, true, 1003);
        const auto& settle = std::get<Settle>(story.actions[0]);
        EXPECT_FALSE(settle.evidence.uninterrupted);
        story.expect((back_to == 0 ? "settle this run so far: printed none by total print counter; settle this run: "
                                     "printed none, in doubt 103-104, unused 105-106 by total print counter; "
                                   : "settle this run so far: printed none by no evidence; settle this run: printed "
                                     "none, in doubt 103-106, unused none by no evidence; ") +
                     ended(OutcomeCode::printer_restarted));
    }
}

TEST(FeederStopping, shouldStopWhenThePrinterReportsWhatWasNeverSent) {
    for (const std::uint32_t number : {105U, 99U, 4294967295U}) {
        Story story = reach(Phase::printing);
        story.sm(1, number, 110);
        story.expect(""); // a damaged answer?
        story.sm(1, number, 110);
        story.expect("!ST; ?RS");
        story.judge(0, number, true, 1004);
        EXPECT_NE(story.take().find("in doubt 101-104"), std::string::npos);
    }
}

TEST(FeederStopping, shouldSayThatAnotherProgramFeedsThePrinter) {
    Story story = reach(Phase::printing);
    story.sm(1, 5000, 110);
    story.sm(1, 5000, 110);
    story.judge(0, 5000, true, 1004);
    EXPECT_NE(story.take().find("end: impossible_report"), std::string::npos);
}

TEST(FeederStopping, shouldStopAgainWhenSomebodyStartsThePrinterWhileItIsJudged) {
    Story story = reach(Phase::judging);
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 103, true, 1002);
    const auto& settle = std::get<Settle>(story.actions[0]);
    EXPECT_TRUE(settle.evidence.restarted);
    story.expect("settle this run so far: printed none by no evidence; settle this run: printed none, in doubt "
                 "101-104, unused none by no evidence; " +
                 ended(OutcomeCode::stop_requested));
}

TEST(FeederStopping, shouldFlushOnlyWhenTheLedgerKnowsAndLookOnceMoreBehindTheFlush) {
    Story story = reach(Phase::recording);
    story.rs(State::ready_to_print);
    story.sm(3, 77, 0);
    story.expect("");
    story.settled();
    story.expect("!FF; ?RS");
    story.rs(State::ready_to_print);
    story.expect("?SM");
    story.sm(3, 77, 0); // may be from before the flush
    story.expect("?SM");
    story.sm(0, 77, 0);
    story.expect("?CC");
    story.cc(1000);
    story.expect("settle this run: printed none, in doubt none, unused 101-104 by mail status; " +
                 ended(OutcomeCode::stop_requested));
}

TEST(FeederStopping, shouldFindWhatSomebodyPrintsBeforeTheFlush) {
    Story story = reach(Phase::clearing);
    story.rs(State::printing);
    story.expect("!ST; ?RS");
    story.judge(0, 102, true, 1002);
    story.expect(
        "settle this run so far: printed 101-102 by mail status and total print counter; "
        "settle this run: printed none, in doubt none, unused 103-104 by mail status and total print counter; " +
        ended(OutcomeCode::stop_requested));

    story = reach(Phase::clearing); // started, and run empty, before anybody asked
    story.rs(State::ready_to_print, raw_error(5043));
    story.say_where(0, 104);
    story.cc(1004);
    story.expect(
        "settle this run: printed 101-104, in doubt none, unused none by mail status and total print counter; " +
        ended(OutcomeCode::stop_requested, "ready for print start, error " + std::to_string(raw_error(5043))));
}

/// The counter is not answered behind the flush: what it said before still contradicts the number.
TEST(FeederStopping, shouldRememberTheCounterOfTheFirstLook) {
    Story story = reach(Phase::printing);
    story.stop();
    story.judge_unsettled(1, 103, true, 1002);
    EXPECT_EQ(story.phase(), Phase::recording);
    story.take();
    story.settled();
    story.rs(State::ready_to_print);
    story.say_where(0, 103);
    for (int tries = 0; tries < 4; ++tries) {
        story.lost(protocol::Parameter::CC);
    }
    EXPECT_NE(story.take().find("in doubt 101-104"), std::string::npos);
}

TEST(FeederStopping, shouldLeaveRecordsOpenThatCannotBeFlushed) {
    Story story = reach(Phase::clearing);
    story.rs(State::ready_to_print);
    story.sm(3, 77, 0);
    story.sm(3, 77, 0);
    story.wait(seconds{2});
    story.take();
    story.sm(3, 77, 0);
    story.expect(ended(OutcomeCode::fifo_not_flushed));
}

TEST(FeederStopping, shouldTakeTheLedgersWordOnlyWhereItIsAwaited) {
    for (const Phase phase : all_phases) {
        if (phase != Phase::recording) {
            Story story = reach(phase);
            story.settled();
            story.expect("");
            EXPECT_EQ(story.phase(), phase);
        }
    }
}

TEST(FeederStopping, shouldFinishWhenAStopComesTooLate) {
    Story story = reach(Phase::printing);
    story.print_through(108);
    story.stop();
    story.judge(0, 110, true, 1010, end_message);
    story.expect("settle this run: printed 109-110, in doubt none, unused none by end message 1223; !EQ; ?RS");
    story.rs(State::ready_to_print);
    story.expect(ended(OutcomeCode::finished));
}

TEST(FeederStopping, shouldNotBelieveAnEndMessageThatTheNumberContradicts) {
    Story story = reach(Phase::printing);
    story.print_through(107);
    // Another client has set the stop point to 108.
    story.rs(State::ready_to_print, end_message);
    story.judge(0, 108, true, 1008, end_message);
    const std::string told = story.take();
    EXPECT_NE(told.find("settle this run so far: printed 108-108 by mail status and total"), std::string::npos) << told;
    EXPECT_NE(told.find("settle this run: printed none, in doubt none, unused 109-110"), std::string::npos) << told;
    EXPECT_NE(told.find("end: printer_error"), std::string::npos) << told;

    story = reach(Phase::printing); // a firmware that forgets its number with the stop
    story.print_through(108);
    story.rs(State::ready_to_print, end_message);
    story.judge(0, 0, true, 1010, end_message);
    EXPECT_NE(story.take().find("printed 109-110, in doubt none, unused none by end message 1223"), std::string::npos);
}

TEST(FeederStopping, shouldWaitUntilTheEndMessageIsGone) {
    Story story = reach(Phase::finishing);
    story.rs(State::ready_to_print, end_message);
    story.expect("");
    story.wait(milliseconds{20});
    story.expect("?RS");
    story.rs(State::ready_to_print, raw_error(10202, 1)); // another message behind it is not ours
    EXPECT_NE(story.take().find("end: finished"), std::string::npos);
}

TEST(FeederStopping, shouldKnowTheEndMessageWithBit24) {
    const std::int32_t odd = raw_error(1223U | 1U << 24U, 2);
    Story story = reach(Phase::printing);
    story.print_through(108);
    story.take();
    story.rs(State::ready_to_print, odd);
    story.judge(0, 110, true, 1010, odd);
    story.expect("settle this run: printed 109-110, in doubt none, unused none by end message 1223; !EQ; ?RS");
}

TEST(FeederStopping, shouldFinishOverAnUnderstoodErrorWhenAllIsPrinted) {
    Story story = reach(Phase::printing);
    story.print_through(108);
    story.rs(State::ready_to_print, raw_error(5043));
    story.judge(0, 110, true, 1010, raw_error(5043));
    EXPECT_NE(story.take().find("; !EQ; ?RS"), std::string::npos);
    story.rs(State::ready_to_print);
    story.expect(ended(OutcomeCode::finished));
}

TEST(FeederStopping, shouldNotBelieveTheEndMessageOfAPrinterThatWasStartedAgain) {
    Story story = reach(Phase::printing);
    story.print_through(108);
    story.stop();
    story.rs(State::ready_to_print);
    story.rs(State::printing); // somebody has started it: what it printed before and since is to be counted
    story.take();
    story.judge(0, 110, true, 1008, end_message);
    EXPECT_NE(story.take().find("printed none, in doubt 109-110, unused none by no evidence"), std::string::npos);
}

/// Nothing but an answer between the two tells that the print was broken off.
TEST(FeederStopping, shouldDoubtAPrintThatWasNotFinishedWhenThePrinterWasStartedAgain) {
    for (const bool asked_once : {true, false}) {
        Story story = reach(Phase::printing);
        story.sm(3, 101, 110);
        for (int asked = 0; asked < 4; ++asked) {
            story.wait(std::chrono::milliseconds{500});
        }
        story.expect("?SM; ?RS; ?SM; ?SM; ?SM");
        story.rs(State::ready_to_print);
        story.sm(0, 102, 110, false);
        if (!asked_once) {
            story.sm(0, 102, 110, false);
            story.sm(0, 103, 110); // printed on by now
        }
        story.rs(State::printing);
        story.take();
        story.judge(0, 104, true, 1004);
        EXPECT_THAT(story.take(), testing::HasSubstr("printed none, in doubt 102-104")) << asked_once;
    }
}

TEST(FeederStopping, shouldSayThatNobodyKnowsWhichRecordsWerePrinted) {
    Story story = reach(Phase::printing);
    story.stop();
    story.judge_unsettled(0, 104, true, 1002); // two of four
    story.link_lost();
    EXPECT_TRUE(std::get<End>(story.actions[story.actions.size() - 1]).outcome.unclear);

    Story next{quick_settings(), plan_with(earlier_run())};
    next.identify();
    next.locate(150, 920);
    next.link_lost();
    EXPECT_TRUE(std::get<End>(next.actions[next.actions.size() - 1]).outcome.unclear);
}

TEST(FeederStopping, shouldSayThatAnOpenRunMayHaveLeftRecordsOut) {
    Story story = reach(Phase::printing);
    story.stop();
    story.rs(State::ready_to_print);
    story.rs(State::printing);
    story.take();
    story.link_lost();
    EXPECT_TRUE(std::get<End>(story.actions[0]).outcome.unclear);

    FeederPlan plan = plan_with(earlier_run());
    for (const bool unclear : {true, false}) {
        plan.open->unclear = unclear;
        Story next{quick_settings(), plan};
        next.identify();
        next.link_lost();
        EXPECT_EQ(std::get<End>(next.actions[0]).outcome.unclear, unclear) << "nobody has settled it yet";
    }
}

TEST(FeederStopping, shouldLeaveAnErrorAloneThatIsNotOfMailing) {
    Story story = reach(Phase::printing);
    story.print_through(108);
    story.rs(State::ready_to_print, raw_error(4711));
    story.judge(0, 110, true, 1010, raw_error(4711));
    const std::string told = story.take();
    EXPECT_EQ(told.find("!EQ"), std::string::npos);
    EXPECT_NE(told.find("end: finished"), std::string::npos);
}

} // namespace
} // namespace linefeed::feeder
