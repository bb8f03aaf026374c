// Every statement of the ledger fails in turn, before it runs or while it reads or writes: the failure is told, and
// what was acknowledged is there when the spool is opened again.
#include "spool_fixture.hpp"
#include "support/crash_vfs.hpp"
#include "support/sql_faults.hpp"

#include <fstream>

namespace linefeed::spool {
namespace {

using test::DiskCall;

class LedgerFaultsTest : public SpoolTest {
protected:
    void SetUp() override {
        SpoolTest::SetUp();
        std::ofstream{path} << ""; // open_for_reading() looks for a real file
        Spool first = open_on_disk().value();
        job = make_job(first).id;
        other_job = make_job(first).id;
        run = first.begin_run(job, range(1, 100), "{}").value();
        ASSERT_TRUE(append(first, job, {{LedgerKind::intent, run, range(1, 30), "{}"}}));
        ASSERT_TRUE(append(first, job, {{LedgerKind::in_doubt, run, range(11, 12), "{}"}}));
        initial = first.ledger_state(job).value();
    }
    Result<Spool> open_on_disk() {
        return Spool::open(path, {[this] { return now_ns; }, disk.name()});
    }

    template <typename T>
    bool keep(const Result<T>& result) {
        if (!result) {
            failure = result.error();
        }
        return result.has_value();
    }
    bool keep_append(RunId row_run, LedgerKind kind, RecordRange records) {
        const LedgerEntry entry{kind, row_run, records, "{}"};
        EXPECT_TRUE(attempted.apply(entry));
        if (!keep(spool->append(job, {&entry, 1}))) {
            return false;
        }
        acknowledged = attempted;
        return true;
    }
    /// Everything that a ledger is asked and told, up to the first failure.
    bool live() {
        if (auto opened = open_on_disk(); keep(opened)) {
            spool.emplace(std::move(*opened));
        } else {
            return false;
        }
        if (!keep(spool->last_ledger_row(job)) || !keep(spool->jobs_with_open_records()) ||
            !keep(spool->last_run(job)) || !keep(spool->ledger_rows(job, 0, 10)) ||
            !keep(spool->doubt_rows(job, run)) || !keep(spool->ledger_state(other_job)) ||
            !keep_append(run, LedgerKind::printed, range(1, 10)) ||
            !keep_append(run, LedgerKind::released, range(12, 12)) ||
            !keep_append(run, LedgerKind::run_ended, RecordRange{})) {
            return false;
        }
        const auto next = spool->begin_run(job, range(13, 100), "{}");
        return keep(next) && keep_append(*next, LedgerKind::intent, range(31, 40)) &&
               keep_append(*next, LedgerKind::intent, range(12, 12)) && keep(spool->last_run(job)) &&
               keep(spool->verify_ledger());
    }
    /// As another process reads it.
    bool look() {
        if (auto opened = Spool::open_for_reading(path, {[this] { return now_ns; }, disk.name()}); keep(opened)) {
            spool.emplace(std::move(*opened));
        } else {
            return false;
        }
        return keep(spool->verify_ledger());
    }

    /// `arm(k)` makes the k-th thing fail, `reached()` says whether it came to that.
    template <typename Act, typename Arm, typename Reached>
    void fail_each(Act act, Arm arm, Reached reached) {
        const test::DiskImage image = disk.image(test::Survival::everything, 0);
        std::uint64_t k = 0;
        for (;; ++k) {
            disk.load(image);
            acknowledged = attempted = initial;
            failure.reset();
            arm(k);
            const bool lived = act();
            const bool was_reached = reached();
            disk.set_fault(std::nullopt);
            sql.refuse_nothing();
            spool.reset();
            if (!was_reached) {
                ASSERT_TRUE(lived) << failure->message;
                break;
            }
            ASSERT_FALSE(lived) << "fault " << k << " was not told";
            EXPECT_FALSE(failure->message.empty());
            Spool again = open_on_disk().value();
            ASSERT_TRUE(again.verify_ledger()) << "fault " << k;
            const LedgerState state = again.ledger_state(job).value();
            ASSERT_TRUE(state == acknowledged || state == attempted) << "fault " << k;
        }
        EXPECT_GT(k, 10U);
    }
    template <typename Act>
    void refuse_each_statement(Act act) {
        fail_each(
            act, [this](std::uint64_t k) { sql.refuse(k); }, [this] { return sql.has_refused(); });
    }
    template <typename Act>
    void fail_each_call(Act act, DiskCall kind) {
        std::uint64_t failed_before = 0;
        const auto arm = [&](std::uint64_t k) {
            failed_before = disk.failed_calls();
            disk.set_fault(test::DiskFault{{kind}, k, false, {}});
        };
        fail_each(act, arm, [&] { return disk.failed_calls() > failed_before; });
    }

    test::CrashVfs disk{"ledger-faults"};
    test::SqlFaults sql;
    JobId job{};
    JobId other_job{};
    RunId run{};
    std::optional<Spool> spool;
    std::optional<Failure> failure;
    LedgerState initial;
    LedgerState acknowledged; ///< what every acknowledged row comes to
    LedgerState attempted;    ///< and the row that was tried last
};

TEST_F(LedgerFaultsTest, shouldTellEveryStatementThatCannotBePrepared) {
    refuse_each_statement([this] { return live(); });
}

TEST_F(LedgerFaultsTest, shouldTellEveryReadThatFails) {
    fail_each_call([this] { return live(); }, DiskCall::read);
}

TEST_F(LedgerFaultsTest, shouldTellEveryWriteThatFails) {
    fail_each_call([this] { return live(); }, DiskCall::write);
}

TEST_F(LedgerFaultsTest, shouldTellAReaderOfEveryStatementThatCannotBePrepared) {
    refuse_each_statement([this] { return look(); });
}

TEST_F(LedgerFaultsTest, shouldTellAReaderOfEveryReadThatFails) {
    fail_each_call([this] { return look(); }, DiskCall::read);
}

} // namespace
} // namespace linefeed::spool
