// What ends a run early, in every phase: for each, one table of what the feeder does then; and that nothing follows.
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

std::string ended(OutcomeCode code, const std::string& state = "ready for print start, error 0") {
    return "end: " + std::string{to_string(code)} + " (" + state + ")";
}

TEST(FeederEveryPhase, shouldStopOnRequestInEveryPhase) {
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
            {Phase::recording, ""},
            {Phase::clearing, ""},
            {Phase::ended, ""},
        },
        [](Story& story) { story.stop(); });
}

TEST(FeederEveryPhase, shouldEndWhenTheLinkIsLostInEveryPhase) {
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
            {Phase::flushing, ended(OutcomeCode::link_lost)},     // the flush may not have arrived
            {Phase::setting_stop, ended(OutcomeCode::link_lost)}, // granted, but nothing went out
            {Phase::loading, ended(OutcomeCode::link_lost)},
            {Phase::verifying, ended(OutcomeCode::link_lost)}, // the next start asks the printer about these
            {Phase::starting, ended(OutcomeCode::link_lost)},
            {Phase::printing, sent},
            {Phase::stopping, sent},
            {Phase::judging, ended(OutcomeCode::link_lost)},
            {Phase::finishing,
             ended(OutcomeCode::finished, "ready for print start, error " + std::to_string(end_message))},
            {Phase::recording, ended(OutcomeCode::link_lost)},
            {Phase::clearing, ended(OutcomeCode::link_lost)},
            {Phase::ended, ""},
        },
        [](Story& story) { story.link_lost(); });
}

TEST(FeederEveryPhase, shouldSayWhetherRecordsMayHaveGoneOut) {
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

TEST(FeederEveryPhase, shouldStopWhenTheLedgerFailsInEveryPhase) {
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
            {Phase::judging, ended(OutcomeCode::storage_failed)},
            {Phase::finishing, end("ready for print start, error " + std::to_string(end_message))},
            {Phase::recording, ended(OutcomeCode::storage_failed)}, // no flush: the truth is not in the ledger
            {Phase::clearing, ended(OutcomeCode::storage_failed)},
            {Phase::ended, ""},
        },
        [](Story& story) { story.storage_failed(); });
}

TEST(FeederEveryPhase, shouldNeitherFlushNorAcknowledgeWhatTheLedgerDoesNotKnow) {
    for (const Phase phase : {Phase::verifying, Phase::printing, Phase::stopping}) {
        Story story = reach(phase);
        story.storage_failed();
        story.take();
        story.rs(State::ready_to_print, end_message);
        story.expect(ended(OutcomeCode::storage_failed, "ready for print start, error " + std::to_string(end_message)));
    }
}

TEST(FeederEveryPhase, shouldEndWhenThePrinterIsSilentInEveryPhase) {
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
            {Phase::setting_stop, ended(OutcomeCode::no_answer)},
            {Phase::loading, ended(OutcomeCode::no_answer)},
            {Phase::verifying, "!ST; " + ended(OutcomeCode::no_answer)}, // it may still listen
            {Phase::starting, "!ST; " + ended(OutcomeCode::no_answer)},
            {Phase::printing, "!ST; " + end("printing, error 0")},
            {Phase::stopping, "!ST; " + end("printing, error 0")},
            {Phase::judging, "!ST; " + ended(OutcomeCode::no_answer)},
            {Phase::finishing,
             ended(OutcomeCode::finished, "ready for print start, error " + std::to_string(end_message))},
            {Phase::recording, "!ST; " + ended(OutcomeCode::no_answer)},
            {Phase::clearing, "!ST; " + ended(OutcomeCode::no_answer)},
            {Phase::ended, ""},
        },
        [](Story& story) { story.silent(); });
}

/// `?SM` is asked again where nothing goes on without it; while it prints, it comes again by itself.
TEST(FeederEveryPhase, shouldAskAgainForALostMailStatusWhereItIsNeeded) {
    expect_in_every_phase(
        {
            {Phase::idle, ""},          {Phase::identifying, ""},
            {Phase::locating, "?SM"},   {Phase::taking_over, "?SM"},
            {Phase::halting, ""},       {Phase::opening_nozzle, ""},
            {Phase::acknowledging, ""}, {Phase::granting, ""},
            {Phase::flushing, "?SM"},   {Phase::setting_stop, "?SM"},
            {Phase::loading, ""},       {Phase::verifying, "?SM"},
            {Phase::starting, ""},      {Phase::printing, ""},
            {Phase::stopping, ""},      {Phase::judging, "?SM"},
            {Phase::finishing, ""},     {Phase::recording, ""},
            {Phase::clearing, "?SM"},   {Phase::ended, ""},
        },
        [](Story& story) {
            for (int outstanding = 0; outstanding < 4 && story.text_of_actions().empty(); ++outstanding) {
                story.lost(Parameter::SM); // all that were under way
            }
        });
}

TEST(FeederEveryPhase, shouldAskAgainForALostMachineStatusWhereItIsNeeded) {
    expect_in_every_phase(
        {
            {Phase::idle, ""},
            {Phase::identifying, "?RS"},
            {Phase::locating, ""},
            {Phase::taking_over, ""},
            {Phase::halting, "?RS"},
            {Phase::opening_nozzle, "?RS"},
            {Phase::acknowledging, "?RS"},
            {Phase::granting, ""},
            {Phase::flushing, ""},
            {Phase::setting_stop, ""},
            {Phase::loading, ""},
            {Phase::verifying, ""},
            {Phase::starting, "?RS"},
            {Phase::printing, "?RS"},
            {Phase::stopping, "?RS"},
            {Phase::judging, "?RS"},
            {Phase::finishing, "?RS"},
            {Phase::recording, ""},
            {Phase::clearing, "?RS"},
            {Phase::ended, ""},
        },
        [](Story& story) { story.lost(Parameter::RS); });
}

TEST(FeederEveryPhase, shouldGiveUpWhenAnAnswerIsLostAgainAndAgain) {
    Story story = reach(Phase::judging);
    story.lost(Parameter::RS);
    story.lost(Parameter::RS);
    story.lost(Parameter::RS);
    story.expect("?RS; ?RS; ?RS");
    story.lost(Parameter::RS);
    story.expect("!ST; " + ended(OutcomeCode::no_answer));
}

/// A digit may be damaged, so a state that the manual does not name is asked about again before it is believed.
TEST(FeederEveryPhase, shouldBelieveAStateThatNobodyKnowsOnlyWhenItStays) {
    Story story = reach(Phase::identifying);
    story.take();
    for (int i = 0; i < 3; ++i) {
        story.rs(State::unknown);
        story.expect("?RS");
    }
    story.rs(State::unknown);
    story.expect(ended(OutcomeCode::not_ready, "unknown, error 0"));
}

TEST(FeederEveryPhase, shouldWaitForTheFillAsLongAsRecordsArrive) {
    Story story = reach(Phase::verifying);
    const Duration nearly = FeederSettings{}.verify_timeout - std::chrono::milliseconds{1};
    for (int i = 0; i < 3; ++i) {
        story.wait(nearly);
        EXPECT_EQ(story.phase(), Phase::verifying);
        story.feeder.on_proven_record(story.now);
    }
    story.wait(2 * nearly);
    EXPECT_EQ(story.phase(), Phase::stopping);
    story.feeder.on_proven_record(story.now);
    story.wait(std::chrono::minutes{1});
    EXPECT_EQ(story.phase(), Phase::ended) << "that changes nothing later";
}

TEST(FeederEveryPhase, shouldEndWhenThePrinterAnswersWithoutTheCrcThatWasAskedFor) {
    Story story = reach(Phase::identifying);
    story.take();
    story.feeder.on_not_secured(story.actions);
    story.expect(ended(OutcomeCode::not_secured, "standby, error 0"));
    story.feeder.on_not_secured(story.actions);
    story.expect("");
}

TEST(FeederEveryPhase, shouldGoOnWithoutIdentityOrCounterInEveryPhase) {
    for (const Phase phase : all_phases) {
        for (const Parameter what : {Parameter::VS, Parameter::JL}) {
            Story story = reach(phase);
            story.lost(what);
            story.expect("");
            EXPECT_EQ(story.phase(), phase);
        }
    }
    Story story = reach(Phase::judging);
    story.rs(State::ready_to_print);
    story.sm(0, 104, 0);
    story.sm(0, 104, 0);
    story.take();
    story.lost(Parameter::CC);
    story.lost(Parameter::CC);
    story.lost(Parameter::CC);
    story.expect("?CC; ?CC; ?CC"); // it has been answered before
    story.lost(Parameter::CC);
    story.expect("settle this run: printed 101-104, in doubt none, unused none by mail status; " +
                 ended(OutcomeCode::stop_requested));
}

// The deadline of every phase.

TEST(FeederEveryPhase, shouldKeepTheDeadlineOfEveryPhase) {
    struct Deadline {
        Duration after;
        std::string story;
    };
    const std::map<Phase, Deadline> deadlines{
        {Phase::halting, {seconds{10}, ended(OutcomeCode::did_not_stop, "printing, error 0")}},
        {Phase::opening_nozzle, {seconds{120}, ended(OutcomeCode::not_ready, "ready for action, error 0")}},
        {Phase::acknowledging,
         {seconds{2},
          ended(OutcomeCode::error_pending, "ready for print start, error " + std::to_string(end_message))}},
        {Phase::flushing, {seconds{2}, stop_and_ask}},
        {Phase::verifying, {seconds{5}, stop_and_ask}},
        {Phase::starting, {seconds{15}, stop_and_ask}},
        {Phase::stopping, {seconds{10}, ended(OutcomeCode::did_not_stop, "printing, error 0")}},
        {Phase::locating, {seconds{2}, ""}},
        {Phase::judging, {seconds{2}, ""}},
        {Phase::taking_over, {seconds{2}, ""}},
        {Phase::recording, {seconds{10}, ended(OutcomeCode::storage_failed)}},
        {Phase::clearing, {seconds{2}, ""}},
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
        if (phase == Phase::starting) { // it polls meanwhile
            story.wait(deadline->second.after - milliseconds{1});
            story.take();
        } else {
            ASSERT_EQ(story.feeder.next_wake(), story.now + deadline->second.after);
            story.wait(deadline->second.after - milliseconds{1});
            story.expect("");
        }
        story.wait(milliseconds{1});
        story.expect(deadline->second.story);
        EXPECT_NE(story.feeder.next_wake(), story.now) << "it would wake up for ever";
    }
}

TEST(FeederEveryPhase, shouldDoNothingAfterTheEnd) {
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
            story.lost(what);
        }
        story.silent();
        story.link_lost();
        story.expect("");
        EXPECT_EQ(story.feeder.next_wake(), std::nullopt);
    }
}

} // namespace
} // namespace linefeed::feeder
