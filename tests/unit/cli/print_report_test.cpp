// What a person or a program is told at the end of `linefeed print`.
#include "cli/print_report.hpp"
#include "daemon/record_text.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

namespace linefeed::cli {

using daemon::record_fields;
using daemon::RecordFormat;
namespace {

using spool::LedgerEntry;
using spool::LedgerKind;

RecordRange closed(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

RecordPage page_of(const std::vector<std::string>& fields) {
    RecordPage page{RecordNumber{1}, {}, {}};
    for (std::size_t k = 0; k < fields.size(); ++k) {
        page.frames += "^0=MR" + std::to_string(k + 1) + "\t" + fields[k] + "\r";
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
    }
    return page;
}

TEST(RecordFields, shouldShowFieldsAsUtf8) {
    const RecordPage page = page_of({"M\xFCller\tBerlin", "\\^ \\\\"});
    EXPECT_EQ(record_fields(page, RecordNumber{1}, RecordFormat{}), (std::vector<std::string>{"Müller", "Berlin"}));
    EXPECT_EQ(record_fields(page, RecordNumber{2}, RecordFormat{}), std::vector<std::string>{"^ \\"});
}

TEST(RecordFields, shouldReadEachFieldByItsCharset) {
    const RecordPage page = page_of({"00480069\t\x80 5"});
    const RecordFormat format{{protocol::Charset::unicode_hex, protocol::Charset::windows_1252}, {}};
    EXPECT_EQ(record_fields(page, RecordNumber{1}, format), (std::vector<std::string>{"Hi", "€ 5"}));
}

class PrintReportTest : public testing::Test {
protected:
    PrintReportTest()
        : directory_(std::filesystem::temp_directory_path() / ("linefeed-report-" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(directory_);
        spool_.emplace(spool::Spool::open(directory_ / "spool.db", {[] { return std::int64_t{1}; }, {}}).value());
        spool::JobSpec spec;
        spec.source.path = "/data/names.csv";
        auto import = spool_->begin_import(spec).value();
        EXPECT_TRUE(import.add(page_of({"one", "two", "thr\x1b[2Jee", "four", "five"})));
        job_ = import.commit({}).value();
    }
    ~PrintReportTest() override {
        spool_.reset();
        std::filesystem::remove_all(directory_);
    }
    PrintReportTest(const PrintReportTest&) = delete;
    PrintReportTest& operator=(const PrintReportTest&) = delete;

    /// A run over the whole job whose ledger says the rest.
    void run(const std::vector<std::pair<LedgerKind, RecordRange>>& rows, const std::string& evidence = {}) {
        const spool::RunId run = spool_->begin_run(job_.id, job_.records, "{}").value();
        std::vector<LedgerEntry> entries{{LedgerKind::intent, run, job_.records, {}}};
        for (const auto& [kind, range] : rows) {
            entries.push_back({kind, run, range, evidence});
        }
        ASSERT_TRUE(spool_->append(job_.id, entries));
    }
    PrintReport report(feeder::OutcomeCode code, RecordRange wanted = closed(1, 5), const std::string& detail = {}) {
        return make_report(*spool_, job_, wanted, {code, protocol::MachineState::standby, {}, true}, detail).value();
    }
    static std::pair<std::string, std::string> shown(const PrintReport& report, bool json) {
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        show_report(report, json);
        std::string out = testing::internal::GetCapturedStdout();
        return {out, testing::internal::GetCapturedStderr()};
    }

    std::filesystem::path directory_;
    std::optional<spool::Spool> spool_;
    spool::Job job_;
};

TEST_F(PrintReportTest, shouldTellAFinishedRunOnStdoutOnly) {
    run({{LedgerKind::printed, closed(1, 5)}});
    const PrintReport finished = report(feeder::OutcomeCode::finished);
    EXPECT_EQ(finished.code, ExitCode::done);
    const auto [out, err] = shown(finished, false);
    EXPECT_EQ(out, "job 1: printed 5 of 5 records (1-5), last printed 5\n");
    EXPECT_EQ(err, "");
}

TEST_F(PrintReportTest, shouldSayHowToGoOnAfterAStop) {
    run({{LedgerKind::printed, closed(1, 2)}, {LedgerKind::unused, closed(3, 5)}});
    const PrintReport stopped = report(feeder::OutcomeCode::stop_requested);
    EXPECT_EQ(stopped.code, ExitCode::stopped);
    EXPECT_EQ(stopped.next.first(), RecordNumber{3});
    const auto [out, err] = shown(stopped, false);
    EXPECT_EQ(out, "job 1: printed 2 of 5 records (1-5), last printed 2\n"
                   "to go on: the same command again continues with record 3\n");
    EXPECT_EQ(err, "linefeed: stopped on request\n");
}

TEST_F(PrintReportTest, shouldCountOnlyTheWantedRecords) {
    run({{LedgerKind::printed, closed(1, 3)}, {LedgerKind::unused, closed(4, 5)}});
    const PrintReport part = report(feeder::OutcomeCode::stop_requested, closed(2, 4));
    EXPECT_EQ(part.printed, RecordCount{2});
    EXPECT_EQ(part.last_printed, RecordNumber{3});
    EXPECT_EQ(part.next, closed(4, 4));
}

TEST_F(PrintReportTest, shouldNameTheRecordsInDoubtAndDisarmThem) {
    run({{LedgerKind::printed, closed(1, 2)},
         {LedgerKind::in_doubt, closed(3, 3)},
         {LedgerKind::unused, closed(4, 5)}});
    const PrintReport doubtful = report(feeder::OutcomeCode::stop_requested);
    EXPECT_EQ(doubtful.code, ExitCode::in_doubt) << "whatever the outcome was";
    const auto [out, err] = shown(doubtful, false);
    EXPECT_NE(out.find("in doubt: 3  thr\\x1B[2Jee\n"), std::string::npos) << out;
    EXPECT_EQ(out.find('\x1b'), std::string::npos);
    EXPECT_EQ(err, "linefeed: stopped on request\n");
}

TEST_F(PrintReportTest, shouldAskForTheLastProductWhereItTells) {
    run({{LedgerKind::printed, closed(1, 2)}, {LedgerKind::in_doubt, closed(3, 5)}});
    const PrintReport doubtful = report(feeder::OutcomeCode::records_in_doubt);
    EXPECT_NE(shown(doubtful, false).first.find("start again with --last-printed NUMBER"), std::string::npos);
    EXPECT_TRUE(nlohmann::json::parse(shown(doubtful, true).first)["in_doubt_hole"].is_null());
}

TEST_F(PrintReportTest, shouldAskForEveryProductWhereTheLastDoesNotTell) {
    run({{LedgerKind::printed, closed(1, 2)}, {LedgerKind::in_doubt, closed(3, 5)}}, R"({"restarted":true})");
    const PrintReport doubtful = report(feeder::OutcomeCode::records_in_doubt);
    const auto [out, err] = shown(doubtful, false);
    EXPECT_NE(out.find("stopped and started again"), std::string::npos) << out;
    EXPECT_NE(out.find("start again with --printed N-M,N"), std::string::npos) << out;
    EXPECT_EQ(out.find("--last-printed"), std::string::npos) << out;
    EXPECT_EQ(nlohmann::json::parse(shown(doubtful, true).first)["in_doubt_hole"], doubtful.doubt_hole);
}

TEST_F(PrintReportTest, shouldNotPromiseARecordWhoseFateIsOpen) {
    run({{LedgerKind::printed, closed(1, 2)}});
    const auto [out, err] = shown(report(feeder::OutcomeCode::link_lost), false);
    EXPECT_NE(out.find("asks the printer how far the 3 records were printed"), std::string::npos) << out;
    EXPECT_EQ(out.find("continues with record"), std::string::npos) << out;
}

TEST_F(PrintReportTest, shouldGiveProgramsTheSameFacts) {
    run({{LedgerKind::printed, closed(1, 2)},
         {LedgerKind::in_doubt, closed(3, 3)},
         {LedgerKind::unused, closed(4, 5)}});
    const auto [out, err] = shown(report(feeder::OutcomeCode::link_lost, closed(1, 5), "reset by peer"), true);
    const auto json = nlohmann::json::parse(out);
    EXPECT_EQ(json["result"], "link_lost");
    EXPECT_EQ(json["message"], "the connection to the printer was lost: reset by peer");
    EXPECT_EQ(json["exit_code"], 6);
    EXPECT_EQ(json["file"], "/data/names.csv");
    EXPECT_EQ(json["records"], (nlohmann::json{{"first", 1}, {"last", 5}}));
    EXPECT_EQ(json["printed"], 2);
    EXPECT_EQ(json["last_printed"], 2);
    EXPECT_EQ(json["in_doubt"], 1);
    EXPECT_EQ(json["in_doubt_records"], nlohmann::json::parse(R"([{"number":3,"fields":["thr\u001b[2Jee"]}])"));
    EXPECT_EQ(err, "linefeed: the connection to the printer was lost: reset by peer\n");
}

TEST_F(PrintReportTest, shouldSayNullWhereThereIsNothing) {
    const auto [out, err] = shown(report(feeder::OutcomeCode::unreachable, closed(1, 5)), true);
    const auto json = nlohmann::json::parse(out);
    EXPECT_TRUE(json["last_printed"].is_null());
    EXPECT_EQ(json["next"], 1);
    EXPECT_EQ(json["exit_code"], 3);
}

TEST(ShowBadRows, shouldNameEveryRowAndSayWhatToDo) {
    intake::ImportReport rows{
        10, 8, 2, 0, {}, {}, {{3, "name", "character 2 is U+0009 (TAB)"}, {7, "", "4 fields instead of 3"}}};
    testing::internal::CaptureStderr();
    show_bad_rows(rows, "names.csv", true, nullptr, false);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "linefeed: names.csv: line 3, column name: character 2 is U+0009 (TAB)\n"
              "linefeed: names.csv: line 7: 4 fields instead of 3\n"
              "linefeed: nothing is imported: 2 of 10 rows cannot be printed; mend them, or leave them out with "
              "--skip-bad\n");
}

TEST(ShowBadRows, shouldCountWhatItDoesNotName) {
    intake::ImportReport rows{10, 5, 5, 0, {}, {}, {{3, "name", "bad"}}};
    testing::internal::CaptureStderr();
    show_bad_rows(rows, "names.csv", false, nullptr, false);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "linefeed: names.csv: line 3, column name: bad\n"
                                                      "linefeed: names.csv: and 4 more bad rows\n"
                                                      "linefeed: left out 5 bad rows of 10 (--skip-bad)\n");
}

TEST(ShowFailure, shouldBeOneLineWhateverItHolds) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    show_failure({FailureKind::input, "a\nb"}, true);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "linefeed: a\\x0Ab\n");
    const auto json = nlohmann::json::parse(testing::internal::GetCapturedStdout());
    EXPECT_EQ(json, (nlohmann::json{{"result", "input"}, {"message", "a\nb"}, {"exit_code", 5}}));
}

} // namespace
} // namespace linefeed::cli
