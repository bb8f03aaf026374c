// The import as the supply of a run on the store thread: written between the run's own steps, given back at its end.
#include "daemon/running_import.hpp"
#include "rows_double.hpp"
#include "store/store_thread.hpp"
#include "support/spool_job.hpp"

#include <chrono>
#include <optional>
#include <variant>

namespace linefeed::daemon {
namespace {

using test::closed;
using test::SpoolJobTest;

/// Two runs on one store thread: one of a job that is there, one of a job that is still being imported.
class SupplyOnAThread : public SpoolJobTest {
protected:
    template <typename Reply>
    static std::optional<Reply> wait_for(store::Store& store) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{20};
        while (std::chrono::steady_clock::now() < deadline) {
            store::StoreReply reply;
            while (store.pop(reply)) {
                if (const auto* wanted = std::get_if<Reply>(&reply)) {
                    return *wanted;
                }
            }
            store.replies_signal().wait(20);
        }
        return std::nullopt;
    }
    store::LedgerKeeper keeper(spool::JobId job) {
        return store::LedgerKeeper{*spool_, job, closed(1, 2000), "tcp://10.0.0.5:3000", std::nullopt};
    }
    static void end(store::Store& store) {
        feeder::End end;
        end.outcome.issued = true; // nobody knows what the printer holds
        EXPECT_TRUE(store.push(end));
        store.join();
    }
};

TEST_F(SupplyOnAThread, shouldImportForOneRunWhileItServesAnother) {
    RowsDouble rows;
    RunningImport import{spool_->begin_import({}).value(), rows.source(), {}, {}};
    import.start();
    rows.give(512);
    while (import.durable().empty()) { // before the run
        import.wants_step() ? import.step() : import.wait(20);
    }
    store::StoreThread thread{*spool_};
    store::Store other{store::StoreWork{*spool_, keeper(job_)}};
    store::Store store{store::StoreWork{*spool_, keeper(import.job()), &import}};
    thread.add(other);
    thread.add(store);
    ASSERT_TRUE(other.push(feeder::BeginRun{}) && store.push(feeder::BeginRun{}));
    EXPECT_EQ(wait_for<store::Granted>(store)->durable_through, RecordNumber{512});
    EXPECT_TRUE(wait_for<store::PageReady>(other));
    ASSERT_TRUE(store.push(feeder::AskIntent{RecordNumber{700}}));
    rows.give(512); // wakes the thread
    EXPECT_EQ(wait_for<store::Durable>(store)->through, RecordNumber{700});
    ASSERT_TRUE(other.push(feeder::AskIntent{RecordNumber{700}}));
    EXPECT_TRUE(wait_for<store::Durable>(other));
    rows.end();
    EXPECT_EQ(wait_for<store::EndKnown>(store)->last, RecordNumber{1024});
    end(store);
    end(other);
    EXPECT_TRUE(import.over());
    EXPECT_EQ(spool_->job(import.job()).value()->state, spool::ImportState::ready);
    EXPECT_TRUE(spool_->verify_ledger());
}

TEST_F(SupplyOnAThread, shouldGiveTheImportBackWhenTheRunEnds) {
    RowsDouble rows;
    RunningImport import{spool_->begin_import({}).value(), rows.source(), {}, {}};
    import.start();
    rows.give(512);
    while (import.durable().empty()) {
        import.wants_step() ? import.step() : import.wait(20);
    }
    {
        store::StoreThread thread{*spool_};
        store::Store store{store::StoreWork{*spool_, keeper(import.job()), &import}};
        thread.add(store);
        end(store);
    } // nobody may be woken there any more
    rows.give(512);
    rows.end();
    while (!import.over()) {
        import.wants_step() ? import.step() : import.wait(20);
    }
    EXPECT_EQ(spool_->job(import.job()).value()->records, closed(1, 1024));
}

} // namespace
} // namespace linefeed::daemon
