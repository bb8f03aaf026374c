// An import that goes on while its records are printed: what is there when, how it ends, and who is woken.
#include "daemon/running_import.hpp"
#include "rows_double.hpp"
#include "support/spool_job.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include <chrono>
#include <functional>
#include <thread>

namespace linefeed::daemon {
namespace {

using spool::ImportState;
using test::closed;
using test::SpoolJobTest;
using testing::HasSubstr;
using testing::IsEmpty;

class RunningImportTest : public SpoolJobTest {
protected:
    void begin(intake::ImportOptions options = {}) {
        import_.emplace(spool_->begin_import(spec_).value(), rows_.source(), spec_, std::move(options));
        job_ = import_->job();
        import_->start();
    }
    void TearDown() override {
        rows_.end(); // the thread must not wait for more
        import_.reset();
        SpoolJobTest::TearDown();
    }
    /// Writes what comes until `enough`; fails after a while.
    void go_on_until(const std::function<bool()>& enough) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{20};
        while (!enough()) {
            ASSERT_LT(std::chrono::steady_clock::now(), deadline);
            if (import_->wants_step()) {
                import_->step();
            } else {
                import_->wait(20);
            }
        }
    }
    void go_on_until_over() {
        go_on_until([this] { return import_->over(); });
    }
    void issue_first_record() {
        const spool::RunId run = spool_->begin_run(job_, closed(1, 1000), "{}").value();
        const spool::LedgerEntry intent{spool::LedgerKind::intent, run, closed(1, 1), {}};
        spool_->append(job_, {&intent, 1}).value();
    }
    spool::Job stored() { return spool_->job(job_).value().value(); }

    spool::JobSpec spec_;
    RowsDouble rows_;
    std::optional<RunningImport> import_;
};

TEST_F(RunningImportTest, shouldGiveRecordsOfASlowSourceBeforeTheirPageIsFull) {
    begin();
    EXPECT_FALSE(import_->end_known());
    EXPECT_EQ(import_->bound(), RecordNumber{1'000'000});
    rows_.give(1);
    rows_.wait_until_read(1);
    EXPECT_FALSE(import_->wants_step()); // and so the reading thread knows that nothing waits to be written
    std::this_thread::sleep_for(std::chrono::milliseconds{30}); // longer than a page waits
    rows_.give(1);
    go_on_until([this] { return !import_->durable().empty(); });
    EXPECT_EQ(import_->durable(), closed(1, 2));
    EXPECT_EQ(spool_->read_page(job_, RecordNumber{2}).value().slice(closed(2, 2)), "^0=MR2\trow 2\r");
    EXPECT_FALSE(import_->end_known());
    EXPECT_FALSE(import_->over());
}

TEST_F(RunningImportTest, shouldMakeTheJobReadyAtTheEndOfTheSource) {
    begin();
    rows_.give(3000);
    rows_.end();
    go_on_until_over();
    EXPECT_TRUE(import_->end_known());
    EXPECT_FALSE(import_->refused());
    EXPECT_EQ(import_->failure(), std::nullopt);
    EXPECT_EQ(import_->durable(), closed(1, 3000));
    EXPECT_EQ(import_->report().records, 3000U);
    EXPECT_FALSE(import_->wants_step());
    EXPECT_EQ(stored().state, ImportState::ready);
    EXPECT_EQ(stored().records, closed(1, 3000));
    EXPECT_THAT(stored().import_report, HasSubstr(R"("rows":3000)"));
}

TEST_F(RunningImportTest, shouldEndBeforeABadRowAndFindTheOtherBadRows) {
    begin();
    rows_.give(10);
    rows_.give(1, "it is bad");
    go_on_until([this] { return import_->end_known(); });
    EXPECT_TRUE(import_->refused());
    EXPECT_EQ(import_->durable(), closed(1, 10)) << "the end is known before the rest is checked";
    EXPECT_FALSE(import_->over());
    rows_.give(5);
    rows_.give(2, "bad as well");
    rows_.end();
    go_on_until_over();
    EXPECT_EQ(import_->report().bad_rows, 3U);
    EXPECT_EQ(import_->report().rows, 18U);
    EXPECT_EQ(import_->report().reported.at(2).line, 18U);
    EXPECT_EQ(stored().state, ImportState::stopped);
    EXPECT_EQ(stored().records, closed(1, 10));
}

TEST_F(RunningImportTest, shouldLeaveBadRowsOutWhereThatIsWanted) {
    intake::ImportOptions options;
    options.skip_bad = true;
    begin(options);
    rows_.give(10);
    rows_.give(1, "it is bad");
    rows_.give(10);
    rows_.end();
    go_on_until_over();
    EXPECT_FALSE(import_->refused());
    EXPECT_EQ(import_->report().bad_rows, 1U);
    EXPECT_EQ(stored().state, ImportState::ready);
    EXPECT_EQ(stored().records, closed(1, 20));
}

TEST_F(RunningImportTest, shouldKeepWhatIsThereWhenTheSourceBreaksOff) {
    begin();
    rows_.give(600);
    go_on_until([this] { return !import_->durable().empty(); });
    issue_first_record();
    rows_.break_off("the disk cannot read it");
    go_on_until_over();
    ASSERT_TRUE(import_->failure());
    EXPECT_EQ(import_->failure()->message, "the disk cannot read it");
    EXPECT_FALSE(import_->end_known());
    EXPECT_FALSE(import_->wants_step());
    const RecordRange durable = import_->durable();
    EXPECT_EQ(durable, closed(1, 512)) << "a page was full";
    import_.reset();
    EXPECT_EQ(stored().state, ImportState::importing);
    EXPECT_EQ(stored().records, durable);
}

TEST_F(RunningImportTest, shouldLeaveNothingWhenItIsGivenUpBeforeAnythingWasPrinted) {
    begin();
    rows_.give(600);
    go_on_until([this] { return !import_->durable().empty(); });
    rows_.end();
    import_.reset();
    EXPECT_EQ(spool_->job(job_).value(), std::nullopt);
}

TEST_F(RunningImportTest, shouldGoOnWithAnImportThatWasBrokenOff) {
    begin();
    rows_.give(600);
    go_on_until([this] { return !import_->durable().empty(); });
    issue_first_record();
    rows_.break_off("");
    import_.reset();

    RowsDouble again;
    again.give(700);
    again.end();
    import_.emplace(spool_->resume_import(stored(), spec_.source).value(), again.source(), spec_,
                    intake::ImportOptions{});
    EXPECT_EQ(import_->durable(), closed(1, 512)) << "before anything is read";
    EXPECT_TRUE(import_->compares());
    import_->start();
    go_on_until_over();
    EXPECT_EQ(import_->failure(), std::nullopt);
    EXPECT_FALSE(import_->compares());
    EXPECT_EQ(stored().records, closed(1, 700));
    import_.reset(); // before its source
}

TEST_F(RunningImportTest, shouldNotHoldMoreThanALittleInMemory) {
    begin();
    rows_.give(400'000); // some 8 MB of frames
    rows_.end();
    std::uint64_t rows = 0;
    for (int quiet = 0; quiet < 20; ++quiet) { // nobody writes
        import_->wait(20);
        quiet = import_->rows() == rows ? quiet : 0;
        rows = import_->rows();
    }
    EXPECT_GT(rows, 4096U);
    EXPECT_LT(rows, 200'000U) << "the reading thread waits";
    go_on_until_over();
    EXPECT_EQ(stored().records, closed(1, 400'000));
}

TEST_F(RunningImportTest, shouldWakeWhoeverServesTheSpool) {
    begin();
    store::EventSignal server;
    import_->wake(&server);
    rows_.give(512);
    server.wait(20'000);
    EXPECT_TRUE(import_->wants_step());
    import_->step();
    EXPECT_EQ(import_->durable(), closed(1, 512));
    import_->wake(nullptr);
    server.clear();
    rows_.give(512);
    go_on_until([this] { return import_->durable().last() == RecordNumber{1024}; }); // its own signal wakes
}

TEST_F(RunningImportTest, shouldFailWhenTheSpoolTakesNoMore) {
    begin();
    rows_.give(512);
    go_on_until([this] { return !import_->durable().empty(); });
    sqlite3* other = nullptr;
    ASSERT_EQ(sqlite3_open((directory_ / "spool.db").c_str(), &other), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(other, "DROP TABLE pages", nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(other);
    rows_.give(512);
    go_on_until_over();
    ASSERT_TRUE(import_->failure());
    EXPECT_EQ(import_->failure()->kind, FailureKind::storage);
}

} // namespace
} // namespace linefeed::daemon
