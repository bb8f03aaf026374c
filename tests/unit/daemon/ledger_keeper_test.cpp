// What the feeder says, as rows of a real spool: which records are granted, and that issued = printed + in doubt +
// unused + open.
#include "daemon/ledger_keeper.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

namespace linefeed::daemon {
namespace {

using spool::LedgerKind;
using spool::RecordState;

constexpr std::uint64_t records_of_job = 2000;

RecordRange closed(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

feeder::Settle verdict(RecordRange printed, RecordRange in_doubt, RecordRange unused) {
    feeder::Settle settle;
    settle.verdict = {printed, in_doubt, unused, feeder::Basis::mail_status};
    return settle;
}

feeder::Outcome ended(feeder::OutcomeCode code) {
    feeder::Outcome outcome;
    outcome.code = code;
    return outcome;
}

class LedgerKeeperTest : public testing::Test {
protected:
    LedgerKeeperTest()
        : directory_(std::filesystem::temp_directory_path() / ("linefeed-keeper-" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(directory_);
        spool_.emplace(spool::Spool::open(directory_ / "spool.db", {[this] { return ++clock_; }, {}}).value());
        spool::JobSpec spec;
        spec.source.path = "/data/names.csv";
        auto import = spool_->begin_import(spec).value();
        RecordPage page{RecordNumber{1}, {}, {}};
        for (std::uint64_t k = 1; k <= records_of_job; ++k) {
            page.frames += "^0=MR" + std::to_string(k) + "\tx\r";
            page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
        }
        EXPECT_TRUE(import.add(page));
        job_ = import.commit({}).value().id;
    }
    ~LedgerKeeperTest() override {
        spool_.reset();
        std::filesystem::remove_all(directory_);
    }
    LedgerKeeperTest(const LedgerKeeperTest&) = delete;
    LedgerKeeperTest& operator=(const LedgerKeeperTest&) = delete;

    /// As the next start of the program would make it.
    LedgerKeeper keeper(RecordRange wanted = closed(1, records_of_job)) {
        return LedgerKeeper{*spool_, job_, wanted, "tcp://10.0.0.5:3000", find_open_issue(*spool_, job_).value()};
    }
    static feeder::BeginRun begin() {
        feeder::BeginRun begin;
        begin.printer.total_prints = 5000;
        begin.printer.version.emplace();
        begin.printer.version->serial_number = "104711";
        begin.last_printed_before = RecordNumber{77};
        return begin;
    }
    std::vector<RecordRange> in_state(RecordState state) { return spool_->ledger_state(job_).value().ranges(state); }
    std::vector<LedgerKind> kinds() {
        std::vector<LedgerKind> kinds;
        for (const spool::LedgerRow& row : spool_->ledger_rows(job_, 0, 1000).value()) {
            kinds.push_back(row.entry.kind);
        }
        return kinds;
    }

    using Ranges = std::vector<RecordRange>;
    std::filesystem::path directory_;
    std::int64_t clock_ = 0;
    std::optional<spool::Spool> spool_;
    spool::JobId job_{};
};

TEST_F(LedgerKeeperTest, shouldGrantAllOfAFreshJobWithItsFirstIntents) {
    LedgerKeeper ledger = keeper();
    const auto grant = ledger.grant(begin());
    ASSERT_TRUE(grant);
    EXPECT_EQ(grant->range, closed(1, 2000));
    EXPECT_EQ(grant->durable_through, RecordNumber{512});
    EXPECT_FALSE(grant->in_doubt);
    EXPECT_EQ(in_state(RecordState::open), Ranges{closed(1, 512)});
    EXPECT_EQ(kinds(), (std::vector{LedgerKind::run_started, LedgerKind::intent}));
}

TEST_F(LedgerKeeperTest, shouldNotIntendMoreThanWasAskedFor) {
    LedgerKeeper ledger = keeper(closed(100, 120));
    const auto grant = ledger.grant(begin());
    ASSERT_TRUE(grant);
    EXPECT_EQ(grant->range, closed(100, 120));
    EXPECT_EQ(grant->durable_through, RecordNumber{120});
}

TEST_F(LedgerKeeperTest, shouldWriteOnlyWhatIsNew) {
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    EXPECT_FALSE(ledger.has_pending());
    ledger.intent(RecordNumber{600});
    ledger.intent(RecordNumber{700});
    ledger.intent(RecordNumber{650});
    ledger.printed(RecordNumber{10}, {});
    ledger.printed(RecordNumber{20}, {});
    ledger.printed(RecordNumber{15}, {});
    EXPECT_TRUE(ledger.has_pending());
    ASSERT_TRUE(ledger.commit());
    EXPECT_FALSE(ledger.has_pending());
    ASSERT_TRUE(ledger.commit());
    EXPECT_EQ(ledger.intent_through(), RecordNumber{700});
    EXPECT_EQ(in_state(RecordState::open), Ranges{closed(21, 700)});
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 20)});
    EXPECT_EQ(kinds(),
              (std::vector{LedgerKind::run_started, LedgerKind::intent, LedgerKind::intent, LedgerKind::printed}));
}

TEST_F(LedgerKeeperTest, shouldWriteAnIntentBeforeItsConfirmation) {
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    ledger.printed(RecordNumber{512}, {});
    ledger.intent(RecordNumber{600});
    ASSERT_TRUE(ledger.commit());
    ledger.printed(RecordNumber{600}, {});
    ledger.intent(RecordNumber{800});
    ASSERT_TRUE(ledger.commit());
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 600)});
}

TEST_F(LedgerKeeperTest, shouldCallUnusedWhatIsNeitherPrintedNorInDoubt) {
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    ledger.printed(RecordNumber{100}, {});
    // The records behind 356 were intended, but never sent: the feeder does not name them.
    ASSERT_TRUE(ledger.settle(verdict(closed(101, 120), closed(121, 121), closed(122, 356))));
    ASSERT_TRUE(ledger.finish(ended(feeder::OutcomeCode::stop_requested)));
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 120)});
    EXPECT_EQ(in_state(RecordState::in_doubt), Ranges{closed(121, 121)});
    EXPECT_EQ(in_state(RecordState::unused), Ranges{closed(122, 512)});
    EXPECT_TRUE(in_state(RecordState::open).empty());
    EXPECT_EQ(kinds().back(), LedgerKind::run_ended);
}

TEST_F(LedgerKeeperTest, shouldContinueBehindTheLastPrintedRecord) {
    {
        LedgerKeeper ledger = keeper();
        ASSERT_TRUE(ledger.grant(begin()));
        ASSERT_TRUE(ledger.settle(verdict(closed(1, 120), {}, closed(121, 256))));
    }
    LedgerKeeper ledger = keeper();
    const auto grant = ledger.grant(begin());
    ASSERT_TRUE(grant);
    EXPECT_EQ(grant->range, closed(121, 2000));
}

TEST_F(LedgerKeeperTest, shouldGrantNothingWhenAllIsPrinted) {
    {
        LedgerKeeper ledger = keeper(closed(1, 100));
        ASSERT_TRUE(ledger.grant(begin()));
        ASSERT_TRUE(ledger.settle(verdict(closed(1, 100), {}, {})));
    }
    LedgerKeeper ledger = keeper(closed(1, 100));
    const auto grant = ledger.grant(begin());
    ASSERT_TRUE(grant);
    EXPECT_TRUE(grant->range.empty());
    EXPECT_FALSE(grant->in_doubt);
    ASSERT_TRUE(ledger.finish(ended(feeder::OutcomeCode::nothing_to_print)));
    EXPECT_NE(kinds().back(), LedgerKind::run_ended) << "there was no second run";
}

TEST_F(LedgerKeeperTest, shouldGrantNothingWhileRecordsAreInDoubt) {
    {
        LedgerKeeper ledger = keeper();
        ASSERT_TRUE(ledger.grant(begin()));
        ASSERT_TRUE(ledger.settle(verdict(closed(1, 9), closed(10, 10), {})));
    }
    LedgerKeeper ledger = keeper(closed(1000, 2000));
    const auto grant = ledger.grant(begin());
    ASSERT_TRUE(grant);
    EXPECT_TRUE(grant->in_doubt);
    EXPECT_TRUE(grant->range.empty());
}

TEST_F(LedgerKeeperTest, shouldFindNothingOpenInAFreshJob) {
    const auto open = find_open_issue(*spool_, job_);
    ASSERT_TRUE(open);
    EXPECT_FALSE(open->has_value());
}

TEST_F(LedgerKeeperTest, shouldFindWhatACrashLeftOpen) {
    {
        LedgerKeeper ledger = keeper(closed(100, 1999));
        ASSERT_TRUE(ledger.grant(begin()));
        ledger.printed(RecordNumber{130}, {});
        ASSERT_TRUE(ledger.commit());
    }
    const auto found = find_open_issue(*spool_, job_).value();
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->job, job_);
    EXPECT_EQ(found->records, closed(131, 611));
    EXPECT_EQ(found->printer, "tcp://10.0.0.5:3000");
    EXPECT_EQ(found->facts, (feeder::OpenRun{RecordNumber{100}, RecordNumber{130}, RecordNumber{611}, "104711", 5000,
                                             RecordNumber{77}, RecordNumber{1999}}));
}

TEST_F(LedgerKeeperTest, shouldSettleACrashedRunBeforeTheNext) {
    {
        LedgerKeeper ledger = keeper();
        ASSERT_TRUE(ledger.grant(begin()));
        ledger.printed(RecordNumber{130}, {});
        ASSERT_TRUE(ledger.commit());
    }
    LedgerKeeper ledger = keeper();
    feeder::Settle settle = verdict(closed(131, 200), {}, closed(201, 512));
    settle.earlier_run = true;
    ASSERT_TRUE(ledger.settle_earlier(settle));
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 200)});
    const auto grant = ledger.grant(begin());
    ASSERT_TRUE(grant);
    EXPECT_EQ(grant->range, closed(201, 2000));
    EXPECT_TRUE(spool_->verify_ledger());
}

TEST_F(LedgerKeeperTest, shouldWriteNothingWhenAnEarlierRunHadNothingOpen) {
    {
        LedgerKeeper ledger = keeper(closed(1, 10));
        ASSERT_TRUE(ledger.grant(begin()));
        ASSERT_TRUE(ledger.settle(verdict(closed(1, 10), {}, {})));
        const auto rows = kinds().size();
        ASSERT_TRUE(ledger.settle(verdict({}, {}, {})));
        EXPECT_EQ(kinds().size(), rows);
    }
}

} // namespace
} // namespace linefeed::daemon
