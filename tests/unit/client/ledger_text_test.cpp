// The ledger of a job, for people and for programs.
#include "canned_service.hpp"
#include "client/ledger_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>

namespace linefeed::client {
namespace {

using testing::HasSubstr;

Json stretch(std::int64_t first, std::int64_t last, const std::string& state, std::int64_t run = 1) {
    return {{"first", first},
            {"last", last},
            {"count", last - first + 1},
            {"state", state},
            {"run", run},
            {"not_before", "2026-11-22T19:45:49.000Z"},
            {"not_before_ns", 1795376749000000000},
            {"not_after", "2026-11-22T19:45:50.123Z"},
            {"not_after_ns", 1795376750123000000},
            {"evidence", {{"sm", {1, 2}}}}};
}

TEST(LedgerText, shouldJoinNeighboursOfTheSameFateAndRunAndKeepTheSum) {
    const std::vector<Json> history{stretch(1, 4, "printed"), stretch(5, 5, "printed"), stretch(6, 6, "printed", 9),
                                    stretch(8, 10, "unused", 9)};
    EXPECT_EQ(ledger_text(job_json(12, "stopped", 6), history),
              "job 12, /data/names.csv, records 1-1000\n"
              "issued 9 = 6 printed + 0 in_doubt + 0 skipped + 0 released + 3 unused + 0 open\n"
              "  1-5  printed  (run 1)\n"
              "  6-6  printed  (run 9)\n"
              "  8-10  unused  (run 9)\n"
              "next to print: 7\n");
    const Json json = ledger_json(job_json(12, "stopped", 6), history);
    EXPECT_EQ(json["counts"]["printed"], 6);
    EXPECT_EQ(json["segments"].size(), 3U);
    EXPECT_EQ(json["segments"][0], (Json{{"first", 1}, {"last", 5}, {"state", "printed"}, {"run", 1}}));
}

TEST(LedgerText, shouldNameWhatWaitsForAnOperator) {
    EXPECT_THAT(ledger_text(job_json(12, "in_doubt", 4, 4),
                            {stretch(1, 4, "printed"), stretch(5, 7, "in_doubt"), stretch(9, 9, "in_doubt")}),
                HasSubstr("waiting for an operator: 5-7 and more (linefeed settle"));
}

TEST(LedgerText, shouldWriteRecordsAsCsvThatAnyReaderTakes) {
    const Json record{{"number", 5}, {"fields", {"a,\"b\"", "c"}}};
    EXPECT_EQ(record_head(RecordFormat::csv), "number,fields,state,not_before,not_after,run,evidence\r\n");
    EXPECT_EQ(
        record_line(record, stretch(1, 9, "printed"), RecordFormat::csv),
        "5,\"a,\"\"b\"\"\tc\",printed,2026-11-22T19:45:49.000Z,2026-11-22T19:45:50.123Z,1,\"{\"\"sm\"\":[1,2]}\"\r\n");
}

TEST(LedgerText, shouldWriteRecordsAsOneObjectALine) {
    const std::string line =
        record_line({{"number", 5}, {"fields", {"a\nb"}}}, stretch(1, 9, "printed"), RecordFormat::json);
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
    EXPECT_EQ(Json::parse(line)["fields"], Json({"a\nb"}));
    EXPECT_EQ(Json::parse(line)["number"], 5);
}

TEST(LedgerText, shouldEscapeRecordsForPeople) {
    ::setenv("TZ", "CET-1", 1);
    ::tzset();
    EXPECT_EQ(record_line({{"number", 5}, {"fields", {"\x1B[2J"}}}, stretch(1, 9, "printed"), RecordFormat::table),
              "5  printed  2026-11-22 20:45:50  run 1  \\x1B[2J  {\"sm\":[1,2]}\n");
}

} // namespace
} // namespace linefeed::client
