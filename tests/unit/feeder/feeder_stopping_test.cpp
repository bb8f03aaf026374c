// Every way in which a run ends before its end: whatever happens in whatever phase, the line is stopped, the truth is found where it
// can be, and nothing happens afterwards.
#include "story.hpp"

#include <map>

namespace linefeed::feeder {
namespace {

using State = protocol::MachineState;
using protocol::Parameter;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// For each phase, the story that an event causes there.
template <typename Event>
void expect_in_every_phase(const std::map<Phase, std::string>& stories, const Event& event) {
    for (const Phase phase : all_phases) {
        SCOPED_TRACE(testing::Message() << "phase " << static_cast<int>(phase));
        Story story = reach(phase);
        event(story);
        story.expect(stories.at(phase));
    }
}

const std::string stop_and_ask = "!ST; ?RS";
const std::string unused_all = "settle: printed none, in doubt none, unused none by nothing was issued; ";

std::string ended(OutcomeCode code, const std::string& state = "ready for print start, error 0") {
    return "end: " + std::string{to_string(code)} + " (" + state + ")";
}

TEST(FeederStopping, shouldStopOnRequestInEveryPhase) {
    const auto end = [](const std::string& state) { return ended(OutcomeCode::stop_requested, state); };
    expect_in_every_phase(
        {
            {Phase::idle, end("standby, error 0")},
            {Phase::identifying, end("standby, error 0")},
            {Phase::locating, ended(OutcomeCode::stop_requested)},
            {Phase::taking_over, "!ST; " + end("printing, error 0")},
            {Phase::halting, end("printing, error 0")},
            {Phase::opening_nozzle, end("ready for action, error 0")},
            {Phase::acknowledging, end("ready for print start, error " + std::to_string(end_message))},
            {Phase::granting, ended(OutcomeCode::stop_requested)},
            {Phase::flushing, stop_and_ask},
            {Phase::setting_stop, stop_and_ask},
            {Phase::loading, stop_and_ask},
            {Phase::verifying, stop_and_ask},
            {Phase::starting, stop_and_ask},
            {Phase::printing, stop_and_ask},
            {Phase::stopping, ""},
            {Phase::judging, ""},
            {Phase::finishing, ""},
            {Phase::clearing, ""},
            {Phase::ended, ""},
        },
        [](Story& story) { story.stop(); });
}

TEST(FeederStopping, shouldEndWhenTheLinkIsLostInEveryPhase) {
    const auto end = [](const std::string& state) { return ended(OutcomeCode::link_lost, state); };
    const std::string sent = ended(OutcomeCode::link_lost, "printing, error 0");
    expect_in_every_phase(
        {
            {Phase::idle, end("standby, error 0")},
            {Phase::identifying, end("standby, error 0")},
            {Phase::locating, ended(OutcomeCode::link_lost)},
            {Phase::taking_over, sent},
            {Phase::halting, sent},
            {Phase::opening_nozzle, end("ready for action, error 0")},
            {Phase::acknowledging, end("ready for print start, error " + std::to_string(end_message))},
            {Phase::granting, ended(OutcomeCode::link_lost)},
            {Phase::flushing, ended(OutcomeCode::link_lost)}, // the flush may not have arrived
            {Phase::setting_stop, unused_all + ended(OutcomeCode::link_lost)}, // granted, but nothing went out
            {Phase::loading, unused_all + ended(OutcomeCode::link_lost)},
            {Phase::verifying, ended(OutcomeCode::link_lost)}, // the next start asks the printer about these
            {Phase::starting, ended(OutcomeCode::link_lost)},
            {Phase::printing, sent},
            {Phase::stopping, sent},
            {Phase::judging, ended(OutcomeCode::link_lost)},
            {Phase::finishing, ended(OutcomeCode::finished, "ready for print start, error " + std::to_string(end_message))},
            {Phase::clearing, ended(OutcomeCode::link_lost)},
            {Phase::ended, ""},
        },
        [](Story& story) { story.link_lost(); });
}

TEST(FeederStopping, shouldSayWhetherRecordsMayHaveGoneOut) {
    for (const Phase phase : all_phases) {
        Story story = reach(phase);
        if (phase == Phase::ended) {
            continue;
        }
        story.link_lost();
        const auto& end = std::get<End>(story.actions[story.actions.size() - 1]);
        EXPECT_EQ(end.outcome.issued, phase >= Phase::verifying) << static_cast<int>(phase);
    }
}

TEST(FeederStopping, shouldStopWhenTheLedgerFailsInEveryPhase) {
    const auto end = [](const std::string& state) { return ended(OutcomeCode::storage_failed, state); };
    expect_in_every_phase(
        {
            {Phase::idle, end("standby, error 0")},
            {Phase::identifying, end("standby, error 0")},
            {Phase::locating, ended(OutcomeCode::storage_failed)},
            {Phase::taking_over, "!ST; " + end("printing, error 0")},
            {Phase::halting, end("printing, error 0")},
            {Phase::opening_nozzle, end("ready for action, error 0")},
            {Phase::acknowledging, end("ready for print start, error " + std::to_string(end_message))},
            {Phase::granting, ended(OutcomeCode::storage_failed)},
            {Phase::flushing, stop_and_ask},
            {Phase::setting_stop, stop_and_ask},
            {Phase::loading, stop_and_ask},
            {Phase::verifying, stop_and_ask},
            {Phase::starting, stop_and_ask},
            {Phase::printing, stop_and_ask},
            {Phase::stopping, ""},
            {Phase::judging, ""},
            {Phase::finishing, end("ready for print start, error " + std::to_string(end_message))},
            {Phase::clearing, ended(OutcomeCode::storage_failed)}, // no flush: the truth is not in the ledger
            {Phase::ended, ""},
        },
        [](Story& story) { story.storage_failed(); });
}

TEST(FeederStopping, shouldNeitherFlushNorAcknowledgeWhatTheLedgerDoesNotKnow) {
    Story story = reach(Phase::verifying);
    story.storage_failed();
    story.take();
    story.judge(3, 77, true, 1000);
    story.expect("settle: printed none, in doubt none, unused 101-104 by mail status; " + ended(OutcomeCode::storage_failed));

    story = reach(Phase::stopping); // it fails on the way
    story.storage_failed();
    story.judge(0, 104, true, 1004, end_message);
    story.expect("settle: printed 101-104, in doubt none, unused none by mail status and total print counter; " +
                 ended(OutcomeCode::storage_failed, "ready for print start, error " + std::to_string(end_message)));

    story = reach(Phase::printing);
    story.sm(1, 104, 110);
    story.sm(1, 108, 110);
    story.storage_failed();
    story.judge(0, 110, true, 1010, end_message);
    EXPECT_EQ(story.take().find("!EQ"), std::string::npos) << "all printed, but nobody could write it down";
    EXPECT_EQ(story.phase(), Phase::ended);
}

TEST(FeederStopping, shouldEndWhenThePrinterDoesNotSayItsStateOrPlaceInEveryPhase) {
    for (const Parameter what : {Parameter::RS, Parameter::SM}) {
        const auto end = [](const std::string& state) { return ended(OutcomeCode::no_answer, state); };
        expect_in_every_phase(
            {
                {Phase::idle, end("standby, error 0")},
                {Phase::identifying, end("standby, error 0")},
                {Phase::locating, ended(OutcomeCode::no_answer)},
                {Phase::taking_over, end("printing, error 0")},
                {Phase::halting, end("printing, error 0")},
                {Phase::opening_nozzle, end("ready for action, error 0")},
                {Phase::acknowledging, end("ready for print start, error " + std::to_string(end_message))},
                {Phase::granting, ended(OutcomeCode::no_answer)},
                {Phase::flushing, ended(OutcomeCode::no_answer)},
                {Phase::setting_stop, unused_all + ended(OutcomeCode::no_answer)},
                {Phase::loading, unused_all + ended(OutcomeCode::no_answer)},
                {Phase::verifying, "!ST; " + ended(OutcomeCode::no_answer)}, // it may still listen
                {Phase::starting, "!ST; " + ended(OutcomeCode::no_answer)},
                {Phase::printing, "!ST; " + end("printing, error 0")},
                {Phase::stopping, "!ST; " + end("printing, error 0")},
                {Phase::judging, "!ST; " + ended(OutcomeCode::no_answer)},
                {Phase::finishing,
                 ended(OutcomeCode::finished, "ready for print start, error " + std::to_string(end_message))},
                {Phase::clearing, "!ST; " + ended(OutcomeCode::no_answer)},
                {Phase::ended, ""},
            },
            [what](Story& story) { story.no_answer(what); });
    }
}

TEST(FeederStopping, shouldGoOnWithoutIdentityOrCounterInEveryPhase) {
    for (const Phase phase : all_phases) {
        for (const Parameter what : {Parameter::VS, Parameter::JL}) {
            Story story = reach(phase);
            story.no_answer(what);
            story.expect("");
            EXPECT_EQ(story.phase(), phase);
        }
    }
    Story story = reach(Phase::judging);
    story.rs(State::ready_to_print);
    story.sm(0, 104, 0);
    story.sm(0, 104, 0);
    story.take();
    story.no_answer(Parameter::CC);
    story.expect("settle: printed 101-104, in doubt none, unused none by mail status; " + ended(OutcomeCode::stop_requested));
}

// The deadline of every phase.

TEST(FeederStopping, shouldKeepTheDeadlineOfEveryPhase) {
    struct Deadline {
        Duration after;
        std::string story;
    };
    const std::map<Phase, Deadline> deadlines{
        {Phase::halting, {seconds{10}, ended(OutcomeCode::did_not_stop, "printing, error 0")}},
        {Phase::opening_nozzle, {seconds{120}, ended(OutcomeCode::not_ready, "ready for action, error 0")}},
        {Phase::acknowledging,
         {seconds{2}, ended(OutcomeCode::error_pending, "ready for print start, error " + std::to_string(end_message))}},
        {Phase::flushing, {seconds{2}, stop_and_ask}},
        {Phase::verifying, {seconds{5}, stop_and_ask}},
        {Phase::starting, {seconds{15}, stop_and_ask}},
        {Phase::stopping, {seconds{10}, ended(OutcomeCode::did_not_stop, "printing, error 0")}},
        {Phase::locating, {seconds{2}, ""}},
        {Phase::judging, {seconds{2}, ""}},
        {Phase::taking_over, {seconds{2}, ""}},
        {Phase::clearing, {seconds{10}, ended(OutcomeCode::stop_requested)}},
        {Phase::finishing,
         {seconds{2}, ended(OutcomeCode::finished, "ready for print start, error " + std::to_string(end_message))}},
    };
    for (const Phase phase : all_phases) {
        SCOPED_TRACE(testing::Message() << "phase " << static_cast<int>(phase));
        Story story = reach(phase);
        const auto deadline = deadlines.find(phase);
        if (deadline == deadlines.end()) {
            if (phase != Phase::printing) {
                EXPECT_EQ(story.feeder.next_wake(), std::nullopt) << "it waits for a fact, however long that takes";
            }
            continue;
        }
        const Instant entered = story.now;
        ASSERT_EQ(story.feeder.next_wake(), entered + deadline->second.after);
        story.wait(deadline->second.after - milliseconds{1});
        story.expect("");
        story.wait(milliseconds{1});
        story.expect(deadline->second.story);
        EXPECT_NE(story.feeder.next_wake(), story.now) << "it would wake up for ever";
    }
}

// What the printer does.

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
    story.expect("settle: printed 103-104, in doubt none, unused 105-106 by mail status and total print counter; " +
                 ended(OutcomeCode::stop_requested));
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
    EXPECT_EQ(story.take().find("settle: printed 101-104, in doubt none, unused none"), 0U);
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
    story.expect("settle: printed 101-101, in doubt 102-102, unused 103-104 by mail status and total print counter; " +
                 ended(OutcomeCode::stop_requested));
}

TEST(FeederStopping, shouldNoticeAStopAtThePrinter) {
    Story story = reach(Phase::printing);
    story.rs(State::ready_to_print);
    story.expect("?RS");
    story.judge(0, 102, true, 1002);
    story.expect("settle: printed 101-102, in doubt none, unused 103-104 by mail status and total print counter; " +
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
        story.expect("settle: printed 101-104, in doubt none, unused none by mail status and total print counter; " +
                     ended(OutcomeCode::printer_error, "ready for print start, error " + std::to_string(raw_error(code))));
    }
}

TEST(FeederStopping, shouldReportAnEndMessageBeforeTheEndAsAnError) {
    Story story = reach(Phase::printing);
    story.rs(State::ready_to_print, end_message);
    story.judge(0, 103, true, 1003, end_message);
    story.expect("settle: printed 101-103, in doubt none, unused 104-104 by mail status and total print counter; " +
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

TEST(FeederStopping, shouldReportAnOpenCover) {
    Story story = reach(Phase::printing);
    story.rs(State::ready_to_print, 0, true);
    story.rs(State::ready_to_print, 0, true);
    story.sm(0, 102, 0);
    story.sm(0, 102, 0);
    story.take();
    story.cc(1002);
    EXPECT_NE(story.take().find("end: cover_open"), std::string::npos);
}

TEST(FeederStopping, shouldStopWhenThePrinterHasLostItsMemory) {
    for (const std::uint32_t back_to : {0U, 77U, 101U}) {
        Story story = reach(Phase::printing);
        story.sm(1, 102, 110);
        story.take();
        story.sm(0, back_to, 110);
        story.expect("!ST; ?RS");
        story.judge(0, back_to, true, 1003);
        const auto& settle = std::get<Settle>(story.actions[0]);
        EXPECT_FALSE(settle.evidence.uninterrupted);
        story.expect((back_to == 0 ? "settle: printed none, in doubt 103-103, unused 104-106 by total print counter; "
                                   : "settle: printed none, in doubt 103-106, unused none by no evidence; ") +
                     ended(OutcomeCode::printer_restarted));
    }
}

TEST(FeederStopping, shouldStopWhenThePrinterReportsWhatWasNeverSent) {
    for (const std::uint32_t number : {105U, 99U, 4294967295U}) {
        Story story = reach(Phase::printing);
        story.sm(1, number, 110);
        story.expect("!ST; ?RS");
        story.judge(0, number, true, 1004);
        EXPECT_NE(story.take().find("in doubt 101-104"), std::string::npos);
    }
}

TEST(FeederStopping, shouldSayThatAnotherProgramFeedsThePrinter) {
    Story story = reach(Phase::printing);
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
    story.expect("settle: printed none, in doubt 101-104, unused none by no evidence; " + ended(OutcomeCode::stop_requested));
}

TEST(FeederStopping, shouldFlushWhatWasNeverStartedOnlyWhenTheLedgerKnows) {
    Story story = reach(Phase::clearing);
    story.rs(State::ready_to_print);
    story.sm(3, 77, 0);
    story.expect("");
    story.settled();
    story.expect("!FF; " + ended(OutcomeCode::stop_requested));
}

TEST(FeederStopping, shouldTakeTheLedgersWordOnlyWhereItIsAwaited) {
    for (const Phase phase : all_phases) {
        if (phase != Phase::clearing) {
            Story story = reach(phase);
            story.settled();
            story.expect("");
            EXPECT_EQ(story.phase(), phase);
        }
    }
}

TEST(FeederStopping, shouldFinishWhenAStopComesTooLate) {
    Story story = reach(Phase::printing);
    story.sm(1, 104, 110);
    story.sm(1, 108, 110);
    story.stop();
    story.judge(0, 110, true, 1010, end_message);
    story.expect("settle: printed 109-110, in doubt none, unused none by end message 1223; !EQ; ?RS");
    story.rs(State::ready_to_print);
    story.expect(ended(OutcomeCode::finished));
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
    story.sm(1, 104, 110);
    story.sm(1, 108, 110);
    story.take();
    story.rs(State::ready_to_print, odd);
    story.judge(0, 110, true, 1010, odd);
    story.expect("settle: printed 109-110, in doubt none, unused none by end message 1223; !EQ; ?RS");
}

TEST(FeederStopping, shouldFinishOverAnUnderstoodErrorWhenAllIsPrinted) {
    Story story = reach(Phase::printing);
    story.sm(1, 104, 110);
    story.sm(1, 108, 110);
    story.rs(State::ready_to_print, raw_error(5043));
    story.judge(0, 110, true, 1010, raw_error(5043));
    EXPECT_NE(story.take().find("end: finished"), std::string::npos);
}

TEST(FeederStopping, shouldDoNothingAfterTheEnd) {
    for (const Phase phase : all_phases) {
        Story story = reach(phase);
        story.link_lost();
        story.take();
        story.rs(State::printing);
        story.rs(State::ready_to_print, end_message);
        story.sm(1, 104, 110);
        story.cc(1004);
        story.vs("S2");
        story.jl();
        story.granted();
        story.refused(OutcomeCode::nothing_to_print);
        story.durable(110);
        story.supplied(110);
        story.settled();
        story.storage_failed();
        story.stop();
        story.wait(seconds{1000});
        for (const Parameter what : {Parameter::RS, Parameter::SM, Parameter::VS, Parameter::JL, Parameter::CC}) {
            story.no_answer(what);
        }
        story.link_lost();
        story.expect("");
        EXPECT_EQ(story.feeder.next_wake(), std::nullopt);
    }
}

} // namespace
} // namespace linefeed::feeder
