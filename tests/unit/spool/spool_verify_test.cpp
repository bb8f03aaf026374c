#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;

struct Tampering {
    const char* sql;
    const char* verdict;
};

std::ostream& operator<<(std::ostream& out, const Tampering& tampering) {
    return out << tampering.sql;
}

class TamperedLedger : public SpoolTest, public testing::WithParamInterface<Tampering> {
protected:
    void write_ledger() {
        Spool spool = open();
        const Job job = make_job(spool, 100);
        const RunId run = spool.begin_run(job.id, job.records, "{}").value();
        ASSERT_TRUE(append(spool, job.id, {{LedgerKind::intent, run, range(1, 30), "{}"}}));
        ASSERT_TRUE(append(spool, job.id, {{LedgerKind::printed, run, range(1, 20), "{}"}}));
        ASSERT_TRUE(append(spool, job.id, {{LedgerKind::run_ended, run, {}, "{}"}}));
    }
};

TEST_P(TamperedLedger, shouldBeFound) {
    write_ledger();
    const std::string free_hand = "DROP TRIGGER ledger_rows_stay; DROP TRIGGER ledger_rows_do_not_change;"
                                  "DROP TRIGGER ledger_rows_follow_each_other; PRAGMA ignore_check_constraints = 1;";
    ASSERT_THAT(sql(free_hand + GetParam().sql), testing::Not(HasSubstr("error")));
    Spool spool = open();
    const auto verified = spool.verify_ledger();
    ASSERT_FALSE(verified.has_value());
    EXPECT_EQ(verified.error().kind, FailureKind::storage);
    EXPECT_THAT(verified.error().message, HasSubstr(GetParam().verdict));
}

INSTANTIATE_TEST_SUITE_P(
    Spool, TamperedLedger,
    testing::Values(Tampering{"UPDATE ledger SET records = 19 WHERE sequence = 3", "ledger row 3 was changed"},
                    Tampering{"UPDATE ledger SET first = 2 WHERE sequence = 2", "ledger row 2 was changed"},
                    Tampering{"UPDATE ledger SET kind = 'unused' WHERE sequence = 3", "ledger row 3 was changed"},
                    Tampering{"UPDATE ledger SET evidence = '{ }' WHERE sequence = 1", "ledger row 1 was changed"},
                    Tampering{"UPDATE ledger SET time_ns = 0 WHERE sequence = 4", "ledger row 4 was changed"},
                    Tampering{"UPDATE ledger SET hash = randomblob(32) WHERE sequence = 2", "ledger row 2 was changed"},
                    Tampering{"UPDATE ledger SET kind = 'maybe' WHERE sequence = 2", "ledger row 2 is damaged"},
                    Tampering{"UPDATE ledger SET first = -1 WHERE sequence = 2", "ledger row 2 is damaged"},
                    Tampering{"DELETE FROM ledger WHERE sequence = 2", "ledger row 2 is missing"},
                    Tampering{"DELETE FROM ledger WHERE sequence > 2", "the stored state of job 1 was changed"},
                    Tampering{"UPDATE ledger_segments SET state = 'unused' WHERE first = 21",
                              "the stored state of job 1 was changed"},
                    Tampering{"DELETE FROM ledger_segments", "the stored state of job 1 was changed"},
                    Tampering{"INSERT INTO ledger_segments VALUES (2, 1, 1, 'printed', 1)",
                              "the stored state of job 2 was changed"},
                    Tampering{"UPDATE ledger_segments SET records = 25 WHERE first = 1",
                              "the ledger state of job 1 cannot be read"}));

class ForgedLedger : public TamperedLedger {
protected:
    /// Appends a row whose hash is right, past all checks of append().
    void forge(const LedgerEntry& entry, JobId job) const {
        const std::string previous = sql("SELECT lower(hex(hash)) FROM ledger ORDER BY sequence DESC LIMIT 1");
        const std::string hash = ledger_hash(previous, 5, job, entry, 9);
        const std::string done =
            sql("INSERT INTO ledger VALUES (5, " + std::to_string(static_cast<std::int64_t>(job)) + ", '" +
                std::string{to_string(entry.kind)} + "', " + std::to_string(static_cast<std::int64_t>(entry.run)) +
                ", " + std::to_string(entry.range.first().value()) + ", " +
                std::to_string(entry.range.count().value()) + ", '" + entry.evidence + "', 9, x'" + hash + "')");
        ASSERT_EQ(done, "");
    }
    std::string verdict() {
        Spool spool = open();
        const auto verified = spool.verify_ledger();
        return verified ? "" : verified.error().message;
    }
};

TEST_F(ForgedLedger, shouldBeRightIfTheRowIs) {
    write_ledger();
    forge({LedgerKind::run_ended, RunId{1}, {}, ""}, JobId{1});
    EXPECT_EQ(verdict(), "");
}

TEST_F(ForgedLedger, shouldNotContradictItself) {
    write_ledger();
    forge({LedgerKind::intent, RunId{1}, range(5, 6), ""}, JobId{1});
    EXPECT_THAT(verdict(), HasSubstr("ledger row 5 contradicts the rows before it"));
}

TEST_F(ForgedLedger, shouldNotNameARunThatIsNone) {
    write_ledger();
    forge({LedgerKind::intent, RunId{2}, range(40, 41), ""}, JobId{1});
    EXPECT_THAT(verdict(), HasSubstr("the job has no such run"));
}

TEST_F(ForgedLedger, shouldNotNameTheRunOfAnotherJob) {
    write_ledger();
    {
        Spool spool = open();
        make_job(spool);
    }
    forge({LedgerKind::run_ended, RunId{1}, {}, ""}, JobId{2});
    EXPECT_THAT(verdict(), HasSubstr("the job has no such run"));
}

TEST_F(ForgedLedger, shouldNotStartTheRunOfAnotherRow) {
    write_ledger();
    forge({LedgerKind::run_started, RunId{1}, {}, ""}, JobId{1});
    EXPECT_THAT(verdict(), HasSubstr("it starts another row's run"));
}

TEST_F(ForgedLedger, shouldMissRowsThatDisappearWhileTheSpoolIsOpen) {
    write_ledger();
    Spool spool = open();
    ASSERT_EQ(spool.verify_ledger().value(), 4);
    sql("DROP TRIGGER ledger_rows_stay; DELETE FROM ledger WHERE sequence = 4");
    EXPECT_THAT(spool.verify_ledger().error().message, HasSubstr("ledger row 4 is missing"));
}

} // namespace
} // namespace linefeed::spool
