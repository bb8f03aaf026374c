// Actions compare and print, so that a failing story can be read; notices and outcomes have words for people.
#include "feeder/actions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <sstream>

namespace linefeed::feeder {
namespace {

std::string text(const Action& action) {
    std::ostringstream out;
    out << action;
    return out.str();
}

RecordRange records(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

TEST(Actions, shouldPrintAsAStory) {
    EXPECT_EQ(text({}), "nothing");
    EXPECT_EQ(text(Inquire{protocol::Parameter::SM}), "?SM");
    EXPECT_EQ(text(Command{protocol::Action::start_print}), "!GO");
    EXPECT_EQ(text(SetStopAt{RecordNumber{7}}), "=CM 7");
    EXPECT_EQ(text(SendRecords{records(1, 5)}), "=MR 1-5");
    EXPECT_EQ(text(SendEndMarker{RecordNumber{6}}), "end marker 6");
    Settle settle;
    settle.verdict.printed = records(1, 2);
    settle.verdict.in_doubt = records(3, 3);
    settle.verdict.unused = records(4, 9);
    settle.verdict.basis = Basis::mail_status;
    EXPECT_EQ(text(settle), "settle this run: printed 1-2, in doubt 3-3, unused 4-9 by mail status");
    settle.earlier_run = true;
    EXPECT_EQ(text(settle), "settle the earlier run: printed 1-2, in doubt 3-3, unused 4-9 by mail status");
    EXPECT_EQ(text(BeginRun{{}, RecordNumber{3}}), "begin run, last printed before 3");
    EXPECT_EQ(text(AdoptRun{RecordNumber{3}, RecordNumber{7}, {}}), "adopt run, printed through 3, sent through 7");
    EXPECT_EQ(text(AskIntent{RecordNumber{100}}), "intent through 100");
    EXPECT_EQ(text(ConfirmPrinted{RecordNumber{5}, {}}), "printed through 5");
    EXPECT_EQ(text(Notice{NoticeCode::printing_started, {}}), "notice: printing");
    EXPECT_EQ(text(End{{OutcomeCode::finished, protocol::MachineState::ready_to_print, {}, true}}),
              "end: finished (ready for print start, error 0)");
}

TEST(Actions, shouldCompareByWhatTheyDo) {
    EXPECT_EQ(Action{SendRecords{records(1, 5)}}, Action{SendRecords{records(1, 5)}});
    EXPECT_NE(Action{SendRecords{records(1, 5)}}, Action{SendRecords{records(1, 6)}});
    EXPECT_NE(Action{Inquire{protocol::Parameter::RS}}, Action{Inquire{protocol::Parameter::SM}});
    EXPECT_NE(Action{SetStopAt{RecordNumber{1}}}, Action{SendEndMarker{RecordNumber{1}}});
}

/// A value of each kind, and one that differs in one member.
TEST(Actions, shouldCompareEveryMember) {
    const auto expect_differs = [](const Action& one, const Action& other) {
        EXPECT_EQ(one, Action{one});
        EXPECT_NE(one, other) << text(one);
    };
    expect_differs(Command{protocol::Action::start_print}, Command{protocol::Action::stop_print});
    expect_differs(SetStopAt{RecordNumber{1}}, SetStopAt{RecordNumber{2}});
    expect_differs(SendEndMarker{RecordNumber{1}}, SendEndMarker{RecordNumber{2}});
    expect_differs(AskIntent{RecordNumber{1}}, AskIntent{RecordNumber{2}});
    expect_differs(BeginRun{{}, RecordNumber{1}}, BeginRun{{}, RecordNumber{2}});
    expect_differs(BeginRun{{.version = {}, .total_prints = 1, .job_name = {}}, {}}, BeginRun{});
    expect_differs(AdoptRun{RecordNumber{1}, RecordNumber{3}, {}}, AdoptRun{RecordNumber{1}, RecordNumber{4}, {}});
    expect_differs(ConfirmPrinted{RecordNumber{1}, {}}, ConfirmPrinted{RecordNumber{1}, {.depth = 256}});
    expect_differs(Notice{NoticeCode::printer_warning, {1}}, Notice{NoticeCode::printer_warning, {2}});
    expect_differs(End{{OutcomeCode::finished, {}, {}, false}}, End{{OutcomeCode::finished, {}, {}, true}});
    Settle settle;
    settle.evidence.restarted = true;
    expect_differs(Settle{}, settle);
    settle = {};
    settle.verdict.unused = records(1, 2);
    expect_differs(Settle{}, settle);
    const OpenRun run{RecordNumber{1}, RecordNumber{2}, RecordNumber{3}, "S1", 4, RecordNumber{5}};
    OpenRun other = run;
    EXPECT_EQ(run, other);
    other.total_before.reset();
    EXPECT_NE(run, other);
}

TEST(Actions, shouldHaveWordsForEveryNotice) {
    std::set<std::string> seen;
    for (const NoticeCode code : {NoticeCode::printing_started, NoticeCode::stop_point_ignored,
                                  NoticeCode::error_acknowledged, NoticeCode::printer_warning, NoticeCode::taken_over,
                                  NoticeCode::found_printing, NoticeCode::nozzle_opening, NoticeCode::entries_differ}) {
        const std::string words = describe(Notice{code, {1223}});
        EXPECT_FALSE(words.empty());
        EXPECT_EQ(words.find('\n'), std::string::npos);
        EXPECT_TRUE(seen.insert(words).second) << words;
    }
    EXPECT_NE(describe(Notice{NoticeCode::error_acknowledged, {1223}}).find("1223"), std::string::npos);
    EXPECT_NE(describe(Notice{NoticeCode::printer_warning, {10202}}).find("10202"), std::string::npos);
}

constexpr std::array all_codes{
    OutcomeCode::finished,          OutcomeCode::nothing_to_print,
    OutcomeCode::stop_requested,    OutcomeCode::stopped_at_printer,
    OutcomeCode::printer_error,     OutcomeCode::not_ready,
    OutcomeCode::cover_open,        OutcomeCode::busy,
    OutcomeCode::error_pending,     OutcomeCode::fifo_not_flushed,
    OutcomeCode::records_not_taken, OutcomeCode::did_not_start,
    OutcomeCode::did_not_stop,      OutcomeCode::impossible_report,
    OutcomeCode::printer_restarted, OutcomeCode::no_answer,
    OutcomeCode::not_secured,       OutcomeCode::link_lost,
    OutcomeCode::unreachable,       OutcomeCode::records_in_doubt,
    OutcomeCode::storage_failed,    OutcomeCode::ran_dry,
    OutcomeCode::line_noise,
};

TEST(Outcome, shouldHaveANameAndWordsForEveryCode) {
    std::set<std::string> names;
    std::set<std::string> words;
    for (const OutcomeCode code : all_codes) {
        EXPECT_TRUE(names.insert(std::string{to_string(code)}).second);
        const std::string described = describe(Outcome{code, protocol::MachineState::ready, {4711}, false});
        EXPECT_FALSE(described.empty());
        EXPECT_EQ(described.find('\n'), std::string::npos);
        EXPECT_TRUE(words.insert(described).second) << described;
    }
}

TEST(Outcome, shouldNameTheCauseOfABreakInTheNumbers) {
    for (const std::uint32_t code : {1018U, 1019U, 5043U}) {
        Outcome outcome{.code = OutcomeCode::printer_error};
        outcome.error.raw = static_cast<std::int32_t>(code);
        EXPECT_EQ(describe(outcome).find("a record was lost on the line") != std::string::npos, code != 5043) << code;
    }
}

TEST(Outcome, shouldSayWhatToDoInEveryStateThatDoesNotAllowAStart) {
    std::set<std::string> words;
    for (const auto state :
         {protocol::MachineState::unknown, protocol::MachineState::standby, protocol::MachineState::initialising,
          protocol::MachineState::service, protocol::MachineState::ready, protocol::MachineState::ready_to_print,
          protocol::MachineState::printing}) {
        const std::string described = describe(Outcome{OutcomeCode::not_ready, state, {}, false});
        EXPECT_NE(described.find(protocol::to_string(state)), std::string::npos);
        EXPECT_TRUE(words.insert(described).second);
    }
    EXPECT_NE(describe(Outcome{OutcomeCode::not_ready, protocol::MachineState::ready, {}, false}).find("--open-nozzle"),
              std::string::npos);
}

TEST(Outcome, shouldNameTheErrorAndTheOptionThatAllowsIt) {
    const Outcome outcome{OutcomeCode::error_pending, protocol::MachineState::ready_to_print, {4711}, false};
    EXPECT_NE(describe(outcome).find("--acknowledge 4711"), std::string::npos);
    EXPECT_NE(describe(Outcome{OutcomeCode::printer_error, protocol::MachineState::ready, {5043}, true}).find("5043"),
              std::string::npos);
}

} // namespace
} // namespace linefeed::feeder
