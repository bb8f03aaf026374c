// Several runs on one store thread: what they want written goes into one transaction, and the mistake of one is not the
// others'.
#include "store/store_thread.hpp"
#include "support/spool_job.hpp"

#include <chrono>
#include <memory>

namespace linefeed::store {
namespace {

using spool::LedgerKind;
using spool::RecordState;
using test::closed;
using test::SpoolJobTest;

class StoreThreadTest : public SpoolJobTest {
protected:
    /// One job's run, as the feed thread sees it.
    struct Run {
        spool::JobId job;
        Store store;

        Run(spool::Spool& spool, spool::JobId id)
            : job(id)
            , store(StoreWork{spool, LedgerKeeper{spool, id, closed(1, 2000), "tcp://10.0.0.5:3000", std::nullopt}}) {}

        template <typename Reply>
        [[nodiscard]] bool wait_for() {
            const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{20};
            while (std::chrono::steady_clock::now() < deadline) {
                StoreReply reply;
                while (store.pop(reply)) {
                    if (std::holds_alternative<Reply>(reply)) {
                        return true;
                    }
                }
                store.replies_signal().wait(20);
            }
            return false;
        }
        void confirm(std::uint32_t through) {
            EXPECT_TRUE(store.push(feeder::ConfirmPrinted{RecordNumber{through}, {}}));
        }
        void end() {
            feeder::End end;
            end.outcome.issued = true; // nobody knows what the printer holds
            EXPECT_TRUE(store.push(end));
            store.join();
        }
    };

    void SetUp() override {
        SpoolJobTest::SetUp();
        thread_.emplace(*spool_);
        for (const spool::JobId job : {job_, import_job()}) {
            runs_.push_back(std::make_unique<Run>(*spool_, job));
            Run& run = *runs_.back();
            thread_->add(run.store);
            ASSERT_TRUE(run.store.push(feeder::BeginRun{}));
            ASSERT_TRUE(run.wait_for<Granted>());
        }
    }
    void TearDown() override {
        runs_.clear();
        thread_.reset();
        SpoolJobTest::TearDown();
    }
    /// The row that says records of the job are printed; each transaction of the test has a time of its own.
    std::vector<spool::LedgerRow> printed_rows(spool::JobId job) {
        std::vector<spool::LedgerRow> rows = spool_->ledger_rows(job, 0, 100).value();
        std::erase_if(rows, [](const spool::LedgerRow& row) { return row.entry.kind != LedgerKind::printed; });
        return rows;
    }

    std::optional<StoreThread> thread_;
    std::vector<std::unique_ptr<Run>> runs_;
};

TEST_F(StoreThreadTest, shouldWriteWhatSeveralRunsWantInOneTransaction) {
    // While the thread is held up, both come.
    thread_->call([this](spool::Spool&) {
        runs_[0]->confirm(10);
        runs_[1]->confirm(20);
        EXPECT_TRUE(runs_[1]->store.push(feeder::AskIntent{RecordNumber{700}}));
    });
    EXPECT_TRUE(runs_[1]->wait_for<Durable>());
    runs_[0]->end();
    runs_[1]->end();
    const auto first = printed_rows(runs_[0]->job);
    const auto second = printed_rows(runs_[1]->job);
    ASSERT_EQ(first.size(), 1U);
    ASSERT_EQ(second.size(), 1U);
    EXPECT_EQ(first[0].entry.range, closed(1, 10));
    EXPECT_EQ(second[0].entry.range, closed(1, 20));
    EXPECT_EQ(first[0].time_ns, second[0].time_ns);
    EXPECT_TRUE(spool_->verify_ledger());
}

TEST_F(StoreThreadTest, shouldStopOnlyTheRunWhoseRowsAreRefused) {
    thread_->call([this](spool::Spool& spool) {
        const spool::RunId run = spool.last_run(runs_[1]->job).value()->started.entry.run;
        const spool::LedgerEntry known{LedgerKind::printed, run, closed(1, 20), {}};
        ASSERT_TRUE(spool.append(runs_[1]->job, {&known, 1}));
        runs_[0]->confirm(10);
        runs_[1]->confirm(20); // the ledger knows that already
    });
    EXPECT_TRUE(runs_[1]->wait_for<StorageFailed>());
    runs_[0]->end();
    runs_[1]->end();
    EXPECT_EQ(runs_[0]->store.failure(), "");
    EXPECT_NE(runs_[1]->store.failure(), "");
    EXPECT_EQ(printed_rows(runs_[0]->job).size(), 1U);
}

TEST_F(StoreThreadTest, shouldGoOnWhenARunEndsAndAnotherComes) {
    runs_[0]->end();
    thread_->call([this](spool::Spool&) { job_ = import_job(); });
    runs_.push_back(std::make_unique<Run>(*spool_, job_));
    thread_->add(runs_[2]->store);
    ASSERT_TRUE(runs_[2]->store.push(feeder::BeginRun{}));
    EXPECT_TRUE(runs_[2]->wait_for<PageReady>());
    EXPECT_TRUE(runs_[1]->wait_for<PageReady>());
    runs_[1]->end();
    runs_[2]->end();
}

TEST_F(StoreThreadTest, shouldHandBackWhatACallThrows) {
    EXPECT_THROW(thread_->call([](spool::Spool&) { throw std::runtime_error{"no"}; }), std::runtime_error);
    runs_[0]->end();
    runs_[1]->end();
}

} // namespace
} // namespace linefeed::store
