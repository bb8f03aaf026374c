// What the store does for a run, request by request.
#include "../session/conversation.hpp"
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

class StoreWorkTest : public SpoolJobTest {
protected:
    StoreWork work(RecordRange wanted = closed(1, records_of_job)) {
        return StoreWork{*spool_, LedgerKeeper{*spool_, job_, wanted, "tcp://10.0.0.5:3000",
                                               find_open_issue(*spool_, job_).value()}};
    }
    template <typename Reply>
    static const Reply& only(const std::vector<StoreReply>& replies) {
        EXPECT_EQ(replies.size(), 1U);
        return std::get<Reply>(replies.at(0));
    }
    /// The records behind 130 stay open.
    void crash(RecordRange wanted = closed(1, records_of_job)) {
        StoreWork first = work(wanted);
        first.take(feeder::BeginRun{});
        first.take(feeder::ConfirmPrinted{RecordNumber{130}, {}});
        first.commit();
    }
    void make_unwritable() {
        spool_.reset();
        auto other = spool::Spool::open_for_reading(directory_ / "spool.db", {}).value();
        spool_.emplace(std::move(other));
    }
};

TEST_F(StoreWorkTest, shouldGrantReadAheadAndConfirm) {
    StoreWork store = work();
    store.take(std::monostate{});
    EXPECT_THAT(store.take_replies(), IsEmpty());
    EXPECT_FALSE(store.wants_commit());
    EXPECT_FALSE(store.wants_read_ahead()) << "nothing is granted yet";
    store.take(feeder::BeginRun{});
    const auto granted = store.take_replies();
    EXPECT_EQ(only<Granted>(granted).range, closed(1, 2000));
    EXPECT_EQ(only<Granted>(granted).durable_through, RecordNumber{512});

    ASSERT_TRUE(store.wants_read_ahead());
    std::vector<const RecordPage*> pages;
    while (store.wants_read_ahead()) {
        store.read_ahead();
        pages.push_back(only<PageReady>(store.take_replies()).page);
    }
    ASSERT_EQ(pages.size(), 4U);
    EXPECT_EQ(pages.back()->range(), closed(1501, 2000));
    store.take(PageReturned{pages.front()});

    store.take(feeder::ConfirmPrinted{RecordNumber{20}, {}});
    EXPECT_TRUE(store.wants_commit());
    EXPECT_FALSE(store.intent_waits());
    store.commit();
    EXPECT_THAT(store.take_replies(), IsEmpty()) << "nobody waits for a confirmation";
    store.take(feeder::AskIntent{RecordNumber{700}});
    EXPECT_TRUE(store.intent_waits());
    store.commit();
    EXPECT_EQ(only<Durable>(store.take_replies()).through, RecordNumber{700});
    store.checkpoint();

    feeder::Settle settle;
    settle.verdict = {closed(21, 30), {}, closed(31, 256), feeder::Basis::mail_status};
    store.take(settle);
    only<Settled>(store.take_replies());
    store.take(feeder::AskIntent{RecordNumber{900}});
    store.take(feeder::End{});
    EXPECT_TRUE(store.ended());
    EXPECT_FALSE(store.wants_commit());
    EXPECT_FALSE(store.wants_read_ahead());
    EXPECT_EQ(store.failure(), "");
    EXPECT_EQ(kinds().back(), LedgerKind::run_ended);
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 30)});
}

TEST_F(StoreWorkTest, shouldStopReadingAheadWhenTheSessionHoldsAllItCan) {
    job_ = import_job(20, 300); // more pages than are lent
    StoreWork store = work(closed(1, 20 * 300));
    store.take(feeder::BeginRun{});
    static_cast<void>(store.take_replies());
    std::vector<const RecordPage*> pages;
    while (store.wants_read_ahead()) {
        store.read_ahead();
        pages.push_back(only<PageReady>(store.take_replies()).page);
    }
    EXPECT_EQ(pages.size(), session::max_pages);
    store.take(PageReturned{pages.front()});
    EXPECT_TRUE(store.wants_read_ahead());
}

TEST_F(StoreWorkTest, shouldSayWhyThereIsNothingToPrint) {
    {
        StoreWork store = work(closed(1, 10));
        store.take(feeder::BeginRun{});
        static_cast<void>(store.take_replies());
        feeder::Settle settle;
        settle.verdict.printed = closed(1, 10);
        store.take(settle);
        store.take(feeder::End{});
    }
    {
        StoreWork store = work(closed(1, 10));
        store.take(feeder::BeginRun{});
        EXPECT_EQ(only<Refused>(store.take_replies()).why, feeder::OutcomeCode::nothing_to_print);
        store.take(feeder::End{});
    }
    {
        StoreWork store = work(closed(11, 20));
        store.take(feeder::BeginRun{});
        static_cast<void>(store.take_replies());
        feeder::Settle settle;
        settle.verdict.in_doubt = closed(11, 12);
        store.take(settle);
        store.take(feeder::End{});
    }
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    EXPECT_EQ(only<Refused>(store.take_replies()).why, feeder::OutcomeCode::records_in_doubt);
}

TEST_F(StoreWorkTest, shouldSettleAnEarlierRun) {
    crash();
    StoreWork store = work();
    feeder::Settle settle;
    settle.earlier_run = true;
    settle.verdict.printed = closed(131, 200);
    store.take(settle);
    only<Settled>(store.take_replies());
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 200)});
    EXPECT_EQ(in_state(RecordState::unused), Ranges{closed(201, 512)});
}

TEST_F(StoreWorkTest, shouldReadAheadFromBehindWhatATakenOverPrinterHolds) {
    crash();
    StoreWork store = work();
    store.take(feeder::AdoptRun{RecordNumber{200}, RecordNumber{500}, {}});
    EXPECT_EQ(only<Granted>(store.take_replies()).range, closed(1, 2000));
    ASSERT_TRUE(store.wants_read_ahead());
    store.read_ahead();
    EXPECT_EQ(only<PageReady>(store.take_replies()).page->range(), closed(501, 1000));
}

/// The store hangs in a write while the end of the job is printed: the verdict overtakes the confirmations.
TEST_F(StoreWorkTest, shouldCallNothingUnusedThatTheFeederHasConfirmed) {
    StoreWork store = work(closed(1, 500));
    store.take(feeder::BeginRun{});
    store.take(feeder::ConfirmPrinted{RecordNumber{130}, {}});
    feeder::Settle settle;
    settle.verdict.basis = feeder::Basis::nothing_issued;
    settle.confirmed_through = RecordNumber{500};
    store.take(settle);
    store.take(feeder::ConfirmPrinted{RecordNumber{400}, {}});
    store.take(feeder::End{});
    EXPECT_EQ(store.failure(), "");
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 500)});
    EXPECT_TRUE(in_state(RecordState::unused).empty());
}

TEST_F(StoreWorkTest, shouldTakeTheFinalVerdictBehindTheProvisionalOne) {
    StoreWork store = work(closed(1, 500));
    store.take(feeder::BeginRun{});
    store.take(feeder::ConfirmPrinted{RecordNumber{130}, {}});
    feeder::Settle first_look;
    first_look.verdict.printed = closed(131, 140);
    first_look.provisional = true;
    first_look.confirmed_through = RecordNumber{130};
    store.take(first_look);
    feeder::Settle final_look;
    final_look.verdict.in_doubt = closed(141, 141);
    final_look.confirmed_through = RecordNumber{140};
    store.take(final_look);
    store.take(feeder::End{});
    EXPECT_EQ(store.failure(), "");
    EXPECT_EQ(in_state(RecordState::printed), Ranges{closed(1, 140)});
    EXPECT_EQ(in_state(RecordState::in_doubt), Ranges{closed(141, 141)});
    EXPECT_EQ(in_state(RecordState::unused), Ranges{closed(142, 500)});
}

TEST_F(StoreWorkTest, shouldReadNothingWhenATakenOverPrinterHoldsTheLastRecord) {
    crash(closed(1, 300));
    StoreWork store = work(closed(1, 300));
    store.take(feeder::AdoptRun{RecordNumber{200}, RecordNumber{300}, {}});
    EXPECT_EQ(only<Granted>(store.take_replies()).range, closed(1, 300));
    EXPECT_FALSE(store.wants_read_ahead());
}

TEST_F(StoreWorkTest, shouldTellAFailureOnceAndWriteNothingAfterIt) {
    make_unwritable();
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    only<StorageFailed>(store.take_replies());
    EXPECT_THAT(store.failure(), testing::HasSubstr("reading only"));
    const std::string failure = store.failure();
    store.take(feeder::BeginRun{});
    store.take(feeder::Settle{});
    store.take(feeder::AdoptRun{});
    store.take(feeder::AskIntent{RecordNumber{600}});
    store.take(feeder::ConfirmPrinted{RecordNumber{1}, {}});
    store.take(PageReturned{});
    store.checkpoint();
    EXPECT_FALSE(store.wants_commit());
    EXPECT_FALSE(store.intent_waits());
    EXPECT_FALSE(store.wants_read_ahead());
    EXPECT_FALSE(store.fail_out_of_memory());
    store.take(feeder::End{});
    EXPECT_TRUE(store.ended());
    EXPECT_THAT(store.take_replies(), IsEmpty());
    EXPECT_EQ(store.failure(), failure);
}

TEST_F(StoreWorkTest, shouldFailWithoutMemory) {
    StoreWork store = work();
    store.take(feeder::BeginRun{});
    EXPECT_TRUE(store.fail_out_of_memory());
    EXPECT_EQ(store.failure(), "out of memory");
    EXPECT_FALSE(store.fail_out_of_memory()) << "told once";
    EXPECT_FALSE(store.wants_read_ahead());
}

/// Replies as the session's conversation shows them.
class Delivery : public testing::Test {
protected:
    void deliver_now(const StoreReply& reply) {
        deliver(reply, host.session, host.now, host.effects);
        host.wait(Duration{}); // carries out the effects
    }
    void wait_for_grant() {
        host.connect();
        host.receive("^0=RS2\t5\t0\t0\t0\t0\r^0=VS1\t1\t1\t1\t1\t1\t1\t1\t1\t1\tS1\r^0=JLA\r"
                     "^0=SM256\t0\t0\t0\t1\r^0=SM256\t0\t0\t0\t1\r^0=CC0\t0\t1000\r");
        host.story();
        host.sent();
    }
    const std::vector<std::unique_ptr<RecordPage>> pages = session::make_pages(1, 10, 10, session::plain_text);
    session::Conversation host;
};

TEST_F(Delivery, shouldBringGrantPageAndIntents) {
    wait_for_grant();
    deliver_now(std::monostate{});
    EXPECT_EQ(host.sent(), "");
    deliver_now(Granted{closed(1, 10), RecordNumber{5}});
    EXPECT_THAT(host.sent(), testing::HasSubstr("^0!FF\n"));
    host.receive("^0=SM256\t0\t0\t0\t1\r^0=SM256\t0\t0\t10\t1\r");
    EXPECT_THAT(host.sent(), testing::Not(testing::HasSubstr("=MR")));
    deliver_now(PageReady{pages.front().get()});
    deliver_now(Durable{RecordNumber{10}});
    EXPECT_THAT(host.sent(), testing::HasSubstr("^0=MR10\trecord 10\n"));
}

TEST_F(Delivery, shouldBringTheEndOfTheRun) {
    wait_for_grant();
    deliver_now(Granted{closed(1, 1000), RecordNumber{10}});
    deliver_now(EndKnown{RecordNumber{10}});
    host.sent();
    host.receive("^0=SM256\t0\t0\t0\t1\r");
    EXPECT_THAT(host.sent(), testing::HasSubstr("^0=CM10\n"));
}

TEST_F(Delivery, shouldStopTheLineWhenTheSupplyFails) {
    host.print(pages);
    host.sent();
    deliver_now(SupplyFailed{});
    EXPECT_THAT(host.sent(), testing::HasSubstr("^0!ST\n"));
}

TEST_F(Delivery, shouldBringARefusal) {
    wait_for_grant();
    deliver_now(Refused{feeder::OutcomeCode::records_in_doubt});
    EXPECT_EQ(host.outcome.code, feeder::OutcomeCode::records_in_doubt);
    EXPECT_TRUE(host.ended);
}

TEST_F(Delivery, shouldBringTheFailureOfTheStorage) {
    wait_for_grant();
    deliver_now(StorageFailed{});
    EXPECT_EQ(host.outcome.code, feeder::OutcomeCode::storage_failed);
    EXPECT_TRUE(host.ended);
}

TEST_F(Delivery, shouldBringAVerdictThatIsDurable) {
    host.print(pages);
    host.stop();
    host.receive("^0=RS2\t5\t0\t0\t0\t0\r^0=RS2\t5\t0\t0\t0\t0\r");
    for (int i = 0; i < 3; ++i) {
        host.receive("^0=SM256\t0\t3\t0\t1\r");
    }
    host.receive("^0=CC0\t0\t1003\r");
    ASSERT_THAT(host.story(), testing::HasSubstr("settle this run"));
    host.sent();
    deliver_now(Settled{});
    EXPECT_THAT(host.sent(), testing::HasSubstr("^0!FF\n")) << "only now the printer may forget";
}

} // namespace
} // namespace linefeed::store
