// The evidence that stands in the ledger, byte for byte: a later linefeed has to read it.
#include "store/evidence_json.hpp"

#include <gtest/gtest.h>

namespace linefeed::store {
namespace {

feeder::BeginRun begin_with_everything() {
    feeder::BeginRun begin;
    begin.printer.version.emplace();
    begin.printer.version->serial_number = "104711";
    begin.printer.version->type = "JET3up";
    begin.printer.version->firmware = "V62.0.9.0";
    begin.printer.total_prints = 4294967295U;
    begin.printer.job_name = "\\FFSDISK\\JOBS\\Testprint.job";
    begin.last_printed_before = RecordNumber{22117};
    return begin;
}

TEST(EvidenceJson, shouldWriteWhatAPrinterSaidOfItself) {
    EXPECT_EQ(run_start_json("tcp://10.0.0.5:3000", begin_with_everything()),
              R"({"printer":"tcp://10.0.0.5:3000","serial_number":"104711","type":"JET3up","firmware":"V62.0.9.0",)"
              R"("total_before":4294967295,"job":"\\FFSDISK\\JOBS\\Testprint.job","last_printed_before":22117})");
}

TEST(EvidenceJson, shouldReadARunStartBack) {
    const auto start = parse_run_start(run_start_json("tcp://10.0.0.5:3000", begin_with_everything()));
    EXPECT_EQ(start, (RunStart{"tcp://10.0.0.5:3000", "104711", 4294967295U, RecordNumber{22117}}));
}

TEST(EvidenceJson, shouldReadBackAPrinterThatSaidNothing) {
    const auto start = parse_run_start(run_start_json("tcp://10.0.0.5:3000", {}));
    EXPECT_EQ(start, (RunStart{"tcp://10.0.0.5:3000", "", std::nullopt, RecordNumber{}}));
}

TEST(EvidenceJson, shouldSurviveAnyBytesInThePrintersStrings) {
    feeder::BeginRun begin = begin_with_everything();
    begin.printer.version->serial_number = "10\xFF\"\t";
    const auto start = parse_run_start(run_start_json("tcp://10.0.0.5:3000", begin));
    ASSERT_TRUE(start);
    EXPECT_EQ(start->total_before, 4294967295U);
    EXPECT_TRUE(start->serial_number.starts_with("10")) << start->serial_number;
}

TEST(EvidenceJson, shouldNotReadWhatIsNoRunStart) {
    for (const char* text : {"", "{", "[]", "null", "7", "\"printer\"", "{}", R"({"printer":7})",
                             R"({"serial_number":"1"})", R"({"printer":"tcp://a:1")"}) {
        EXPECT_EQ(parse_run_start(text), std::nullopt) << text;
    }
}

TEST(EvidenceJson, shouldTakeValuesOfTheWrongTypeForAbsent) {
    EXPECT_EQ(parse_run_start(R"({"printer":"a","serial_number":1,"total_before":-1,"last_printed_before":"x"})"),
              (RunStart{"a", "", std::nullopt, RecordNumber{}}));
}

TEST(EvidenceJson, shouldWriteTheMailStatusInTheOrderOfTheProtocol) {
    const protocol::MailStatus mail{256, 253, RecordNumber{22119}, RecordNumber{100000}, false, 21};
    EXPECT_EQ(mail_json(mail), R"({"sm":[256,253,22119,100000,0]})");
}

TEST(EvidenceJson, shouldSayWhatAVerdictRestsOn) {
    feeder::Settle settle;
    settle.verdict.basis = feeder::Basis::mail_status_and_counter;
    settle.evidence.mail = {256, 0, RecordNumber{100000}, RecordNumber{}, true, {}};
    const std::string basis{to_string(settle.verdict.basis)};
    EXPECT_EQ(settle_json(settle), R"({"basis":")" + basis + R"(","sm":[256,0,100000,0,1]})");
    settle.evidence.printer.total_prints = 77883;
    settle.evidence.printer.version.emplace();
    settle.evidence.printer.version->serial_number = "104711";
    EXPECT_EQ(settle_json(settle),
              R"({"basis":")" + basis + R"(","sm":[256,0,100000,0,1],"total":77883,"serial_number":"104711"})");
    settle.evidence.restarted = true; // the operator has to be asked for ranges then
    EXPECT_TRUE(settle_json(settle).ends_with(R"("serial_number":"104711","restarted":true})"));
}

TEST(EvidenceJson, shouldKeepTheErrorNumberAsThePrinterSentIt) {
    EXPECT_EQ(outcome_json({feeder::OutcomeCode::finished, protocol::MachineState::ready_to_print, {}, true}),
              R"({"outcome":"finished","machine":"ready for print start"})");
    EXPECT_EQ(
        outcome_json({feeder::OutcomeCode::printer_error, protocol::MachineState::ready_to_print, {-1711274809}, true}),
        R"({"outcome":"printer_error","machine":"ready for print start","error":-1711274809})");
}

TEST(EvidenceJson, shouldReadBackThatAPrintMayBeBrokenOff) {
    feeder::Outcome outcome{feeder::OutcomeCode::link_lost,
                            protocol::MachineState::ready_to_print,
                            {-1711274809},
                            true,
                            RecordNumber{4294967295}};
    EXPECT_EQ(outcome_json(outcome), R"({"outcome":"link_lost","machine":"ready for print start","error":-1711274809,)"
                                     R"("broken_off":4294967295})");
    EXPECT_EQ(parse_run_end(outcome_json(outcome)), (RunEnd{RecordNumber{4294967295}, false}));
    outcome.broken_off = RecordNumber{};
    EXPECT_EQ(parse_run_end(outcome_json(outcome)), RunEnd{});
    EXPECT_EQ(parse_run_end(R"({"broken_off":"7"})"), RunEnd{});
    EXPECT_EQ(parse_run_end("{"), std::nullopt);
}

TEST(EvidenceJson, shouldReadBackThatNobodyKnewTheRecords) {
    feeder::Outcome outcome;
    outcome.code = feeder::OutcomeCode::link_lost;
    outcome.unclear = true;
    EXPECT_EQ(outcome_json(outcome), R"({"outcome":"link_lost","machine":"standby","unclear":true})");
    EXPECT_EQ(parse_run_end(outcome_json(outcome)), (RunEnd{RecordNumber{}, true}));
    EXPECT_EQ(parse_run_end(R"({"unclear":false,"other":true})"), RunEnd{});
    EXPECT_EQ(parse_run_end(R"({"unclear":1,"of":{"unclear":true}})"), RunEnd{});
}

} // namespace
} // namespace linefeed::store
