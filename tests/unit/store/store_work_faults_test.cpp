// The store over one run while every statement and every read of its spool fails in turn: the failure is told once, and
// what was acknowledged is in the ledger.
#include "store/store_work.hpp"
#include "support/crash_vfs.hpp"
#include "support/spool_job.hpp"
#include "support/sql_faults.hpp"

#include <functional>

namespace linefeed::store {
namespace {

using spool::RecordState;
using test::closed;
using test::DiskCall;
using test::SpoolJobTest;

class StoreWorkFaults : public SpoolJobTest {
protected:
    void SetUp() override {
        SpoolJobTest::SetUp();
        open_spool(disk.name()); // an empty one, in memory
        job_ = import_job();
        next_ = import_job();
        {
            LedgerKeeper keeper{*spool_, job_, wanted, "tcp://10.0.0.5:3000", std::nullopt};
            ASSERT_TRUE(keeper.grant({}));
            keeper.printed(RecordNumber{130}, {});
            ASSERT_TRUE(keeper.commit());
        }
        issue = find_open_issue(*spool_, job_).value();
        spool_.reset();
        image = disk.image(test::Survival::everything, 0);
    }

    /// Counts what is told of failures.
    void pump(StoreWork& work) {
        do {
            for (const StoreReply& reply : work.take_replies()) {
                told += std::holds_alternative<StorageFailed>(reply) ? 1 : 0;
                if (const auto* granted = std::get_if<Granted>(&reply)) {
                    durable = granted->durable_through;
                } else if (const auto* intent = std::get_if<Durable>(&reply)) {
                    durable = intent->through;
                }
            }
            if (work.wants_commit()) {
                work.commit();
            } else if (work.wants_read_ahead()) {
                work.read_ahead();
            } else {
                return;
            }
        } while (true);
    }
    void run(const std::vector<StoreRequest>& requests, const std::optional<OpenIssue>& open) {
        StoreWork work{*spool_, LedgerKeeper{*spool_, job_, wanted, "tcp://10.0.0.5:3000", open}};
        for (const StoreRequest& request : requests) {
            work.take(request);
            work.checkpoint();
            pump(work);
        }
        failure = work.failure();
    }
    void live_with_new_run() {
        feeder::Settle earlier;
        earlier.earlier_run = true;
        earlier.verdict.printed = closed(131, 200);
        run({earlier, feeder::BeginRun{}, feeder::AskIntent{RecordNumber{800}},
             feeder::ConfirmPrinted{RecordNumber{300}, {}}, feeder::Settle{}, feeder::End{}},
            issue);
    }
    void live_with_adopted_run() {
        feeder::Settle settle;
        settle.verdict.printed = closed(211, 220);
        run({feeder::AdoptRun{RecordNumber{200}, RecordNumber{256}, {}}, feeder::AskIntent{RecordNumber{800}},
             feeder::ConfirmPrinted{RecordNumber{210}, {}}, settle, feeder::End{}},
            issue);
    }
    /// The job to its end, and into the next one.
    void live_with_a_follower() {
        feeder::Settle earlier;
        earlier.earlier_run = true;
        earlier.verdict.printed = closed(131, 200);
        feeder::BeginRun follower;
        follower.follower = true;
        feeder::Settle settle;
        settle.verdict = {closed(2011, 2020), {}, closed(2021, 2400), feeder::Basis::mail_status};
        run({earlier, feeder::BeginRun{}, feeder::AskIntent{RecordNumber{2000}},
             feeder::ConfirmPrinted{RecordNumber{1900}, {}}, OfferFollower{next_, closed(1, records_of_job)}, follower,
             feeder::AskIntent{RecordNumber{2400}}, feeder::ConfirmPrinted{RecordNumber{2010}, {}}, settle,
             feeder::End{}},
            issue);
    }
    void settle_two_jobs() {
        feeder::BeginRun follower;
        follower.follower = true;
        feeder::Settle settle;
        settle.verdict = {closed(1901, 2020), {}, closed(2021, 2400), feeder::Basis::mail_status};
        run({feeder::AdoptRun{RecordNumber{200}, RecordNumber{256}, {}}, feeder::AskIntent{RecordNumber{2000}},
             feeder::ConfirmPrinted{RecordNumber{1900}, {}}, OfferFollower{next_, closed(1, records_of_job)}, follower,
             feeder::AskIntent{RecordNumber{2400}}, settle, feeder::End{}},
            issue);
    }
    /// A verdict that is the first to look into the ledger.
    void settle_without_looking() {
        run({feeder::AdoptRun{RecordNumber{130}, RecordNumber{256}, {}}, feeder::Settle{}}, issue);
    }
    /// Its rows wait when the follower is to begin.
    void begin_a_follower_with_rows_waiting() {
        feeder::BeginRun follower;
        follower.follower = true;
        StoreWork work{*spool_, LedgerKeeper{*spool_, job_, wanted, "tcp://10.0.0.5:3000", issue}};
        work.take(feeder::AdoptRun{RecordNumber{200}, RecordNumber{256}, {}});
        work.take(OfferFollower{next_, closed(1, records_of_job)});
        work.take(feeder::ConfirmPrinted{RecordNumber{210}, {}});
        work.take(follower);
        for (const StoreReply& reply : work.take_replies()) {
            told += std::holds_alternative<StorageFailed>(reply) ? 1 : 0;
        }
        failure = work.failure();
    }
    void look_for_what_is_open() {
        if (const auto found = find_open_issue(*spool_, job_); !found) {
            failure = found.error().message;
            ++told;
        }
    }
    /// A grant that is the first to look into the ledger.
    void begin_without_looking() { run({feeder::BeginRun{}}, std::nullopt); }
    /// Rows wait when the run is settled, or when it ends.
    void settle_with_rows_waiting() { wait_with(feeder::Settle{}); }
    void end_with_rows_waiting() { wait_with(feeder::End{}); }
    void wait_with(const StoreRequest& last) {
        StoreWork work{*spool_, LedgerKeeper{*spool_, job_, wanted, "tcp://10.0.0.5:3000", issue}};
        work.take(feeder::AdoptRun{RecordNumber{200}, RecordNumber{256}, {}});
        work.take(feeder::AskIntent{RecordNumber{800}});
        work.take(last);
        for (const StoreReply& reply : work.take_replies()) {
            told += std::holds_alternative<StorageFailed>(reply) ? 1 : 0;
        }
        failure = work.failure();
    }

    void fail_each(const std::function<void()>& live, const std::function<void(std::uint64_t)>& arm,
                   const std::function<bool()>& reached) {
        std::uint64_t k = 0;
        for (;; ++k) {
            spool_.reset();
            disk.load(image);
            open_spool(disk.name());
            durable = {};
            failure.clear();
            told = 0;
            arm(k);
            live();
            const bool was_reached = reached();
            disk.set_fault(std::nullopt);
            sql.refuse_nothing();
            if (!was_reached) {
                EXPECT_EQ(failure, "");
                EXPECT_EQ(told, 0);
                break;
            }
            ASSERT_NE(failure, "") << "fault " << k << " was not told";
            ASSERT_EQ(told, 1) << "fault " << k;
            open_spool(disk.name());
            ASSERT_TRUE(spool_->verify_ledger()) << "fault " << k;
            const auto state = spool_->ledger_state(job_).value();
            const auto state_of_next = spool_->ledger_state(next_).value(); // at the places behind
            for (std::uint32_t place = 1; place <= durable.value(); ++place) {
                const auto known = place <= records_of_job
                                       ? state.state_of(RecordNumber{place})
                                       : state_of_next.state_of(RecordNumber{place - records_of_job});
                ASSERT_NE(known, RecordState::fresh) << "fault " << k;
            }
        }
        EXPECT_GT(k, 0U);
    }
    void fail_each_statement(const std::function<void()>& live) {
        fail_each(
            live, [this](std::uint64_t k) { sql.refuse(k); }, [this] { return sql.has_refused(); });
    }
    void fail_each_call(const std::function<void()>& live, DiskCall kind) {
        std::uint64_t failed_before = 0;
        const auto arm = [&](std::uint64_t k) {
            failed_before = disk.failed_calls();
            disk.set_fault(test::DiskFault{{kind}, k, false, {}});
        };
        fail_each(live, arm, [&] { return disk.failed_calls() > failed_before; });
    }

    const RecordRange wanted = closed(1, records_of_job);
    test::CrashVfs disk{"store-work-faults"};
    test::SqlFaults sql;
    test::DiskImage image;
    std::optional<OpenIssue> issue;
    RecordNumber durable;
    std::string failure;
    int told = 0;
    spool::JobId next_{};
};

TEST_F(StoreWorkFaults, shouldTellEveryStatementThatFails) {
    fail_each_statement([this] { live_with_new_run(); });
    fail_each_statement([this] { live_with_adopted_run(); });
    fail_each_statement([this] { live_with_a_follower(); });
    fail_each_statement([this] { settle_two_jobs(); });
    fail_each_statement([this] { begin_a_follower_with_rows_waiting(); });
    fail_each_statement([this] { look_for_what_is_open(); });
    fail_each_statement([this] { begin_without_looking(); });
    fail_each_statement([this] { settle_without_looking(); });
}

TEST_F(StoreWorkFaults, shouldTellEveryReadThatFails) {
    fail_each_call([this] { live_with_new_run(); }, DiskCall::read);
    fail_each_call([this] { live_with_adopted_run(); }, DiskCall::read);
    fail_each_call([this] { live_with_a_follower(); }, DiskCall::read);
    fail_each_call([this] { look_for_what_is_open(); }, DiskCall::read);
    fail_each_call([this] { begin_without_looking(); }, DiskCall::read);
}

TEST_F(StoreWorkFaults, shouldTellEveryWriteThatFails) {
    fail_each_call([this] { live_with_new_run(); }, DiskCall::write);
    fail_each_call([this] { live_with_adopted_run(); }, DiskCall::write);
}

TEST_F(StoreWorkFaults, shouldTellAFailureOfRowsThatWaitedForTheVerdictOrTheEnd) {
    fail_each_call([this] { settle_with_rows_waiting(); }, DiskCall::write);
    fail_each_call([this] { end_with_rows_waiting(); }, DiskCall::write);
}

TEST_F(StoreWorkFaults, shouldTellThatTheLedgerCannotBeReadAtTheEnd) {
    open_spool(disk.name());
    std::vector<spool::JobId> others;
    for (int i = 0; i < 64; ++i) { // as many as the spool keeps ledgers in memory
        others.push_back(import_job(1, 1));
    }
    job_ = import_job();
    StoreWork work{*spool_, LedgerKeeper{*spool_, job_, wanted, "tcp://10.0.0.5:3000", std::nullopt}};
    work.take(feeder::BeginRun{});
    ASSERT_EQ(work.take_replies().size(), 1U);
    for (const spool::JobId other : others) {
        ASSERT_TRUE(spool_->ledger_state(other));
    }
    disk.set_fault(test::DiskFault{{DiskCall::read}, 0, true, {}});
    feeder::End end; // of a run that has sent nothing: what was granted is to become unused
    end.outcome.issued = false;
    work.take(end);
    disk.set_fault(std::nullopt);
    EXPECT_NE(work.failure(), "");
    EXPECT_TRUE(work.ended());
}

} // namespace
} // namespace linefeed::store
