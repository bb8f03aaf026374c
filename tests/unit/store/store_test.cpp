// The store thread: requests and replies through the rings, and what becomes of it when memory runs out.
#include "store/store_thread.hpp"
#include "support/spool_job.hpp"

#include <chrono>
#include <poll.h>

namespace linefeed::store {
namespace {

using spool::RecordState;
using test::closed;
using test::SpoolJobTest;

class StoreTest : public SpoolJobTest {
protected:
    void start() {
        store_.emplace(StoreWork{
            *spool_, LedgerKeeper{*spool_, job_, closed(1, records_of_job), "tcp://10.0.0.5:3000", std::nullopt}});
        thread_.emplace(*spool_);
        thread_->add(*store_);
    }
    void stop() {
        out_of_memory_ = false;
        store_.reset(); // joins: every test has ended the run
        thread_.reset();
    }
    void TearDown() override {
        stop();
        SpoolJobTest::TearDown();
    }
    /// The next reply of this kind; what comes before it is counted as failure only.
    template <typename Reply>
    std::optional<Reply> wait_for() {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{20};
        while (std::chrono::steady_clock::now() < deadline) {
            StoreReply reply;
            while (store_->pop(reply)) {
                failures_ += std::holds_alternative<StorageFailed>(reply) ? 1 : 0;
                if (const auto* found = std::get_if<Reply>(&reply)) {
                    return *found;
                }
            }
            store_->replies_signal().wait(20);
        }
        return std::nullopt;
    }
    void end_run() {
        feeder::End end;
        end.outcome.issued = true; // nobody knows what the printer holds
        ASSERT_TRUE(store_->push(end));
        store_->join();
        StoreReply reply;
        while (store_->pop(reply)) {
            failures_ += std::holds_alternative<StorageFailed>(reply) ? 1 : 0;
        }
    }
    /// Opened again as after a restart.
    void expect_durable(const Ranges& printed, const Ranges& open) {
        stop();
        open_spool({});
        EXPECT_TRUE(spool_->verify_ledger());
        EXPECT_EQ(in_state(RecordState::printed), printed);
        EXPECT_EQ(in_state(RecordState::open), open);
    }

    std::optional<StoreThread> thread_;
    std::optional<Store> store_;
    int failures_ = 0;
};

TEST_F(StoreTest, shouldCarryARunThrough) {
    start();
    ASSERT_TRUE(store_->push(feeder::BeginRun{}));
    const auto granted = wait_for<Granted>();
    ASSERT_TRUE(granted);
    EXPECT_EQ(granted->range, closed(1, 2000));
    const auto page = wait_for<PageReady>();
    ASSERT_TRUE(page);
    EXPECT_EQ(page->page->range(), closed(1, 500));
    ASSERT_TRUE(store_->push(feeder::ConfirmPrinted{RecordNumber{10}, {}}));
    ASSERT_TRUE(store_->push(feeder::AskIntent{RecordNumber{700}}));
    const auto durable = wait_for<Durable>();
    ASSERT_TRUE(durable);
    EXPECT_EQ(durable->through, RecordNumber{700});
    end_run();
    EXPECT_EQ(store_->failure(), "");
    EXPECT_EQ(failures_, 0);
    expect_durable({closed(1, 10)}, {closed(11, 700)});
}

TEST_F(StoreTest, shouldSayThatMemoryRanOutWhileItTookARequest) {
    start();
    out_of_memory_ = true;
    ASSERT_TRUE(store_->push(feeder::BeginRun{}));
    EXPECT_TRUE(wait_for<StorageFailed>());
    out_of_memory_ = false;
    ASSERT_TRUE(store_->push(feeder::BeginRun{})); // it takes requests, and writes nothing any more
    end_run();
    EXPECT_EQ(store_->failure(), "out of memory");
    EXPECT_EQ(failures_, 1);
    expect_durable({}, {});
}

TEST_F(StoreTest, shouldSayThatMemoryRanOutWhileItWrote) {
    start();
    ASSERT_TRUE(store_->push(feeder::BeginRun{}));
    ASSERT_TRUE(wait_for<Granted>());
    out_of_memory_ = true;
    ASSERT_TRUE(store_->push(feeder::AskIntent{RecordNumber{700}}));
    EXPECT_TRUE(wait_for<StorageFailed>());
    ASSERT_TRUE(store_->push(feeder::AskIntent{RecordNumber{800}}));
    ASSERT_TRUE(store_->push(feeder::ConfirmPrinted{RecordNumber{10}, {}}));
    ASSERT_TRUE(store_->push(feeder::Settle{}));
    end_run();
    EXPECT_EQ(store_->failure(), "out of memory");
    EXPECT_EQ(failures_, 1);
    expect_durable({}, {closed(1, 512)});
}

TEST_F(StoreTest, shouldEndWhenMemoryRunsOutAtTheEnd) {
    start();
    ASSERT_TRUE(store_->push(feeder::BeginRun{}));
    ASSERT_TRUE(wait_for<Granted>());
    out_of_memory_ = true;
    end_run();
    EXPECT_EQ(store_->failure(), "out of memory");
    EXPECT_EQ(failures_, 1);
    expect_durable({}, {closed(1, 512)});
}

} // namespace
} // namespace linefeed::store
