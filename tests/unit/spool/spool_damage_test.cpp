// A ledger that somebody changed behind the spool's back: what cannot be read is said to be damaged, and nothing is
// made of it.
#include "spool/ledger_codec.hpp"
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;

class DamagedSpool : public SpoolTest {
protected:
    void SetUp() override {
        SpoolTest::SetUp();
        Spool spool = open();
        job = make_job(spool).id;
        run = spool.begin_run(job, range(1, 100), "{}").value();
        ASSERT_TRUE(append(spool, job, {{LedgerKind::intent, run, range(1, 30), "{}"}}));
        ASSERT_TRUE(append(spool, job, {{LedgerKind::printed, run, range(1, 20), "{}"}}));
        ASSERT_EQ(sql("DROP TRIGGER ledger_rows_stay; DROP TRIGGER ledger_rows_do_not_change"), "");
    }
    /// Past the rules of the tables.
    std::string damage(const std::string& text) const { return sql("PRAGMA ignore_check_constraints = 1;" + text); }

    JobId job{};
    RunId run{};
};

TEST_F(DamagedSpool, shouldNotReadSegmentsThatAreNone) {
    for (const char* change : {"UPDATE ledger_segments SET records = 0 WHERE first = 21",
                               "UPDATE ledger_segments SET records = -1 WHERE first = 21",
                               "UPDATE ledger_segments SET records = 25 WHERE first = 1",
                               "UPDATE ledger_segments SET records = 10, state = 'lost' WHERE first = 21"}) {
        Spool spool = open();
        ASSERT_EQ(damage(change), "") << change;
        const auto state = spool.ledger_state(job);
        ASSERT_FALSE(state.has_value()) << change;
        EXPECT_EQ(state.error().kind, FailureKind::storage);
        EXPECT_THAT(state.error().message, HasSubstr("the ledger state of job 1 cannot be read"));
        EXPECT_FALSE(append(spool, job, {{LedgerKind::intent, run, range(31, 31), ""}})) << change;
        ASSERT_EQ(damage("UPDATE ledger_segments SET records = 20, state = 'printed' WHERE first = 1;"
                         "UPDATE ledger_segments SET records = 10, state = 'open' WHERE first = 21"),
                  "");
    }
    EXPECT_TRUE(open().ledger_state(job));
}

TEST_F(DamagedSpool, shouldNotReadRowsThatAreNone) {
    Spool spool = open();
    ASSERT_EQ(damage("UPDATE ledger SET kind = 'maybe' WHERE sequence = 2"), "");
    EXPECT_THAT(spool.ledger_rows(job, 0, 10).error().message, HasSubstr("ledger row 2 is damaged"));
    EXPECT_TRUE(spool.last_run(job));
    ASSERT_EQ(damage("UPDATE ledger SET first = -1 WHERE sequence = 1"), "");
    EXPECT_THAT(spool.last_run(job).error().message, HasSubstr("ledger row 1 is damaged"));
}

TEST_F(DamagedSpool, shouldMissTheLastRowAlsoWhenAnotherStandsInItsPlace) {
    Spool spool = open();
    // Row 3 says something else, and its hash is right.
    const std::string previous = sql("SELECT lower(hex(hash)) FROM ledger WHERE sequence = 2");
    const std::string hash = ledger_hash(previous, 3, job, {LedgerKind::printed, run, range(1, 19), "{}"}, now_ns);
    ASSERT_EQ(damage("UPDATE ledger SET records = 19, hash = x'" + hash + "' WHERE sequence = 3"), "");
    EXPECT_THAT(spool.verify_ledger().error().message, HasSubstr("it was there when the spool was opened"));
}

} // namespace
} // namespace linefeed::spool
