// Two jobs in one run: what goes to which ledger, how far the follower may be issued, and what a crash leaves of both.
#include "store/store_work.hpp"
#include "support/spool_job.hpp"

#include <gmock/gmock.h>

namespace linefeed::store {
namespace {

using spool::LedgerKind;
using spool::RecordState;
using test::closed;
using test::SpoolJobTest;
using testing::IsEmpty;

RecordNumber no(std::uint32_t value) {
    return RecordNumber{value};
}

/// The job has the records 1-2000, and so has the follower, at the places 2001-4000.
class StoreChainTest : public SpoolJobTest {
protected:
    void SetUp() override {
        SpoolJobTest::SetUp();
        next_ = import_job();
    }
    StoreWork begun(RecordRange wanted = closed(1, records_of_job)) {
        StoreWork store{*spool_, LedgerKeeper{*spool_, job_, wanted, "tcp://10.0.0.5:3000", open()}};
        store.take(feeder::BeginRun{});
        store.take(feeder::AskIntent{wanted.last()});
        store.commit();
        store.take(OfferFollower{next_, closed(1, records_of_job)});
        return store;
    }
    std::optional<OpenIssue> open() { return find_open_issue(*spool_, job_).value(); }
    static feeder::BeginRun follower() {
        feeder::BeginRun begin;
        begin.printer.total_prints = 7000;
        begin.last_printed_before = no(records_of_job);
        begin.follower = true;
        return begin;
    }
    static void confirm(StoreWork& store, std::uint32_t place) {
        store.take(feeder::ConfirmPrinted{no(place), {}});
        store.commit();
        ASSERT_EQ(store.failure(), "");
    }
    /// Both begun, `place` printed, intents as far as they go.
    StoreWork chained(std::uint32_t place) {
        StoreWork store = begun();
        confirm(store, place);
        store.take(follower());
        static_cast<void>(store.take_replies());
        store.take(feeder::AskIntent{no(2500)});
        store.commit();
        EXPECT_EQ(store.failure(), "");
        return store;
    }
    static std::optional<FollowerBegun> begun_follower(StoreWork& store) {
        for (const StoreReply& reply : store.take_replies()) {
            if (const auto* follower = std::get_if<FollowerBegun>(&reply)) {
                return *follower;
            }
        }
        return std::nullopt;
    }
    Ranges of_next(RecordState state) { return spool_->ledger_state(next_).value().ranges(state); }

    spool::JobId next_{};
};

TEST_F(StoreChainTest, shouldBeginTheFollowerBehindTheJob) {
    StoreWork store = begun();
    confirm(store, 10);
    store.take(follower());
    const auto follower = begun_follower(store);
    ASSERT_TRUE(follower);
    EXPECT_EQ(follower->places, closed(2001, 4000));
    EXPECT_EQ(follower->number, no(1));
    EXPECT_THAT(of_next(RecordState::open), IsEmpty()) << "no intents yet";
}

TEST_F(StoreChainTest, shouldTellTheFeederOfAnOfferWithRecords) {
    StoreWork store = begun();
    store.take(OfferFollower{next_, {}});
    int known = 0;
    for (const StoreReply& reply : store.take_replies()) {
        if (const auto* follower = std::get_if<FollowerKnown>(&reply)) {
            ++known;
            EXPECT_EQ(follower->count, RecordCount{2000});
        }
    }
    EXPECT_EQ(known, 1);
}

TEST_F(StoreChainTest, shouldNotBeginAFollowerWhileANumberFromBeforeTheRunMayBeReported) {
    StoreWork store = begun();
    store.take(follower());
    EXPECT_FALSE(begun_follower(store));
}

TEST_F(StoreChainTest, shouldBeginOneFollowerAtATime) {
    StoreWork store = begun();
    confirm(store, 10);
    store.take(follower());
    EXPECT_TRUE(begun_follower(store));
    store.take(OfferFollower{import_job(), closed(1, 2000)});
    store.take(follower());
    EXPECT_FALSE(begun_follower(store));
}

TEST_F(StoreChainTest, shouldNotBeginAFollowerOfAJobThatHasRecordsBehindTheRun) {
    StoreWork store = begun(closed(1, 1000));
    confirm(store, 30);
    store.take(follower());
    EXPECT_FALSE(begun_follower(store));
}

TEST_F(StoreChainTest, shouldNotBeginAFollowerThatTheLedgerKnows) {
    StoreWork other{*spool_, LedgerKeeper{*spool_, next_, closed(1, 5), "tcp://10.0.0.5:3000", std::nullopt}};
    other.take(feeder::BeginRun{});
    StoreWork store = begun();
    confirm(store, 40);
    store.take(follower());
    EXPECT_FALSE(begun_follower(store));
}

TEST_F(StoreChainTest, shouldIssueTheFollowerOnlyAsFarAsItsNumbersTellItFromTheJob) {
    StoreWork store = chained(300);
    EXPECT_EQ(of_next(RecordState::open), Ranges{closed(1, 299)}) << "300 may still be reported of the job";
    confirm(store, 350);
    ASSERT_TRUE(store.wants_commit());
    store.commit();
    EXPECT_EQ(of_next(RecordState::open), Ranges{closed(1, 349)});
    confirm(store, 1990);
    store.commit();
    EXPECT_EQ(of_next(RecordState::open), Ranges{closed(1, 500)}) << "as far as it was asked for";
}

TEST_F(StoreChainTest, shouldIssueNothingOfTheFollowerThatIsNotAskedFor) {
    StoreWork store = begun();
    store.take(feeder::ConfirmPrinted{no(10), {}}); // waits to be written
    store.take(follower());
    EXPECT_TRUE(begun_follower(store));
    store.take(feeder::ConfirmPrinted{no(20), {}});
    store.take(feeder::AskIntent{no(1500)});
    store.commit();
    EXPECT_THAT(store.take_replies(), IsEmpty()) << "nothing more is durable";
    EXPECT_THAT(of_next(RecordState::open), IsEmpty());
}

TEST_F(StoreChainTest, shouldBeginNothingWithoutAnOffer) {
    StoreWork store{*spool_, LedgerKeeper{*spool_, job_, closed(1, 2000), "tcp://10.0.0.5:3000", open()}};
    store.take(feeder::BeginRun{});
    confirm(store, 10);
    store.take(follower());
    EXPECT_FALSE(begun_follower(store));
}

TEST_F(StoreChainTest, shouldHandTheFollowerToTheSession) {
    session::Session session{{}, {}};
    session::Effects effects;
    deliver(FollowerKnown{RecordCount{5}}, session, {}, effects);
    deliver(FollowerBegun{closed(2001, 4000), no(1)}, session, {}, effects);
    EXPECT_TRUE(effects.empty()) << "it has not asked";
}

TEST_F(StoreChainTest, shouldTellWhatIsDurableByPlaces) {
    StoreWork store = chained(1000);
    const auto replies = store.take_replies();
    ASSERT_EQ(replies.size(), 1U);
    EXPECT_EQ(std::get<Durable>(replies.front()).through, no(2500));
}

TEST_F(StoreChainTest, shouldLendThePagesOfTheFollowerBehindThoseOfTheJobAndBeginWithZero) {
    StoreWork store = chained(1000);
    static_cast<void>(store.take_replies());
    std::vector<const RecordPage*> pages;
    while (store.wants_read_ahead()) {
        store.read_ahead();
        pages.push_back(std::get<PageReady>(store.take_replies().at(0)).page);
    }
    ASSERT_EQ(pages.size(), 8U);
    EXPECT_EQ(pages[3]->range(), closed(1501, 2000));
    EXPECT_EQ(pages[4]->range(), closed(2001, 2500));
    EXPECT_EQ(pages[4]->slice(closed(2001, 2002)), "^0=MR0\tx\r^0=MR2\tx\r");
    EXPECT_EQ(pages[4]->slice(closed(2500, 2500)), "^0=MR500\tx\r");
    EXPECT_EQ(pages[5]->slice(closed(2501, 2501)), "^0=MR501\tx\r");
}

TEST_F(StoreChainTest, shouldLeaveTheJobWhenAllOfItIsDurablyPrinted) {
    StoreWork store = chained(1000);
    confirm(store, 2003);
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 2000)});
    EXPECT_EQ(kinds().back(), LedgerKind::run_ended);
    EXPECT_EQ(of_next(RecordState::printed), Ranges{closed(1, 3)});
    store.take(feeder::AskIntent{no(3900)});
    store.commit();
    EXPECT_EQ(of_next(RecordState::open), Ranges{closed(4, 1900)}) << "nothing else can be reported now";
    const spool::JobId third = import_job();
    store.take(OfferFollower{third, closed(1, 2000)});
    store.take(follower());
    const auto begun = begun_follower(store);
    ASSERT_TRUE(begun);
    EXPECT_EQ(begun->places, closed(4001, 6000));
}

TEST_F(StoreChainTest, shouldSettleBothJobsByPlaces) {
    StoreWork store = chained(1000);
    static_cast<void>(store.take_replies());
    feeder::Settle settle;
    settle.verdict = {closed(1001, 2004), closed(2005, 2005), closed(2006, 2400), feeder::Basis::mail_status};
    settle.confirmed_through = no(1000);
    store.take(settle);
    ASSERT_TRUE(std::holds_alternative<Settled>(store.take_replies().back()));
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 2000)});
    EXPECT_EQ(of_next(RecordState::printed), Ranges{closed(1, 4)});
    EXPECT_EQ(of_next(RecordState::in_doubt), Ranges{closed(5, 5)});
    EXPECT_EQ(of_next(RecordState::unused), Ranges{closed(6, 500)});
    EXPECT_FALSE(store.wants_commit()) << "nothing more is issued";
    store.take(feeder::End{});
    EXPECT_EQ(kinds().back(), LedgerKind::run_ended);
    EXPECT_EQ(spool_->ledger_rows(next_, 0, 100).value().back().entry.kind, LedgerKind::run_ended);
}

TEST_F(StoreChainTest, shouldFindBothJobsAfterACrash) {
    chained(1000);
    const auto found = open();
    ASSERT_TRUE(found);
    ASSERT_EQ(found->jobs.size(), 2U);
    EXPECT_EQ(found->jobs[0].job, job_);
    EXPECT_EQ(found->jobs[0].records, closed(1001, 2000));
    EXPECT_EQ(found->jobs[1].job, next_);
    EXPECT_EQ(found->jobs[1].records, closed(1, 500));
    EXPECT_EQ(found->of(next_), &found->jobs[1]);
    EXPECT_EQ(found->of(spool::JobId{99}), nullptr);
    EXPECT_EQ(found->facts.first, no(1));
    EXPECT_EQ(found->facts.printed_through, no(1000));
    EXPECT_EQ(found->facts.issued_through, no(2500));
    EXPECT_EQ(found->numbering.on_wire(no(2001)), no(0));
    const auto by_next = find_open_issue(*spool_, next_).value();
    ASSERT_TRUE(by_next);
    EXPECT_EQ(by_next->facts, found->facts);
    EXPECT_FALSE(make_plan(found, job_, closed(1, 2000)).take_over) << "two jobs are asked about, not gone on with";
    EXPECT_TRUE(make_plan(found, next_, closed(1, 2000)).doubt_blocks);
}

TEST_F(StoreChainTest, shouldSettleWhatACrashHasLeftOfBoth) {
    chained(1000);
    StoreWork store{*spool_, LedgerKeeper{*spool_, next_, {}, "tcp://10.0.0.5:3000", open()}};
    feeder::Settle settle;
    settle.earlier_run = true;
    settle.verdict = {closed(1001, 1990), closed(1991, 2002), closed(2003, 2500), feeder::Basis::none};
    store.take(settle);
    EXPECT_EQ(in_state(RecordState::in_doubt), Ranges{closed(1991, 2000)});
    EXPECT_EQ(of_next(RecordState::in_doubt), Ranges{closed(1, 2)});
    EXPECT_EQ(of_next(RecordState::unused), Ranges{closed(3, 500)});
}

TEST_F(StoreChainTest, shouldRememberWhatWasSeenOfBothWhenTheyStayOpen) {
    chained(1000);
    StoreWork store{*spool_, LedgerKeeper{*spool_, job_, {}, "tcp://10.0.0.5:3000", open()}};
    feeder::End end;
    end.outcome.code = feeder::OutcomeCode::no_answer;
    end.outcome.broken_off = no(2001);
    end.outcome.unclear = true;
    store.take(end);
    const auto found = open();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->facts.broken_off, no(2001));
    EXPECT_TRUE(found->facts.unclear);
}

TEST_F(StoreChainTest, shouldKnowThatTheFollowerAloneHasBegunWithZero) {
    {
        StoreWork store = chained(1000);
        confirm(store, 2003);
    }
    const auto found = find_open_issue(*spool_, next_).value();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->jobs.size(), 1U);
    EXPECT_EQ(found->facts.total_before, 7000U);
    EXPECT_EQ(found->facts.last_printed_before, no(2000));
    EXPECT_EQ(found->numbering.on_wire(no(1)), no(0));
    EXPECT_TRUE(make_plan(found, next_, closed(1, 2000)).take_over);
}

TEST_F(StoreChainTest, shouldTellPlacesOfRecordsBeforeTheFirst) {
    const JobPlaces places{no(2001), no(1), no(4000)};
    EXPECT_EQ(places.place_of(no(0)), no(2000));
    EXPECT_EQ(places.through(no(1500)), no(0));
    EXPECT_EQ(places.record_at(no(2000)), no(0));
    EXPECT_EQ(places.record_at(no(4001)), no(0));
    EXPECT_EQ(places.records(closed(1, 2000)), RecordRange{});
    EXPECT_EQ(places.records({}), RecordRange{});
    EXPECT_EQ(places.records(closed(5000, 6000)), RecordRange{});
    EXPECT_EQ(places.records(closed(1, 5000)), closed(1, 2000));
}

} // namespace
} // namespace linefeed::store
