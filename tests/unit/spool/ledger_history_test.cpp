#include "spool/ledger_history.hpp"
#include "spool_fixture.hpp"

namespace linefeed::spool {
namespace {

class LedgerHistoryTest : public testing::Test {
protected:
    void add(LedgerKind kind, RecordRange records, std::int64_t time_ns, RunId run = RunId{1}) {
        LedgerRow row;
        row.entry = {kind, run, records, std::string{to_string(kind)} + '@' + std::to_string(time_ns)};
        row.time_ns = time_ns;
        history.add(row);
    }
    LedgerHistory history;
};

TEST_F(LedgerHistoryTest, shouldKnowNothingOfRecordsThatWereNeverIssued) {
    EXPECT_TRUE(history.stretches().empty());
    add(LedgerKind::run_started, range(1, 100), 10);
    EXPECT_TRUE(history.stretches().empty()) << "a run that begins issues nothing";
}

TEST_F(LedgerHistoryTest, shouldPlaceAPrintBetweenTwoReports) {
    add(LedgerKind::run_started, range(1, 100), 10);
    add(LedgerKind::intent, range(1, 20), 11);
    add(LedgerKind::printed, range(1, 5), 20);
    add(LedgerKind::intent, range(21, 40), 25);
    add(LedgerKind::printed, range(6, 9), 30);
    EXPECT_EQ(history.stretches(),
              (std::vector<HistoryStretch>{
                  {range(1, 5), RecordState::printed, RunId{1}, 10, 20, "printed@20"},
                  {range(6, 9), RecordState::printed, RunId{1}, 20, 30, "printed@30"}, // an intent is no report
                  {range(10, 20), RecordState::open, RunId{1}, 10, 11, "intent@11"},
                  {range(21, 40), RecordState::open, RunId{1}, 20, 25, "intent@25"}}));
}

/// Nobody learns from the operator's word when it was: not before the last report, and not after the doubt.
TEST_F(LedgerHistoryTest, shouldPlaceAPrintThatWasInDoubtBeforeTheDoubt) {
    add(LedgerKind::run_started, range(1, 100), 10);
    add(LedgerKind::intent, range(1, 20), 11);
    add(LedgerKind::printed, range(1, 5), 20);
    add(LedgerKind::in_doubt, range(6, 8), 40);
    add(LedgerKind::run_ended, {}, 41);
    add(LedgerKind::printed, range(6, 7), 90);
    add(LedgerKind::unused, range(8, 9), 91);
    EXPECT_EQ(history.stretches(),
              (std::vector<HistoryStretch>{{range(1, 5), RecordState::printed, RunId{1}, 10, 20, "printed@20"},
                                           {range(6, 7), RecordState::printed, RunId{1}, 20, 40, "printed@90"},
                                           {range(8, 8), RecordState::unused, RunId{1}, 20, 40, "unused@91"},
                                           {range(9, 9), RecordState::unused, RunId{1}, 90, 91, "unused@91"},
                                           {range(10, 20), RecordState::open, RunId{1}, 10, 11, "intent@11"}}));
}

TEST_F(LedgerHistoryTest, shouldGiveEveryKindItsState) {
    add(LedgerKind::intent, range(1, 9), 1);
    add(LedgerKind::printed, range(1, 1), 2);
    add(LedgerKind::unused, range(2, 2), 2);
    add(LedgerKind::in_doubt, range(3, 5), 2);
    add(LedgerKind::skipped, range(4, 4), 2);
    add(LedgerKind::released, range(5, 5), 2);
    add(LedgerKind::printed, range(6, 6), 2);
    add(LedgerKind::reprint, range(6, 6), 2);
    add(LedgerKind::run_ended, {}, 3);
    std::vector<RecordState> states;
    for (const HistoryStretch& stretch : history.stretches()) {
        states.push_back(stretch.state);
    }
    EXPECT_EQ(states,
              (std::vector{RecordState::printed, RecordState::unused, RecordState::in_doubt, RecordState::skipped,
                           RecordState::released, RecordState::released, RecordState::open}));
}

TEST_F(LedgerHistoryTest, shouldCutWhatALaterRowCovers) {
    add(LedgerKind::intent, range(10, 19), 1);
    add(LedgerKind::intent, range(20, 29), 2);
    add(LedgerKind::intent, range(30, 39), 3);
    add(LedgerKind::unused, range(15, 34), 4); // the end of one, all of the next, the beginning of the third
    add(LedgerKind::unused, range(12, 13), 5); // out of the middle
    std::vector<RecordRange> ranges;
    for (const HistoryStretch& stretch : history.stretches()) {
        ranges.push_back(stretch.range);
    }
    EXPECT_EQ(ranges, (std::vector{range(10, 11), range(12, 13), range(14, 14), range(15, 34), range(35, 39)}));
    EXPECT_EQ(history.stretches()[2].evidence, "intent@1");
}

TEST_F(LedgerHistoryTest, shouldIgnoreRowsWithoutRecords) {
    add(LedgerKind::intent, range(1, 5), 1);
    add(LedgerKind::printed, {}, 2);
    EXPECT_EQ(history.stretches().size(), 1U);
    add(LedgerKind::printed, range(1, 5), 3);
    EXPECT_EQ(history.stretches().front().from_ns, 2);
}

TEST_F(LedgerHistoryTest, shouldKeepTheReportsOfRunsApart) {
    add(LedgerKind::run_started, range(1, 10), 1, RunId{1});
    add(LedgerKind::intent, range(1, 10), 2, RunId{1});
    add(LedgerKind::run_started, range(1, 10), 5, RunId{5});
    add(LedgerKind::printed, range(1, 10), 9, RunId{1});
    EXPECT_EQ(history.stretches().front().from_ns, 1);
}

} // namespace
} // namespace linefeed::spool
