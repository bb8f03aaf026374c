#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SpoolLedgerTest : public SpoolTest {
protected:
    void SetUp() override {
        SpoolTest::SetUp();
        spool.emplace(open());
        job = make_job(*spool, 100);
    }
    RunId begin_run() { return spool->begin_run(job.id, job.records, R"({"printer":"4711"})").value(); }
    void reopen() {
        spool.reset();
        spool.emplace(open());
    }
    std::optional<Spool> spool;
    Job job;
};

TEST_F(SpoolLedgerTest, shouldStartEmpty) {
    EXPECT_EQ(spool->ledger_state(job.id).value(), LedgerState{});
    EXPECT_TRUE(spool->ledger_rows(job.id, 0, 10).value().empty());
    EXPECT_EQ(spool->last_run(job.id).value().has_value(), false);
    EXPECT_EQ(spool->verify_ledger().value(), 0);
}

TEST_F(SpoolLedgerTest, shouldKeepRowsInOrderWithTimeAndEvidence) {
    now_ns = 5;
    const RunId run = begin_run();
    now_ns = 9;
    ASSERT_TRUE(
        append(*spool, job.id,
               {{LedgerKind::intent, run, range(1, 20), ""}, {LedgerKind::printed, run, range(1, 3), R"({"sm":3})"}}));
    reopen();
    const auto rows = spool->ledger_rows(job.id, 0, 10).value();
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].entry, (LedgerEntry{LedgerKind::run_started, run, job.records, R"({"printer":"4711"})"}));
    EXPECT_EQ(rows[1].entry, (LedgerEntry{LedgerKind::intent, run, range(1, 20), ""}));
    EXPECT_EQ(rows[2].entry, (LedgerEntry{LedgerKind::printed, run, range(1, 3), R"({"sm":3})"}));
    EXPECT_EQ(rows[0].time_ns, 5);
    EXPECT_EQ(rows[2].time_ns, 9);
    std::string previous(64, '0');
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].sequence, static_cast<std::int64_t>(i + 1));
        EXPECT_EQ(rows[i].job, job.id);
        EXPECT_EQ(rows[i].previous_hash, previous);
        EXPECT_EQ(rows[i].hash, ledger_hash(previous, rows[i].sequence, job.id, rows[i].entry, rows[i].time_ns));
        previous = rows[i].hash;
    }
}

TEST_F(SpoolLedgerTest, shouldFindTheDoubtOfARunBehindItsBeginning) {
    const auto append_doubt = [this](RunId run, std::uint32_t from, std::uint32_t to) {
        ASSERT_TRUE(append(*spool, job.id,
                           {{LedgerKind::intent, run, range(from, to), ""},
                            {LedgerKind::printed, run, range(from, from), ""},
                            {LedgerKind::in_doubt, run, range(from + 1, to), R"({"sm":3})"}}));
    };
    EXPECT_EQ(spool->last_ledger_row(job.id).value(), 0);
    const RunId first = begin_run();
    append_doubt(first, 1, 10);
    const RunId second = spool->begin_run(job.id, range(11, 100), "{}").value();
    append_doubt(second, 11, 20);
    const auto rows = spool->doubt_rows(job.id, second).value();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].entry.kind, LedgerKind::run_started);
    EXPECT_EQ(rows[0].entry.run, second);
    EXPECT_EQ(rows[1].entry, (LedgerEntry{LedgerKind::in_doubt, second, range(12, 20), R"({"sm":3})"}));
    EXPECT_EQ(spool->last_ledger_row(job.id).value(), rows[1].sequence);
    EXPECT_EQ(spool->last_ledger_row(make_job(*spool, 5).id).value(), 0) << "of that job only";
}

TEST_F(SpoolLedgerTest, shouldReadRowsInPortions) {
    const RunId run = begin_run();
    for (std::uint32_t number = 1; number <= 5; ++number) {
        ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(number, number), ""}}));
    }
    const auto portion = spool->ledger_rows(job.id, 2, 3).value();
    ASSERT_EQ(portion.size(), 3U);
    EXPECT_EQ(portion.front().sequence, 3);
    EXPECT_EQ(portion.back().sequence, 5);
    EXPECT_EQ(spool->ledger_rows(job.id, 5, 3).value().size(), 1U);
    EXPECT_EQ(spool->ledger_rows(job.id, 0, std::numeric_limits<std::size_t>::max()).value().size(), 6U);
}

TEST_F(SpoolLedgerTest, shouldKnowTheSameStateAfterReopening) {
    const RunId run = begin_run();
    ASSERT_TRUE(append(*spool, job.id,
                       {{LedgerKind::intent, run, range(1, 50), ""},
                        {LedgerKind::printed, run, range(1, 20), ""},
                        {LedgerKind::in_doubt, run, range(21, 21), ""}}));
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::unused, run, range(22, 50), ""}}));
    const LedgerState before = spool->ledger_state(job.id).value();
    EXPECT_THAT(before.segments(), ElementsAre(LedgerSegment{range(1, 20), RecordState::printed, run},
                                               LedgerSegment{range(21, 21), RecordState::in_doubt, run},
                                               LedgerSegment{range(22, 50), RecordState::unused, run}));
    reopen();
    EXPECT_EQ(spool->ledger_state(job.id).value(), before);
    EXPECT_EQ(spool->verify_ledger().value(), 5);
    EXPECT_EQ(before.count(RecordState::printed) + before.count(RecordState::in_doubt) +
                  before.count(RecordState::unused),
              RecordCount{50});
}

TEST_F(SpoolLedgerTest, shouldStoreSegmentsForEveryKindOfChange) {
    // Each row changes the list of segments in another place; what is stored must follow.
    const RunId run = begin_run();
    const RunId next_run = begin_run();
    const std::initializer_list<LedgerEntry> rows{
        {LedgerKind::intent, run, range(10, 30), ""},       {LedgerKind::in_doubt, run, range(15, 20), ""},
        {LedgerKind::printed, run, range(10, 12), ""},      {LedgerKind::released, run, range(16, 17), ""},
        {LedgerKind::skipped, run, range(18, 18), ""},      {LedgerKind::printed, next_run, range(15, 15), ""},
        {LedgerKind::intent, next_run, range(1, 9), ""},    {LedgerKind::intent, next_run, range(16, 17), ""},
        {LedgerKind::unused, next_run, range(1, 9), ""},    {LedgerKind::unused, run, range(13, 14), ""},
        {LedgerKind::intent, next_run, range(1, 9), ""},    {LedgerKind::printed, next_run, range(1, 9), ""},
        {LedgerKind::printed, next_run, range(19, 30), ""}, {LedgerKind::run_ended, next_run, {}, ""}};
    for (const LedgerEntry& row : rows) {
        ASSERT_TRUE(spool->append(job.id, {&row, 1})) << to_string(row.kind) << ' ' << row.range;
        ASSERT_TRUE(spool->verify_ledger().has_value()) << to_string(row.kind) << ' ' << row.range;
    }
}

TEST_F(SpoolLedgerTest, shouldWriteNothingIfOneRowContradicts) {
    const RunId run = begin_run();
    const auto refused = append(
        *spool, job.id, {{LedgerKind::intent, run, range(1, 9), ""}, {LedgerKind::printed, run, range(9, 10), ""}});
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().kind, FailureKind::internal);
    EXPECT_THAT(refused.error().message, HasSubstr("refuses \"printed 9-10\" of job 1, run 1"));
    EXPECT_EQ(spool->ledger_state(job.id).value(), LedgerState{});
    EXPECT_EQ(spool->ledger_rows(job.id, 0, 10).value().size(), 1U);
    EXPECT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 9), ""}})); // and it goes on
}

TEST_F(SpoolLedgerTest, shouldAppendToSeveralJobsAtOnce) {
    const Job other = make_job(*spool, 50);
    const RunId run = begin_run();
    const RunId other_run = spool->begin_run(other.id, other.records, "").value();
    const std::vector<JobRows> rows{{job.id, {{LedgerKind::intent, run, range(1, 20), ""}}},
                                    {other.id, {{LedgerKind::intent, other_run, range(1, 30), ""}}}};
    ASSERT_TRUE(spool->append_together(rows));
    EXPECT_EQ(spool->ledger_state(job.id).value().ranges(RecordState::open), std::vector{range(1, 20)});
    reopen();
    EXPECT_EQ(spool->ledger_state(other.id).value().ranges(RecordState::open), std::vector{range(1, 30)});
    EXPECT_EQ(spool->verify_ledger().value(), 4);
}

/// More than are kept in memory.
TEST_F(SpoolLedgerTest, shouldAppendToVeryManyJobsAtOnce) {
    std::vector<JobRows> rows;
    for (int jobs = 0; jobs < 100; ++jobs) {
        const Job one = make_job(*spool, 10);
        rows.push_back(
            {one.id, {{LedgerKind::intent, spool->begin_run(one.id, one.records, "").value(), range(1, 4), ""}}});
    }
    ASSERT_TRUE(spool->append_together(rows));
    for (const JobRows& each : rows) {
        EXPECT_EQ(spool->ledger_state(each.job).value().ranges(RecordState::open), std::vector{range(1, 4)});
    }
    EXPECT_EQ(spool->verify_ledger().value(), 200);
}

TEST_F(SpoolLedgerTest, shouldWriteNothingForAnyJobIfARowOfOneContradicts) {
    const Job other = make_job(*spool, 50);
    const RunId run = begin_run();
    const RunId other_run = spool->begin_run(other.id, other.records, "").value();
    const LedgerEntry good{LedgerKind::intent, run, range(1, 20), ""};
    for (const LedgerEntry& bad : {LedgerEntry{LedgerKind::printed, other_run, range(1, 30), ""},
                                   LedgerEntry{LedgerKind::run_started, other_run, range(1, 50), ""}}) {
        const auto done = spool->append_together(std::vector<JobRows>{{job.id, {good}}, {other.id, {bad}}});
        ASSERT_FALSE(done);
        EXPECT_EQ(done.error().kind, FailureKind::internal);
        EXPECT_TRUE(spool->ledger_state(job.id).value().ranges(RecordState::open).empty());
    }
    EXPECT_EQ(spool->verify_ledger().value(), 2);
    EXPECT_TRUE(append(*spool, job.id, {good})) << "the spool goes on";
}

TEST_F(SpoolLedgerTest, shouldRefuseRecordsThatTheJobDoesNotHave) {
    const RunId run = begin_run();
    for (const RecordRange records : {range(0, 1), range(100, 101), range(200, 201)}) {
        EXPECT_FALSE(append(*spool, job.id, {{LedgerKind::intent, run, records, ""}}).has_value());
    }
    EXPECT_FALSE(spool->begin_run(job.id, range(1, 101), "").has_value());
    EXPECT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 100), ""}}).has_value());
}

TEST_F(SpoolLedgerTest, shouldRefuseRowsOfAnUnknownRun) {
    const Job other = make_job(*spool, 10);
    const RunId run = begin_run();
    for (const RunId wrong : {RunId{0}, RunId{2}, RunId{-1}}) {
        EXPECT_FALSE(append(*spool, job.id, {{LedgerKind::intent, wrong, range(1, 1), ""}}).has_value());
    }
    EXPECT_FALSE(append(*spool, other.id, {{LedgerKind::intent, run, range(1, 1), ""}}).has_value());
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 1), ""}}));
    EXPECT_FALSE(
        append(*spool, job.id, {{LedgerKind::printed, RunId{2}, range(1, 1), ""}}).has_value()); // row 2 is an intent
}

TEST_F(SpoolLedgerTest, shouldOnlyStartRunsThroughBeginRun) {
    const auto refused = append(*spool, job.id, {{LedgerKind::run_started, RunId{1}, range(1, 1), ""}});
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().kind, FailureKind::internal);
}

TEST_F(SpoolLedgerTest, shouldRefuseAJobThatIsNotReady) {
    auto import = spool->begin_import(spec());
    EXPECT_FALSE(spool->begin_run(import->id(), range(1, 1), "").has_value());
    EXPECT_FALSE(spool->ledger_state(JobId{99}).has_value());
    EXPECT_TRUE(spool->append(job.id, {}).has_value()); // nothing to do
}

TEST_F(SpoolLedgerTest, shouldKeepTheChainOverSeveralJobs) {
    const Job other = make_job(*spool, 10);
    const RunId a = begin_run();
    const RunId b = spool->begin_run(other.id, other.records, "").value();
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::intent, a, range(1, 1), ""}}));
    ASSERT_TRUE(append(*spool, other.id, {{LedgerKind::intent, b, range(1, 2), ""}}));
    EXPECT_EQ(spool->ledger_state(job.id).value().count(RecordState::open), RecordCount{1});
    EXPECT_EQ(spool->ledger_state(other.id).value().count(RecordState::open), RecordCount{2});
    EXPECT_EQ(spool->verify_ledger().value(), 4);
    const auto rows = spool->ledger_rows(other.id, 0, 10).value();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[1].previous_hash, spool->ledger_rows(job.id, 0, 10).value()[1].hash);
}

TEST_F(SpoolLedgerTest, shouldKnowTheNewestRunAndWhetherItEnded) {
    const RunId first = begin_run();
    EXPECT_EQ(spool->last_run(job.id).value()->started.entry.run, first);
    EXPECT_FALSE(spool->last_run(job.id).value()->ended);
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::run_ended, first, {}, R"({"why":"stop"})"}}));
    EXPECT_EQ(spool->last_run(job.id).value()->ended->entry.evidence, R"({"why":"stop"})");
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::run_ended, first, {}, R"({"why":"again"})"}}));
    EXPECT_EQ(spool->last_run(job.id).value()->ended->entry.evidence, R"({"why":"again"})") << "the newest";
    const RunId second = begin_run();
    EXPECT_EQ(spool->last_run(job.id).value()->started.entry.run, second);
    EXPECT_FALSE(spool->last_run(job.id).value()->ended);
    // What is written later about the first run does not end the second.
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::run_ended, first, {}, ""}}));
    EXPECT_FALSE(spool->last_run(job.id).value()->ended);
}

TEST_F(SpoolLedgerTest, shouldListTheJobsWithOpenRecords) {
    const Job other = make_job(*spool, 10);
    const RunId run = begin_run();
    const RunId other_run = spool->begin_run(other.id, other.records, "").value();
    EXPECT_TRUE(spool->jobs_with_open_records().value().empty()) << "a run that begins issues nothing";
    ASSERT_TRUE(append(*spool, other.id, {{LedgerKind::intent, other_run, range(1, 5), ""}}));
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 5), ""}}));
    EXPECT_EQ(spool->jobs_with_open_records().value(), (std::vector{job.id, other.id}));
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::unused, run, range(1, 5), ""}}));
    EXPECT_EQ(spool->jobs_with_open_records().value(), std::vector{other.id});
}

TEST_F(SpoolLedgerTest, shouldManageMoreJobsThanItKeepsInMemory) {
    std::vector<std::pair<JobId, RunId>> runs;
    for (int i = 0; i < 150; ++i) {
        const Job other = make_job(*spool, 2);
        runs.emplace_back(other.id, spool->begin_run(other.id, other.records, "").value());
    }
    for (const auto& [id, run] : runs) {
        ASSERT_TRUE(append(*spool, id, {{LedgerKind::intent, run, range(1, 2), ""}}));
    }
    for (const auto& [id, run] : runs) {
        ASSERT_TRUE(append(*spool, id, {{LedgerKind::printed, run, range(1, 2), ""}}));
    }
    EXPECT_EQ(spool->verify_ledger().value(), 450);
}

TEST_F(SpoolLedgerTest, shouldLetNobodyChangeRows) {
    begin_run();
    EXPECT_THAT(sql("UPDATE ledger SET evidence = 'x'"), HasSubstr("append-only"));
    EXPECT_THAT(sql("DELETE FROM ledger"), HasSubstr("append-only"));
    EXPECT_THAT(sql("INSERT OR REPLACE INTO ledger SELECT * FROM ledger"), HasSubstr("append-only"));
    EXPECT_THAT(sql("INSERT INTO ledger SELECT 7, job, kind, run, first, records, evidence, time_ns, hash FROM ledger"),
                HasSubstr("append-only"));
    EXPECT_EQ(spool->verify_ledger().value(), 1);
}

} // namespace
} // namespace linefeed::spool
