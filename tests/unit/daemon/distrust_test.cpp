// A spool from a backup: nothing of it is printed again before an operator has said what is printed.
#include "daemon/distrust.hpp"
#include "store/ledger_keeper.hpp"
#include "support/spool_job.hpp"

namespace linefeed::daemon {
namespace {

using spool::LedgerEntry;
using spool::LedgerKind;
using spool::RecordState;
using test::closed;
using test::SpoolJobTest;

class DistrustTest : public SpoolJobTest {
protected:
    std::vector<DistrustedJob> distrust() { return daemon::distrust(*spool_, "anna", "restored").value(); }
    spool::LedgerState state() { return spool_->ledger_state(job_).value(); }
    spool::RunId run_over(RecordRange range) {
        const spool::RunId run = spool_->begin_run(job_, range, R"({"printer":"tcp://10.0.0.5:3000"})").value();
        append({LedgerKind::intent, run, range, ""});
        return run;
    }
    void append(const LedgerEntry& entry) { ASSERT_TRUE(spool_->append(job_, {&entry, 1})); }
    RecordRange next() { return state().next_printable(closed(1, records_of_job)); }
};

TEST_F(DistrustTest, shouldPutAJobInDoubtOfWhichNothingWasPrinted) {
    const auto jobs = distrust();
    ASSERT_EQ(jobs.size(), 1U);
    EXPECT_EQ(jobs.front().job.id, job_);
    EXPECT_EQ(jobs.front().in_doubt, Ranges{closed(1, records_of_job)});
    EXPECT_TRUE(next().empty());
}

TEST_F(DistrustTest, shouldPutOpenRecordsAndWhatFollowsInDoubtAsOneStretch) {
    const spool::RunId run = run_over(closed(1, 512));
    append({LedgerKind::printed, run, closed(1, 100), ""});
    ASSERT_EQ(distrust().size(), 1U);
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 100)});
    ASSERT_EQ(state().segments().size(), 2U); // one product tells about a single stretch of one run
    EXPECT_EQ(state().segments().back().range, closed(101, records_of_job));
    EXPECT_EQ(state().segments().back().state, RecordState::in_doubt);
    EXPECT_FALSE(store::find_open_issue(*spool_, job_).value()); // no printer is asked about them
    EXPECT_TRUE(next().empty());
}

TEST_F(DistrustTest, shouldKeepWhatIsKnown) {
    const spool::RunId run = run_over(closed(1, 40));
    append({LedgerKind::printed, run, closed(1, 10), ""});
    append({LedgerKind::in_doubt, run, closed(11, 20), ""});
    append({LedgerKind::skipped, run, closed(11, 15), ""});
    append({LedgerKind::unused, run, closed(21, 40), ""});
    const auto jobs = distrust();
    ASSERT_EQ(jobs.size(), 1U);
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 10)});
    EXPECT_EQ(in_state(RecordState::skipped), Ranges{closed(11, 15)});
    EXPECT_EQ(jobs.front().in_doubt, Ranges{closed(16, records_of_job)});
    EXPECT_EQ(state().segments().at(2).run, run); // the evidence of an earlier doubt stays
}

TEST_F(DistrustTest, shouldLeaveAFinishedJobAlone) {
    const spool::RunId run = run_over(closed(1, records_of_job));
    append({LedgerKind::printed, run, closed(1, records_of_job), ""});
    const auto rows = kinds();
    EXPECT_TRUE(distrust().empty());
    EXPECT_EQ(kinds(), rows);
}

TEST_F(DistrustTest, shouldChangeNothingMoreTheSecondTime) {
    run_over(closed(1, 512));
    const auto first = distrust();
    const auto rows = kinds();
    const auto second = distrust();
    ASSERT_EQ(second.size(), 1U);
    EXPECT_EQ(second.front().in_doubt, first.front().in_doubt);
    EXPECT_EQ(kinds(), rows);
}

TEST_F(DistrustTest, shouldSayWhoseWordItIsInAChainThatIsWhole) {
    run_over(closed(1, 512));
    distrust();
    const auto rows = spool_->ledger_rows(job_, 2, 100).value();
    ASSERT_FALSE(rows.empty());
    for (const spool::LedgerRow& row : rows) {
        EXPECT_EQ(row.entry.evidence, R"({"operator":"anna","said":"restored"})");
    }
    EXPECT_EQ(spool_->verify_ledger().value(), static_cast<std::int64_t>(2 + rows.size()));
}

} // namespace
} // namespace linefeed::daemon
