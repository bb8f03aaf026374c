// The spool on a disk that fails: what was acknowledged stays, what was not is not pretended, and nothing is retried.
#include "faulty_vfs.hpp"
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;

class SpoolFaultsTest : public SpoolTest {
protected:
    void SetUp() override {
        SpoolTest::SetUp();
        faulty_vfs::install();
        disk_faults() = {};
    }
    void TearDown() override {
        disk_faults() = {};
        SpoolTest::TearDown();
    }
    /// In memory where possible: the faults are ours, and hundreds of real syncs would only take time.
    [[nodiscard]] std::filesystem::path base_directory() const override {
        return std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : SpoolTest::base_directory();
    }
    Result<Spool> try_open_faulty() {
        return Spool::open(path, {[this] { return now_ns; }, faulty_vfs::name});
    }
    static void fail_from_now_on(int write_code = SQLITE_FULL) {
        disk_faults() = {};
        disk_faults().fail_at = 0;
        disk_faults().persists = true;
        disk_faults().write_code = write_code;
    }
};

TEST_F(SpoolFaultsTest, shouldStayAtWhatIsDurableWhenAnAppendFails) {
    auto spool = try_open_faulty();
    const Job job = make_job(*spool);
    const RunId run = spool->begin_run(job.id, job.records, "{}").value();
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 10), ""}}));
    const LedgerState durable = spool->ledger_state(job.id).value();
    fail_from_now_on();
    const auto failed = append(*spool, job.id, {{LedgerKind::intent, run, range(11, 20), ""}});
    ASSERT_FALSE(failed.has_value());
    EXPECT_EQ(failed.error().kind, FailureKind::storage);
    EXPECT_THAT(failed.error().message, HasSubstr("the disk is full (SQLITE_FULL)"));
    EXPECT_EQ(spool->ledger_state(job.id).value(), durable);
    EXPECT_EQ(spool->ledger_rows(job.id, 0, 10).value().size(), 2U);
}

TEST_F(SpoolFaultsTest, shouldTakeNoMoreWritesAfterAFailedAppendUntilItIsReopened) {
    std::optional<Spool> spool{try_open_faulty().value()};
    const Job job = make_job(*spool);
    const RunId run = spool->begin_run(job.id, job.records, "{}").value();
    fail_from_now_on();
    ASSERT_FALSE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 10), ""}}));
    disk_faults() = {}; // the disk has space again, but what it holds is not known
    const auto again = append(*spool, job.id, {{LedgerKind::intent, run, range(1, 10), ""}});
    ASSERT_FALSE(again.has_value());
    EXPECT_THAT(again.error().message, HasSubstr("takes no more writes until linefeed is started again, because: "));
    EXPECT_THAT(again.error().message, HasSubstr("the disk is full"));
    EXPECT_FALSE(spool->append(job.id, {}));
    EXPECT_FALSE(spool->append_together({}));
    EXPECT_FALSE(spool->begin_run(job.id, job.records, "{}"));
    EXPECT_FALSE(spool->begin_import(spec()));
    EXPECT_FALSE(spool->update_source(job.id, spec().source));
    EXPECT_FALSE(spool->remove_job(job.id));
    EXPECT_FALSE(spool->checkpoint());
    EXPECT_TRUE(spool->read_page(job.id, RecordNumber{1})); // reading goes on
    EXPECT_EQ(spool->verify_ledger().value(), 1);
    spool.reset();
    EXPECT_EQ(disk_faults().calls, 0) << "something was written after the failure";
    spool.emplace(open());
    EXPECT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 10), ""}}));
}

TEST_F(SpoolFaultsTest, shouldNotRetryAFailedSync) {
    auto spool = try_open_faulty();
    const Job job = make_job(*spool);
    const RunId run = spool->begin_run(job.id, job.records, "{}").value();
    disk_faults() = {};
    ASSERT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 1), ""}}));
    const long calls = disk_faults().calls; // of one append: the last of them is the sync
    disk_faults() = {};
    disk_faults().fail_at = calls - 1;
    const auto failed = append(*spool, job.id, {{LedgerKind::intent, run, range(2, 2), ""}});
    ASSERT_FALSE(failed.has_value());
    EXPECT_THAT(failed.error().message, HasSubstr("fsync failed"));
    EXPECT_EQ(disk_faults().failed, 1);
    const long after_failure = disk_faults().calls;
    EXPECT_FALSE(append(*spool, job.id, {{LedgerKind::intent, run, range(2, 2), ""}}));
    EXPECT_EQ(disk_faults().calls, after_failure);
}

TEST_F(SpoolFaultsTest, shouldGiveUpAnImportOnAFullDiskAndGoOn) {
    auto spool = try_open_faulty();
    const Job job = make_job(*spool);
    const RunId run = spool->begin_run(job.id, job.records, "{}").value();
    {
        auto import = spool->begin_import(spec());
        disk_faults() = {};
        disk_faults().fail_at = 100;
        disk_faults().persists = true;
        Result<void> added;
        for (std::uint32_t first = 1; added && first < 700'000; first += 5000) {
            added = import->add(page_of(first, 5000));
        }
        ASSERT_FALSE(added.has_value());
        EXPECT_THAT(added.error().message, HasSubstr("the disk is full"));
        EXPECT_EQ(import->commit("").error(), added.error());
        disk_faults() = {};
    }
    EXPECT_EQ(spool->jobs().value().size(), 1U);
    EXPECT_TRUE(append(*spool, job.id, {{LedgerKind::intent, run, range(1, 1), ""}}));
}

/// Import, run, intents, confirmations: each step acknowledged or not.
class ShortLife {
public:
    std::optional<Job> job;
    LedgerState acknowledged; ///< what every acknowledged row comes to
    LedgerState attempted;    ///< and the row that was tried last
    std::optional<Failure> failure;

    void run(Result<Spool> spool) {
        if (!spool) {
            failure = spool.error();
            return;
        }
        auto import = spool->begin_import({{"/data/a.csv", 1, 2, 3, ""}, "{}", {}});
        if (!keep(import) || !keep(import->add(page_of(1, 50))) || !keep(import->add(page_of(51, 50)))) {
            return;
        }
        const auto ready = import->commit("{}");
        if (!keep(ready)) {
            return;
        }
        job = *ready;
        const auto run = spool->begin_run(job->id, job->records, "{}");
        if (!keep(run)) {
            return;
        }
        for (std::uint32_t number = 1; number <= 30; number += 10) {
            if (!append(*spool, {LedgerKind::intent, *run, range(number, number + 9), "{}"}) ||
                !append(*spool, {LedgerKind::printed, *run, range(number, number + 4), "{}"}) ||
                !keep(spool->checkpoint())) {
                return;
            }
        }
        static_cast<void>(append(*spool, {LedgerKind::run_ended, *run, {}, "{}"}));
    }

private:
    template <typename T>
    bool keep(const Result<T>& result) {
        if (!result) {
            failure = result.error();
        }
        return result.has_value();
    }
    bool append(Spool& spool, const LedgerEntry& entry) {
        EXPECT_TRUE(attempted.apply(entry));
        if (!keep(spool.append(job->id, {&entry, 1}))) {
            return false;
        }
        acknowledged = attempted;
        return true;
    }
};

/// Every write and sync of a short life fails in turn.
class EveryFault : public SpoolFaultsTest, public testing::WithParamInterface<std::tuple<int, bool>> {};

TEST_P(EveryFault, shouldLeaveWhatWasAcknowledged) {
    const auto [write_code, persists] = GetParam();
    long faults = 0;
    for (long fail_at = 0;; ++fail_at) {
        path = directory / ("spool-" + std::to_string(fail_at) + ".db");
        disk_faults() = {};
        disk_faults().fail_at = fail_at;
        disk_faults().persists = persists;
        disk_faults().write_code = write_code;
        ShortLife life;
        life.run(try_open_faulty());
        const bool reached = disk_faults().failed > 0;
        disk_faults() = {};
        if (!reached) {
            EXPECT_FALSE(life.failure.has_value());
            break;
        }
        ++faults;
        auto spool = try_open_faulty();
        ASSERT_TRUE(spool.has_value()) << "call " << fail_at << ": " << spool.error().message;
        ASSERT_TRUE(spool->verify_ledger().has_value()) << "call " << fail_at;
        if (!life.job) {
            continue;
        }
        const auto stored = spool->job(life.job->id);
        ASSERT_TRUE(stored.has_value() && stored->has_value()) << "call " << fail_at;
        ASSERT_EQ((*stored)->content_sha256, life.job->content_sha256);
        ASSERT_TRUE(spool->read_page(life.job->id, RecordNumber{75}).has_value());
        const LedgerState state = spool->ledger_state(life.job->id).value();
        ASSERT_TRUE(state == life.acknowledged || state == life.attempted) << "call " << fail_at;
        std::filesystem::remove(path);
    }
    EXPECT_GT(faults, 50);
}

INSTANTIATE_TEST_SUITE_P(Spool, EveryFault,
                         testing::Combine(testing::Values(SQLITE_FULL, SQLITE_IOERR_WRITE), testing::Bool()));

} // namespace
} // namespace linefeed::spool
