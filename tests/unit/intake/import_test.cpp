#include "intake/import.hpp"
#include "intake_fixture.hpp"

#include <nlohmann/json.hpp>

namespace linefeed::intake {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Rows from a list; can break off.
class ListSource final : public RowSource {
public:
    explicit ListSource(std::vector<std::vector<std::string>> rows, std::vector<std::string> names = {"name"})
        : rows_(std::move(rows))
        , names_(std::move(names)) {}

    Result<bool> next(Row& row) override {
        row = {};
        if (at_ == breaks_off_at) {
            return Failure{FailureKind::input, "the disk cannot read it"};
        }
        if (at_ == rows_.size()) {
            return false;
        }
        row.line = at_ + 1;
        row.fields.assign(rows_[at_].begin(), rows_[at_].end());
        ++at_;
        return true;
    }
    const std::vector<std::string>& column_names() const override { return names_; }
    double progress() const override { return static_cast<double>(at_) / static_cast<double>(rows_.size()); }

    std::optional<std::size_t> breaks_off_at;

private:
    std::vector<std::vector<std::string>> rows_;
    std::vector<std::string> names_;
    std::size_t at_ = 0;
};

class ImportTest : public IntakeTest {
protected:
    void SetUp() override {
        IntakeTest::SetUp();
        spool.emplace(spool::Spool::open(directory / "spool.db", {}).value());
    }
    Result<ImportOutcome> import(RowSource& source, std::uint32_t base = 0) {
        return import_source(source, *spool, {{}, "{}", RecordNumber{base}}, options);
    }
    Result<ImportOutcome> import_rows(std::vector<std::vector<std::string>> rows, std::uint32_t base = 0) {
        ListSource source{std::move(rows)};
        return import(source, base);
    }
    std::string frame(const spool::Job& job, std::uint32_t number) {
        const RecordNumber wanted{number};
        return std::string{spool->read_page(job.id, wanted).value().slice(RecordRange::closed(wanted, wanted))};
    }
    bool nothing_stored() { return spool->jobs().value().empty(); }

    std::optional<spool::Spool> spool;
    ImportOptions options;
};

TEST_F(ImportTest, shouldNumberAndEncodeEveryRow) {
    const auto outcome = import_rows({{"Müller"}, {"Schulz"}}, 22117);
    ASSERT_TRUE(outcome.has_value());
    ASSERT_TRUE(outcome->job.has_value());
    EXPECT_EQ(outcome->report.rows, 2U);
    EXPECT_EQ(outcome->report.records, 2U);
    EXPECT_EQ(outcome->report.bad_rows, 0U);
    EXPECT_EQ(outcome->job->records, RecordRange::closed(RecordNumber{22118}, RecordNumber{22119}));
    EXPECT_EQ(frame(*outcome->job, 22118), "^0=MR22118\tM\xFCller\r");
    EXPECT_EQ(frame(*outcome->job, 22119), "^0=MR22119\tSchulz\r");
}

TEST_F(ImportTest, shouldImportAFile) {
    const auto file = write("name;zip\n\"Meier; Söhne\";01067\nx;1\n");
    auto source = open_source(file, {});
    const auto outcome = import_source(**source, *spool, {fingerprint(file).value(), "{}", {}}, options);
    ASSERT_TRUE(outcome.has_value() && outcome->job.has_value());
    EXPECT_EQ(frame(*outcome->job, 1), "^0=MR1\tMeier; S\xF6hne\t01067\r");
    EXPECT_TRUE(spool->find_by_source({fingerprint(file).value(), "{}", {}}).value().has_value());
}

TEST_F(ImportTest, shouldFillPagesByRecordsAndByBytes) {
    std::vector<std::vector<std::string>> rows(1030, {"x"});
    rows.resize(1400, {std::string(1000, 'y')});
    const auto job = *import_rows(rows).value().job;
    EXPECT_EQ(spool->read_page(job.id, RecordNumber{1}).value().range(),
              RecordRange::closed(RecordNumber{1}, RecordNumber{512}));
    const RecordPage full = spool->read_page(job.id, RecordNumber{1100}).value();
    EXPECT_GE(full.frames.size(), 64U * 1024);
    EXPECT_LT(full.frames.size(), 66U * 1024);
    for (const std::uint32_t number : {512U, 513U, 1024U, 1025U, 1400U}) {
        EXPECT_THAT(frame(job, number), HasSubstr("=MR" + std::to_string(number) + "\t"));
    }
    EXPECT_FALSE(spool->read_page(job.id, RecordNumber{1401}).has_value());
}

TEST_F(ImportTest, shouldRefuseAllRowsIfOneIsBadAndReportEachOfThem) {
    options.charsets = {protocol::Charset::latin1, protocol::Charset::latin1};
    ListSource source{{{"a", "b"}, {"a", "b\tc"}, {"ok", "ok"}, {"\xFF", "d"}}, {"first", "second"}};
    const auto outcome = import(source);
    ASSERT_TRUE(outcome.has_value());
    EXPECT_FALSE(outcome->job.has_value());
    EXPECT_EQ(outcome->report.rows, 4U);
    EXPECT_EQ(outcome->report.records, 0U);
    EXPECT_EQ(outcome->report.bad_rows, 2U);
    ASSERT_EQ(outcome->report.reported.size(), 2U);
    EXPECT_EQ(outcome->report.reported[0].line, 2U);
    EXPECT_EQ(outcome->report.reported[0].column, "second");
    EXPECT_THAT(outcome->report.reported[0].reason, HasSubstr("TAB"));
    EXPECT_EQ(outcome->report.reported[1].line, 4U);
    EXPECT_EQ(outcome->report.reported[1].column, "first");
    EXPECT_TRUE(nothing_stored());
}

TEST_F(ImportTest, shouldReportWhatTheSourceSaysAboutItsRows) {
    const auto file = write("a,b\n1,2,3\n4,5\n");
    auto source = open_source(file, {});
    const auto outcome = import_source(**source, *spool, {{}, "{}", {}}, options);
    ASSERT_TRUE(outcome.has_value());
    EXPECT_FALSE(outcome->job.has_value());
    EXPECT_THAT(outcome->report.reported, ElementsAre(BadRow{2, "", "3 fields instead of 2"}));
}

TEST_F(ImportTest, shouldLeaveBadRowsOutIfAskedForAndNumberTheRestWithoutGaps) {
    options.skip_bad = true;
    const auto outcome = import_rows({{"a"}, {"\x01"}, {"b"}});
    ASSERT_TRUE(outcome.has_value() && outcome->job.has_value());
    EXPECT_EQ(outcome->report.rows, 3U);
    EXPECT_EQ(outcome->report.records, 2U);
    EXPECT_EQ(outcome->report.bad_rows, 1U);
    EXPECT_EQ(frame(*outcome->job, 1), "^0=MR1\ta\r");
    EXPECT_EQ(frame(*outcome->job, 2), "^0=MR2\tb\r");
    const auto kept = nlohmann::json::parse(spool->job(outcome->job->id).value()->import_report);
    EXPECT_EQ(kept["rows"], 3);
    EXPECT_EQ(kept["records"], 2);
    EXPECT_EQ(kept["reported"][0]["line"], 2);
    EXPECT_EQ(kept["reported"][0]["column"], "name");
}

TEST_F(ImportTest, shouldStoreNothingIfEveryRowIsBad) {
    options.skip_bad = true;
    const auto outcome = import_rows({{"\x01"}, {"\x02"}});
    ASSERT_TRUE(outcome.has_value());
    EXPECT_FALSE(outcome->job.has_value());
    EXPECT_EQ(outcome->report.bad_rows, 2U);
    EXPECT_TRUE(nothing_stored());
}

TEST_F(ImportTest, shouldNameALimitedNumberOfBadRowsAndCountAll) {
    const auto outcome = import_rows(std::vector<std::vector<std::string>>(250, {"\x01"}));
    EXPECT_EQ(outcome->report.bad_rows, 250U);
    EXPECT_EQ(outcome->report.reported.size(), max_reported_rows);
}

TEST_F(ImportTest, shouldFailIfTheSourceBreaksOff) {
    ListSource source{std::vector<std::vector<std::string>>(2000, {"x"})};
    source.breaks_off_at = 1500;
    const auto outcome = import(source);
    ASSERT_FALSE(outcome.has_value());
    EXPECT_EQ(outcome.error(), (Failure{FailureKind::input, "the disk cannot read it"}));
    EXPECT_TRUE(nothing_stored());
}

TEST_F(ImportTest, shouldFailIfThereAreNoRows) {
    const auto outcome = import_rows({});
    ASSERT_FALSE(outcome.has_value());
    EXPECT_EQ(outcome.error(), (Failure{FailureKind::input, "the source has no rows"}));
    EXPECT_TRUE(nothing_stored());
}

TEST_F(ImportTest, shouldUseTheLastNumberAndFailBehindIt) {
    const std::uint32_t max = RecordNumber::max().value();
    const auto fits = import_rows({{"a"}, {"b"}}, max - 2);
    ASSERT_TRUE(fits.has_value());
    EXPECT_EQ(fits->job->records.last(), RecordNumber::max());
    const auto too_many = import_rows({{"a"}, {"b"}, {"c"}}, max - 2);
    ASSERT_FALSE(too_many.has_value());
    EXPECT_EQ(too_many.error().kind, FailureKind::input);
    EXPECT_THAT(too_many.error().message, HasSubstr("row 3 has no number any more"));
    EXPECT_FALSE(import_rows({{"a"}}, max).has_value());
}

TEST_F(ImportTest, shouldUseACharsetForEachColumn) {
    options.charsets = {protocol::Charset::windows_1252, protocol::Charset::unicode_hex};
    ListSource source{{{"5 €", "€"}}, {"price", "sign"}};
    EXPECT_EQ(frame(*import(source).value().job, 1), "^0=MR1\t5 \x80\t20AC\r");
}

TEST_F(ImportTest, shouldRefuseAnotherNumberOfCharsets) {
    for (const std::size_t count : {0U, 2U, 4U}) {
        options.charsets.assign(count, protocol::Charset::latin1);
        ListSource source{{{"a", "b", "c"}}, {"1", "2", "3"}};
        const auto outcome = import(source);
        ASSERT_FALSE(outcome.has_value());
        EXPECT_EQ(outcome.error().kind, FailureKind::usage);
    }
    EXPECT_TRUE(nothing_stored());
}

TEST_F(ImportTest, shouldShowProgressAndStopIfAskedTo) {
    std::vector<std::uint64_t> seen;
    options.on_progress = [&](const ImportReport& report, double progress) {
        seen.push_back(report.rows);
        EXPECT_NEAR(progress, static_cast<double>(report.rows) / 10'000, 1e-9);
        return report.rows < 8000;
    };
    const auto outcome = import_rows(std::vector<std::vector<std::string>>(10'000, {"x"}));
    ASSERT_FALSE(outcome.has_value());
    EXPECT_EQ(outcome.error(), (Failure{FailureKind::stopped, "the import was cancelled"}));
    EXPECT_THAT(seen, ElementsAre(4096, 8192));
    EXPECT_TRUE(nothing_stored());
}

TEST_F(ImportTest, shouldRefuseAFileThatGrewWhileItWasRead) {
    const auto file = write("name\na\nb\n");
    const spool::JobSpec spec{fingerprint(file).value(), "{}", {}};
    auto source = open_source(file, {});
    std::ofstream{file, std::ios::app} << "c\n"; // half written when it was found
    const auto outcome = import_source(**source, *spool, spec, options);
    ASSERT_FALSE(outcome.has_value());
    EXPECT_EQ(outcome.error().kind, FailureKind::input);
    EXPECT_THAT(outcome.error().message, HasSubstr("was changed while it was read"));
    EXPECT_TRUE(nothing_stored());
}

TEST_F(ImportTest, shouldTakeAFileThatWasRemovedAfterItWasRead) {
    const auto file = write("name\na\nb\n");
    const spool::JobSpec spec{fingerprint(file).value(), "{}", {}};
    auto source = open_source(file, {});
    std::filesystem::remove(file);
    EXPECT_TRUE(import_source(**source, *spool, spec, options).value().job.has_value());
}

TEST(ImportReportJson, shouldBeValidWhateverTheRowsHold) {
    ImportReport report;
    report.rows = 7;
    report.records = 5;
    report.bad_rows = 2;
    report.reported = {{3, "na\"me", "bad \xFF byte"}, {4, "", "the line is empty"}};
    const auto json = nlohmann::json::parse(to_json(report));
    EXPECT_EQ(json["rows"], 7);
    EXPECT_EQ(json["records"], 5);
    EXPECT_EQ(json["bad_rows"], 2);
    EXPECT_EQ(json["reported"][0]["column"], "na\"me");
    EXPECT_EQ(json["reported"][0]["reason"], "bad \xEF\xBF\xBD byte");
    EXPECT_EQ(json["reported"][1]["line"], 4);
}

} // namespace
} // namespace linefeed::intake
