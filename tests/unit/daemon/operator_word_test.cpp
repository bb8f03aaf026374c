// What an operator's word about records in doubt becomes in the ledger, and which words the evidence does not bear.
#include "daemon/operator_word.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace linefeed::daemon {
namespace {

using spool::LedgerEntry;
using spool::LedgerKind;
using spool::LedgerSegment;
using spool::RecordState;

RecordRange closed(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

/// What a run_started and an in_doubt row say: only what the test is about.
struct Words {
    std::optional<std::uint32_t> total_before = 1000;
    std::optional<std::uint32_t> total;
    std::uint32_t last_printed = 0;
    bool finished = true;
    bool restarted = false;
    std::string serial_number = "104711";
    std::string serial_number_later = "104711";
};

std::string start_json(const Words& words) {
    std::string json = R"({"printer":"tcp://10.0.0.1:3000","serial_number":")" + words.serial_number + '"';
    if (words.total_before) {
        json += R"(,"total_before":)" + std::to_string(*words.total_before);
    }
    return json + R"(,"last_printed_before":0})";
}

std::string settle_json(const Words& words) {
    std::string json = R"({"basis":"no evidence","sm":[256,0,)" + std::to_string(words.last_printed) + ",0," +
                       (words.finished ? "1]" : "0]");
    if (words.total) {
        json += R"(,"total":)" + std::to_string(*words.total);
    }
    if (words.restarted) {
        json += R"(,"restarted":true)";
    }
    return json + R"(,"serial_number":")" + words.serial_number_later + "\"}";
}

/// A job of 100 records named "name 1" … "name 99" and, as the last, "17"; run from record 1 unless a test says more.
class OperatorWordTest : public testing::Test {
protected:
    void SetUp() override {
        std::string name = std::filesystem::temp_directory_path() / "linefeed-word-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        directory_ = name;
        spool_.emplace(spool::Spool::open(directory_ / "spool.db", {[] { return std::int64_t{1}; }, {}}).value());
        auto import = spool_->begin_import({}).value();
        RecordPage page{RecordNumber{1}, {}, {}};
        for (std::uint32_t number = 1; number <= 100; ++number) {
            const std::string text = number == 100  ? "17"
                                     : number == 98 ? "twin"
                                     : number == 99 ? "twin"
                                                    : "name " + std::to_string(number);
            page.frames += "^0=MR" + std::to_string(number) + "\t" + text + "\r";
            page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
        }
        ASSERT_TRUE(import.add(page));
        job_ = import.commit({}).value();
    }
    void TearDown() override {
        spool_.reset();
        std::filesystem::remove_all(directory_);
    }

    /// A run over `issued` of which `in_doubt` is in doubt, what lies before it printed, and behind it unused.
    void run(RecordRange issued, RecordRange in_doubt, const Words& words) {
        const spool::RunId run = spool_->begin_run(job_.id, issued, start_json(words)).value();
        std::vector<LedgerEntry> rows{{LedgerKind::intent, run, issued, {}}};
        if (issued.first() < in_doubt.first()) {
            rows.push_back(
                {LedgerKind::printed, run, RecordRange::closed(issued.first(), in_doubt.first().previous()), {}});
        }
        rows.push_back({LedgerKind::in_doubt, run, in_doubt, settle_json(words)});
        if (in_doubt.last() < issued.last()) {
            rows.push_back({LedgerKind::unused, run, RecordRange::closed(in_doubt.last().next(), issued.last()), {}});
        }
        rows.push_back({LedgerKind::run_ended, run, {}, {}});
        ASSERT_TRUE(spool_->append(job_.id, rows));
    }
    /// The everyday case: a printer that lost its memory behind record 19 or 20 of 1…100, by the counter.
    void sound_doubt() { run(closed(1, 100), closed(11, 20), {.total = 1019}); }
    /// 1…10 are known to be printed, the printer reports 60, and has counted 14 prints: 46 are on no product.
    void doubt_with_hole() { run(closed(1, 100), closed(11, 90), {.total = 1014, .last_printed = 60}); }

    [[nodiscard]] Result<void> say(const OperatorWord& word) { return settle_by_operator(*spool_, job_, word, "anna"); }
    [[nodiscard]] Result<void> last_printed(const std::string& said) { return say({.last_printed = said}); }
    [[nodiscard]] Result<void> printed(const std::string& said) { return say({.printed = said}); }

    /// Nothing is written, and the text holds all of `parts`.
    void expect_refused(const Result<void>& result, std::initializer_list<std::string> parts) {
        ASSERT_FALSE(result.has_value());
        EXPECT_EQ(result.error().kind, FailureKind::usage);
        for (const std::string& part : parts) {
            EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
        }
        EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
        EXPECT_GT(state().count(RecordState::in_doubt), RecordCount{0});
    }
    [[nodiscard]] spool::LedgerState state() { return spool_->ledger_state(job_.id).value(); }
    [[nodiscard]] std::vector<RecordRange> ranges(RecordState kind) { return state().ranges(kind); }
    [[nodiscard]] std::vector<spool::LedgerRow> rows() { return spool_->ledger_rows(job_.id, 0, 1000).value(); }
    [[nodiscard]] std::string hole() { return doubt_evidence(*spool_, job_).value().hole; }

    std::filesystem::path directory_;
    std::optional<spool::Spool> spool_;
    spool::Job job_;
};

// The last product

TEST_F(OperatorWordTest, shouldTakeTheNumberOfTheLastProduct) {
    sound_doubt();
    ASSERT_TRUE(last_printed("15"));
    EXPECT_EQ(ranges(RecordState::printed), std::vector{closed(1, 15)});
    EXPECT_EQ(ranges(RecordState::unused), std::vector{closed(16, 100)});
    EXPECT_EQ(ranges(RecordState::in_doubt), std::vector<RecordRange>{});
}

TEST_F(OperatorWordTest, shouldTakeTheTextOfTheLastProduct) {
    sound_doubt();
    ASSERT_TRUE(last_printed("name 20"));
    EXPECT_EQ(ranges(RecordState::printed), std::vector{closed(1, 20)});
}

TEST_F(OperatorWordTest, shouldTakeTheRecordBeforeTheFirstInDoubtForNone) {
    sound_doubt();
    ASSERT_TRUE(last_printed("10"));
    EXPECT_EQ(ranges(RecordState::printed), std::vector{closed(1, 10)});
    EXPECT_EQ(ranges(RecordState::unused), std::vector{closed(11, 100)});
}

TEST_F(OperatorWordTest, shouldTakeNumberZeroWhenNothingOfTheJobIsPrinted) {
    run(closed(1, 100), closed(1, 20), {.total = 1019});
    ASSERT_TRUE(last_printed("0"));
    EXPECT_EQ(ranges(RecordState::unused), std::vector{closed(1, 100)});
}

TEST_F(OperatorWordTest, shouldRefuseALastProductThatIsNotInDoubt) {
    sound_doubt();
    for (const char* said : {"9", "21", "0", "name 9", "nobody", "15 "}) {
        expect_refused(last_printed(said), {said, "10 to 20"});
    }
}

TEST_F(OperatorWordTest, shouldRefuseATextOfSeveralRecords) {
    run(closed(1, 100), closed(90, 99), {.total = 1100});
    expect_refused(last_printed("twin"), {"several records", "say the number"});
}

TEST_F(OperatorWordTest, shouldRefuseANumberThatIsTheTextOfAnotherRecord) {
    run(closed(1, 100), closed(11, 100), {.total = 1100});
    expect_refused(last_printed("17"), {"the number of record 17", "the text of record 100"});
}

// Where the last product tells too little

TEST_F(OperatorWordTest, shouldRefuseTheLastProductWhenTheCounterShowsAHole) {
    doubt_with_hole();
    expect_refused(last_printed("60"),
                   {"record 60 as the last", "counted only 14 prints since record 1", "11-90", "--printed"});
    // A product from before the hole is not the last one either.
    expect_refused(last_printed("14"), {"--printed"});
    expect_refused(last_printed("10"), {"--printed"});
}

TEST_F(OperatorWordTest, shouldCountFromTheStartOfTheRun) {
    run(closed(1, 50), closed(50, 50), {.total = 1050, .last_printed = 50, .finished = false});
    ASSERT_TRUE(last_printed("50"));
    run(closed(51, 100), closed(61, 90), {.total = 1010, .last_printed = 61});
    EXPECT_NE(hole().find("counted only 10 prints since record 51"), std::string::npos) << hole();
}

TEST_F(OperatorWordTest, shouldRefuseTheLastProductWhenThePrinterWasRestarted) {
    run(closed(1, 100), closed(11, 90), {.total = 1060, .last_printed = 60, .restarted = true});
    expect_refused(last_printed("60"), {"stopped and started again", "11-90", "--printed"});
}

TEST_F(OperatorWordTest, shouldRefuseALastProductFurtherThanTheCounterCame) {
    // No number to compare: the printer has lost its memory. It has counted 14 prints, and one more may have begun.
    run(closed(1, 100), closed(11, 90), {.total = 1014});
    EXPECT_EQ(hole(), "");
    expect_refused(last_printed("16"), {"counter", "no further than record 15", "--printed"});
    ASSERT_TRUE(last_printed("15"));
    EXPECT_EQ(ranges(RecordState::printed), std::vector{closed(1, 15)});
}

TEST_F(OperatorWordTest, shouldAllowForAPrintThatIsNotCountedYet) {
    run(closed(1, 100), closed(15, 15), {.total = 1014, .last_printed = 15, .finished = false});
    ASSERT_TRUE(last_printed("15"));
    EXPECT_EQ(ranges(RecordState::printed), std::vector{closed(1, 15)});
}

TEST_F(OperatorWordTest, shouldCountOverTheEndOfTheCounter) {
    run(closed(1, 100), closed(11, 90), {.total_before = 4294967290, .total = 8, .last_printed = 60});
    EXPECT_NE(hole().find("counted only 14 prints"), std::string::npos) << hole();
}

TEST_F(OperatorWordTest, shouldBelieveTheLastProductWhenNoCounterTells) {
    for (const Words& words :
         {Words{.total = std::nullopt, .last_printed = 60},
          Words{.total_before = std::nullopt, .total = 1014, .last_printed = 60},
          Words{.total = 1000, .last_printed = 60},                               // a counter that does not move
          Words{.total = 1014, .last_printed = 60, .serial_number_later = "999"}, // another printer's
          Words{.total = 2000, .last_printed = 60}}) {                            // something else was printed besides
        TearDown();
        SetUp();
        run(closed(1, 100), closed(11, 90), words);
        EXPECT_EQ(hole(), "");
        ASSERT_TRUE(last_printed("60"));
        EXPECT_EQ(ranges(RecordState::printed), std::vector{closed(1, 60)});
    }
}

TEST_F(OperatorWordTest, shouldReadDamagedEvidenceAsNone) {
    for (const char* evidence : {"", "{}", "[]", "{\"sm\":7,\"total\":\"x\",\"serial_number\":1,\"restarted\":0}",
                                 "{\"sm\":[1,2,\"3\",4,5]}", "{\"sm\":[1,2]}", "\xFF{"}) {
        TearDown();
        SetUp();
        const spool::RunId run = spool_->begin_run(job_.id, job_.records, evidence).value();
        const std::vector<LedgerEntry> entries{{LedgerKind::intent, run, closed(1, 20), {}},
                                               {LedgerKind::in_doubt, run, closed(1, 20), evidence}};
        ASSERT_TRUE(spool_->append(job_.id, entries));
        EXPECT_EQ(hole(), "") << evidence;
    }
}

TEST_F(OperatorWordTest, shouldRefuseOneProductForSeveralStretches) {
    // No run of linefeed leaves this behind; a ledger may hold it all the same.
    const spool::RunId run = spool_->begin_run(job_.id, job_.records, start_json({})).value();
    const std::vector<LedgerEntry> entries{{LedgerKind::intent, run, closed(1, 30), {}},
                                           {LedgerKind::in_doubt, run, closed(1, 5), "{}"},
                                           {LedgerKind::printed, run, closed(6, 19), "{}"},
                                           {LedgerKind::in_doubt, run, closed(20, 30), "{}"}};
    ASSERT_TRUE(spool_->append(job_.id, entries));
    expect_refused(last_printed("25"), {"several stretches", "1-5, 20-30", "--printed"});
    ASSERT_TRUE(printed("2-3,20-30"));
    EXPECT_EQ(ranges(RecordState::printed), (std::vector{closed(2, 3), closed(6, 30)}));
    EXPECT_EQ(ranges(RecordState::unused), (std::vector{closed(1, 1), closed(4, 5)}));
}

// The products by name

TEST_F(OperatorWordTest, shouldTakeExactlyTheNamedRecordsForPrinted) {
    doubt_with_hole();
    ASSERT_TRUE(printed("60, 11-13"));
    EXPECT_EQ(ranges(RecordState::printed), (std::vector{closed(1, 13), closed(60, 60)}));
    EXPECT_EQ(ranges(RecordState::unused), (std::vector{closed(14, 59), closed(61, 100)}));
    EXPECT_EQ(state().next_printable(job_.records), closed(14, 59)) << "the hole comes first";
}

TEST_F(OperatorWordTest, shouldTakeNoneAndAll) {
    doubt_with_hole();
    ASSERT_TRUE(printed("none"));
    EXPECT_EQ(ranges(RecordState::unused), std::vector{closed(11, 100)});
    TearDown();
    SetUp();
    doubt_with_hole();
    ASSERT_TRUE(printed("11-90"));
    EXPECT_EQ(ranges(RecordState::printed), std::vector{closed(1, 90)});
}

TEST_F(OperatorWordTest, shouldTakeNamedRecordsWhereTheLastProductWouldDo) {
    sound_doubt();
    ASSERT_TRUE(printed("11-15"));
    EXPECT_EQ(ranges(RecordState::printed), std::vector{closed(1, 15)});
}

TEST_F(OperatorWordTest, shouldRefuseNamedRecordsThatAreNotInDoubt) {
    doubt_with_hole();
    for (const char* said : {"10", "10-12", "91", "90-91", "1-100", "11-12,95"}) {
        expect_refused(printed(said), {"only these records are in doubt: 11-90"});
    }
}

TEST_F(OperatorWordTest, shouldRefuseNamesThatAreNoneOrDoubled) {
    doubt_with_hole();
    expect_refused(printed("11-20,15"), {"--printed: record 15 is named twice"});
    expect_refused(printed("name 11"), {"--printed: \"name 11\" is neither"});
    expect_refused(printed(""), {"--printed: \"\" is neither"});
}

// The ledger's rows

TEST_F(OperatorWordTest, shouldWriteWhoSaidWhatIntoEveryRow) {
    doubt_with_hole();
    const std::size_t before = rows().size();
    ASSERT_TRUE(printed("11-13,60"));
    const auto all = rows();
    ASSERT_EQ(all.size(), before + 4);
    const LedgerKind kinds[]{LedgerKind::printed, LedgerKind::unused, LedgerKind::printed, LedgerKind::unused};
    const RecordRange places[]{closed(11, 13), closed(14, 59), closed(60, 60), closed(61, 90)};
    for (std::size_t k = 0; k < 4; ++k) {
        const LedgerEntry& entry = all[before + k].entry;
        EXPECT_EQ(entry.kind, kinds[k]);
        EXPECT_EQ(entry.range, places[k]);
        EXPECT_EQ(entry.run, all.front().entry.run);
        EXPECT_NE(entry.evidence.find(R"("operator":"anna")"), std::string::npos) << entry.evidence;
        EXPECT_NE(entry.evidence.find(R"("said":"printed: 11-13,60")"), std::string::npos) << entry.evidence;
    }
    EXPECT_TRUE(spool_->verify_ledger());
}

TEST_F(OperatorWordTest, shouldSkipOrReprintWithoutLookingAtTheEvidence) {
    doubt_with_hole();
    ASSERT_TRUE(say({.policy = InDoubtPolicy::skip}));
    EXPECT_EQ(ranges(RecordState::skipped), std::vector{closed(11, 90)});
    TearDown();
    SetUp();
    doubt_with_hole();
    ASSERT_TRUE(say({.policy = InDoubtPolicy::reprint}));
    EXPECT_EQ(ranges(RecordState::released), std::vector{closed(11, 90)});
}

TEST_F(OperatorWordTest, shouldWriteNothingWhenNothingIsInDoubt) {
    const spool::RunId run = spool_->begin_run(job_.id, job_.records, start_json({})).value();
    const std::vector<LedgerEntry> entries{{LedgerKind::intent, run, closed(1, 20), {}}};
    ASSERT_TRUE(spool_->append(job_.id, entries));
    const std::size_t before = rows().size();
    EXPECT_TRUE(last_printed("15"));
    EXPECT_TRUE(printed("15"));
    EXPECT_EQ(rows().size(), before);
}

} // namespace
} // namespace linefeed::daemon
