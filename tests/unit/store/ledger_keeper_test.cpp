// What the feeder says, as rows of a real spool: which records are granted, and that issued = printed + in doubt +
// unused + open.
#include "store/ledger_keeper.hpp"
#include "support/spool_job.hpp"

#include <gmock/gmock.h>

namespace linefeed::store {
namespace {

using spool::LedgerKind;
using spool::RecordState;
using test::closed;
using test::SpoolJobTest;

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

class LedgerKeeperTest : public SpoolJobTest {
protected:
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
    /// As a run's end would make it.
    [[nodiscard]] bool settled(LedgerKeeper& ledger, const feeder::Settle& settle) {
        ledger.confirm(settle.confirmed_through, settle.evidence.mail);
        EXPECT_TRUE(ledger.commit());
        auto rows = ledger.verdict_rows(settle);
        return rows && append_all(*spool_, {std::move(*rows)});
    }
    /// The next start of the program finds the records 131 … 512 open.
    void crash() {
        LedgerKeeper ledger = keeper();
        ASSERT_TRUE(ledger.grant(begin()));
        ledger.printed(RecordNumber{130}, {});
        ASSERT_TRUE(ledger.commit());
    }
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
    ASSERT_TRUE(settled(ledger, verdict(closed(101, 120), closed(121, 121), closed(122, 356))));
    ASSERT_TRUE(ledger.finish(ended(feeder::OutcomeCode::stop_requested)));
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 120)});
    EXPECT_EQ(in_state(RecordState::in_doubt), Ranges{closed(121, 121)});
    EXPECT_EQ(in_state(RecordState::unused), Ranges{closed(122, 512)});
    EXPECT_TRUE(in_state(RecordState::open).empty());
    EXPECT_EQ(kinds().back(), LedgerKind::run_ended);
}

TEST_F(LedgerKeeperTest, shouldSayThatTheEndCannotBeWritten) {
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    ledger.printed(RecordNumber{100}, {});
    spool_.reset();
    auto read_only = spool::Spool::open_for_reading(directory_ / "spool.db", {}).value();
    spool_.emplace(std::move(read_only));
    EXPECT_FALSE(ledger.finish(ended(feeder::OutcomeCode::stop_requested)));
}

TEST_F(LedgerKeeperTest, shouldContinueBehindTheLastPrintedRecord) {
    {
        LedgerKeeper ledger = keeper();
        ASSERT_TRUE(ledger.grant(begin()));
        ASSERT_TRUE(settled(ledger, verdict(closed(1, 120), {}, closed(121, 256))));
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
        ASSERT_TRUE(settled(ledger, verdict(closed(1, 100), {}, {})));
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
        ASSERT_TRUE(settled(ledger, verdict(closed(1, 9), closed(10, 10), {})));
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
    ASSERT_EQ(found->jobs.size(), 1U);
    EXPECT_EQ(found->jobs.front().job, job_);
    EXPECT_EQ(found->jobs.front().records, closed(131, 611));
    EXPECT_EQ(found->printer, "tcp://10.0.0.5:3000");
    EXPECT_EQ(found->facts, (feeder::OpenRun{RecordNumber{100}, RecordNumber{130}, RecordNumber{611}, "104711", 5000,
                                             RecordNumber{77}, RecordNumber{1999}}));
}

TEST_F(LedgerKeeperTest, shouldFindAPrintThatMayBeBrokenOffInWhatARunLeftOpen) {
    const auto found = [this] { return find_open_issue(*spool_, job_).value()->facts.broken_off; };
    feeder::Outcome outcome = ended(feeder::OutcomeCode::no_answer);
    {
        LedgerKeeper ledger = keeper();
        ASSERT_TRUE(ledger.grant(begin()));
        ledger.printed(RecordNumber{130}, {});
        outcome.broken_off = RecordNumber{140};
        ASSERT_TRUE(ledger.finish(outcome));
    }
    EXPECT_EQ(found(), RecordNumber{140});
    const std::size_t rows = kinds().size();
    ASSERT_TRUE(keeper().finish(outcome));
    ASSERT_TRUE(keeper().finish(ended(feeder::OutcomeCode::unreachable)));
    EXPECT_EQ(kinds().size(), rows) << "nothing new was seen";
    outcome.broken_off = RecordNumber{145};
    ASSERT_TRUE(keeper().finish(outcome));
    EXPECT_EQ(found(), RecordNumber{145}) << "another look, and no end of it either";
    feeder::Settle settle = verdict(closed(131, 150), {}, {});
    settle.earlier_run = settle.provisional = true;
    ASSERT_TRUE(keeper().settle_earlier(settle));
    EXPECT_EQ(found(), RecordNumber{}) << "the ledger knows its fate";
    EXPECT_TRUE(spool_->verify_ledger());
}

TEST_F(LedgerKeeperTest, shouldFindThatThePrinterLeftRecordsOutInARunThatIsOpen) {
    feeder::Outcome outcome = ended(feeder::OutcomeCode::link_lost);
    for (const bool unclear : {true, false}) {
        LedgerKeeper ledger = keeper();
        ASSERT_TRUE(ledger.grant(begin()));
        outcome.unclear = unclear;
        ASSERT_TRUE(ledger.finish(outcome));
        EXPECT_EQ(find_open_issue(*spool_, job_).value()->facts.unclear, unclear);
        ASSERT_TRUE(keeper().settle_earlier(verdict({}, {}, closed(1, 512))));
    }
}

TEST_F(LedgerKeeperTest, shouldRememberOnceThatALaterLookFoundRecordsLeftOut) {
    crash();
    const std::size_t rows = kinds().size();
    feeder::Outcome outcome = ended(feeder::OutcomeCode::link_lost);
    outcome.unclear = true;
    for (int looks = 0; looks < 2; ++looks) {
        ASSERT_TRUE(keeper().finish(outcome));
        EXPECT_TRUE(find_open_issue(*spool_, job_).value()->facts.unclear);
        EXPECT_EQ(kinds().size(), rows + 1);
    }
}

TEST_F(LedgerKeeperTest, shouldHaveNothingToSayOfABrokenOffPrintWhereNothingWasIssued) {
    feeder::Outcome outcome = ended(feeder::OutcomeCode::no_answer);
    outcome.broken_off = RecordNumber{77};
    const std::size_t rows = kinds().size();
    ASSERT_TRUE(keeper().finish(outcome));
    EXPECT_EQ(kinds().size(), rows);
}

TEST_F(LedgerKeeperTest, shouldFindTheEndOfACrashedRunWhenTheImportHasReachedIt) {
    RecordPage page{RecordNumber{1}, {}, {}};
    for (std::uint32_t number = 1; number <= 300; ++number) {
        page.frames += "^0=MR" + std::to_string(number) + "\tx\r";
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
    }
    auto import = spool_->begin_import({}).value();
    job_ = import.id();
    import.add(page).value();
    import.flush().value();
    LedgerKeeper ledger = keeper(closed(1, 5000)); // nobody knows how many come
    ledger.imported(RecordNumber{300});
    EXPECT_EQ(ledger.grant(begin())->range, closed(1, 5000));
    EXPECT_EQ(in_state(RecordState::open), Ranges{closed(1, 300)});
    EXPECT_EQ(find_open_issue(*spool_, job_).value()->jobs.front().run_range, closed(1, 5000)) << "the import goes on";
    import.commit({}).value();
    const auto found = find_open_issue(*spool_, job_).value();
    EXPECT_EQ(found->jobs.front().run_range, closed(1, 300));
    EXPECT_EQ(found->facts.last, RecordNumber{300});
}

TEST_F(LedgerKeeperTest, shouldSettleACrashedRunBeforeTheNext) {
    crash();
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
        ASSERT_TRUE(settled(ledger, verdict(closed(1, 10), {}, {})));
        const auto rows = kinds().size();
        ASSERT_TRUE(settled(ledger, verdict({}, {}, {})));
        EXPECT_EQ(kinds().size(), rows);
    }
}

TEST_F(LedgerKeeperTest, shouldLeaveTheRestOpenAfterAProvisionalVerdict) {
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    feeder::Settle settle = verdict(closed(1, 20), {}, {});
    settle.provisional = true;
    ASSERT_TRUE(settled(ledger, settle));
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 20)});
    EXPECT_EQ(in_state(RecordState::open), Ranges{closed(21, 512)});
    ASSERT_TRUE(settled(ledger, verdict({}, {}, closed(21, 512))));
    EXPECT_EQ(in_state(RecordState::unused), Ranges{closed(21, 512)});
}

TEST_F(LedgerKeeperTest, shouldWriteNothingBehindAVerdictThatReachesTheLastOpenRecord) {
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    ASSERT_TRUE(settled(ledger, verdict(closed(1, 511), closed(512, 512), {})));
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 511)});
    EXPECT_EQ(in_state(RecordState::in_doubt), Ranges{closed(512, 512)});
    EXPECT_TRUE(in_state(RecordState::unused).empty());
}

TEST_F(LedgerKeeperTest, shouldTakeDoubtThatLiesBeforeWhatIsPrinted) {
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    ASSERT_TRUE(settled(ledger, verdict(closed(2, 512), closed(1, 1), {})));
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(2, 512)});
    EXPECT_EQ(in_state(RecordState::in_doubt), Ranges{closed(1, 1)});
    EXPECT_TRUE(in_state(RecordState::unused).empty());
}

TEST_F(LedgerKeeperTest, shouldGoOnWithARunThatIsStillPrinting) {
    crash();
    LedgerKeeper ledger = keeper();
    const auto grant = ledger.adopt({RecordNumber{200}, RecordNumber{256}, {}});
    ASSERT_TRUE(grant);
    EXPECT_EQ(grant->range, closed(1, 2000));
    EXPECT_EQ(grant->durable_through, RecordNumber{512});
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 200)});
    ledger.intent(RecordNumber{600});
    ASSERT_TRUE(ledger.commit());
    EXPECT_EQ(in_state(RecordState::open), Ranges{closed(201, 600)});
    EXPECT_EQ(std::ranges::count(kinds(), LedgerKind::run_started), 1);
}

TEST_F(LedgerKeeperTest, shouldHavePendingConfirmationsWithoutAnIntent) {
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    ledger.printed(RecordNumber{1}, {});
    EXPECT_TRUE(ledger.has_pending());
}

TEST_F(LedgerKeeperTest, shouldSayThatARunStartCannotBeRead) {
    const auto run = spool_->begin_run(job_, closed(1, 10), "no run start").value();
    const spool::LedgerEntry intent{LedgerKind::intent, run, closed(1, 10), {}};
    ASSERT_TRUE(spool_->append(job_, {&intent, 1}));
    const auto open = find_open_issue(*spool_, job_);
    ASSERT_FALSE(open.has_value());
    EXPECT_EQ(open.error().kind, FailureKind::storage);
    EXPECT_THAT(open.error().message, testing::HasSubstr("the start of run 1 cannot be read"));
}

TEST_F(LedgerKeeperTest, shouldPlanNothingWhenNothingIsOpen) {
    const feeder::FeederPlan plan = make_plan(std::nullopt, job_, closed(1, 2000));
    EXPECT_FALSE(plan.open.has_value());
    EXPECT_FALSE(plan.take_over);
}

TEST_F(LedgerKeeperTest, shouldPlanToGoOnOnlyWithTheSameJobToTheSameEnd) {
    crash();
    const auto open = find_open_issue(*spool_, job_).value();
    const spool::JobId other{99};
    EXPECT_EQ(make_plan(open, job_, closed(1, 2000)).open, open->facts);
    EXPECT_TRUE(make_plan(open, job_, closed(1, 2000)).doubt_blocks);
    EXPECT_TRUE(make_plan(open, job_, closed(1, 2000)).take_over);
    EXPECT_FALSE(make_plan(open, job_, closed(1, 1999)).take_over);
    EXPECT_FALSE(make_plan(open, job_, {}).take_over);
    EXPECT_FALSE(make_plan(open, other, closed(1, 2000)).take_over);
    EXPECT_FALSE(make_plan(open, other, closed(1, 2000)).doubt_blocks);
}

TEST_F(LedgerKeeperTest, shouldCallUnusedWhatWasGrantedAndNeverSent) {
    feeder::Outcome outcome = ended(feeder::OutcomeCode::stop_requested);
    outcome.issued = false;
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    ASSERT_TRUE(ledger.finish(outcome));
    EXPECT_EQ(in_state(RecordState::unused), Ranges{closed(1, 512)});
    EXPECT_EQ(kinds().back(), LedgerKind::run_ended);
}

TEST_F(LedgerKeeperTest, shouldLeaveOpenWhatMayBeInThePrinter) {
    feeder::Outcome outcome = ended(feeder::OutcomeCode::no_answer);
    outcome.issued = true;
    LedgerKeeper ledger = keeper();
    ASSERT_TRUE(ledger.grant(begin()));
    ASSERT_TRUE(ledger.finish(outcome));
    EXPECT_EQ(in_state(RecordState::open), Ranges{closed(1, 512)});
    EXPECT_EQ(kinds().back(), LedgerKind::run_ended);
}

} // namespace
} // namespace linefeed::store
