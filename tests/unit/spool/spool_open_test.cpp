#include "spool_fixture.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;
using testing::Not;

class SpoolOpenTest : public SpoolTest {
protected:
    void expect_refused(const std::string& words) {
        const auto spool = try_open();
        ASSERT_FALSE(spool.has_value());
        EXPECT_EQ(spool.error().kind, FailureKind::storage);
        EXPECT_THAT(spool.error().message, HasSubstr(words));
        EXPECT_THAT(spool.error().message, Not(HasSubstr("\n")));
    }
};

TEST_F(SpoolOpenTest, shouldCreateTheFileAndItsDirectories) {
    path = directory / "var" / "lib" / "linefeed" / "spool.db";
    Spool spool = open();
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_TRUE(spool.jobs().value().empty());
}

TEST_F(SpoolOpenTest, shouldKeepWhatWasStored) {
    Job job;
    {
        Spool spool = open();
        job = make_job(spool);
    }
    Spool spool = open();
    ASSERT_EQ(spool.jobs().value().size(), 1U);
    EXPECT_EQ(spool.jobs().value().front().content_sha256, job.content_sha256);
}

TEST_F(SpoolOpenTest, shouldRefuseASecondOpenerWhileTheFirstLives) {
    {
        const Spool spool = open();
        expect_refused("is in use by another linefeed (process " + std::to_string(::getpid()) + ")");
    }
    EXPECT_TRUE(try_open().has_value());
}

TEST_F(SpoolOpenTest, shouldStayLockedWhenItMoves) {
    Spool spool = open();
    Spool moved = std::move(spool);
    expect_refused("in use");
    make_job(moved);
    Spool assigned = std::move(moved);
    EXPECT_EQ(assigned.jobs().value().size(), 1U);
}

TEST_F(SpoolOpenTest, shouldRefuseADirectory) {
    path = directory;
    expect_refused("is a directory");
}

TEST_F(SpoolOpenTest, shouldRefuseAFileThatIsNoDatabase) {
    std::ofstream{path} << std::string(5000, 'x');
    expect_refused("the file is not an SQLite database (SQLITE_NOTADB)");
}

TEST_F(SpoolOpenTest, shouldSayThatADirectoryCannotBeCreated) {
    std::ofstream{directory / "file"} << "x";
    path = directory / "file" / "spool.db";
    expect_refused("the directory cannot be created");
}

TEST_F(SpoolOpenTest, shouldRefuseADamagedJobTable) {
    {
        Spool spool = open();
        make_job(spool);
    }
    const long page = std::stol(sql("SELECT rootpage FROM sqlite_schema WHERE name = 'jobs'"));
    std::fstream file{path, std::ios::in | std::ios::out | std::ios::binary};
    file.seekp((page - 1) * 4096);
    file << std::string(200, '\x55');
    file.close();
    expect_refused("damaged");
}

TEST_F(SpoolOpenTest, shouldUseTheSettingsThatKeepWhatIsWritten) {
    Spool spool = open();
    make_job(spool);
    // The WAL was copied, but not by SQLite's own decision; and the file says that it is in WAL mode.
    EXPECT_EQ(sql("PRAGMA journal_mode"), "wal");
}

TEST_F(SpoolOpenTest, shouldRemoveImportsThatWereNotFinished) {
    const pid_t child = ::fork();
    if (child == 0) {
        auto spool = try_open();
        auto import = spool->begin_import(spec());
        // More than one transaction, so that pages are in the file when the process dies.
        for (std::uint32_t first = 1; first < 700'000; first += 5000) {
            if (!import->add(page_of(first, 5000))) {
                ::_exit(2);
            }
        }
        ::_exit(0); // no destructor runs
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    ASSERT_EQ(sql("SELECT state FROM jobs"), "importing");
    ASSERT_NE(sql("SELECT count(*) FROM pages"), "0");
    {
        Spool spool = open();
        EXPECT_TRUE(spool.jobs().value().empty());
    }
    EXPECT_EQ(sql("SELECT count(*) FROM pages"), "0");
    EXPECT_EQ(sql("PRAGMA integrity_check"), "ok");
}

TEST_F(SpoolOpenTest, shouldKeepAcknowledgedRowsWhenItIsKilled) {
    const pid_t child = ::fork();
    if (child == 0) {
        auto spool = try_open();
        const Job job = make_job(*spool);
        const auto run = spool->begin_run(job.id, job.records, "{}");
        const LedgerEntry intent{LedgerKind::intent, *run, range(1, 20), "{}"};
        ::_exit(spool->append(job.id, {&intent, 1}) ? 0 : 2);
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    Spool spool = open();
    EXPECT_EQ(spool.ledger_state(JobId{1}).value().ranges(RecordState::open), std::vector{range(1, 20)});
    EXPECT_EQ(spool.verify_ledger().value(), 2);
}

TEST_F(SpoolOpenTest, shouldCopyTheWalLeftByAnEarlierProcessBeforeAnythingElse) {
    {
        Spool spool = open();
        make_job(spool);
        // A copy of the files as they are now is what a killed process leaves.
        std::filesystem::copy(path, directory / "copy.db");
        std::filesystem::copy(path.string() + "-wal", directory / "copy.db-wal");
    }
    path = directory / "copy.db";
    ASSERT_GT(std::filesystem::file_size(path.string() + "-wal"), 0U);
    Spool spool = open();
    EXPECT_EQ(std::filesystem::file_size(path.string() + "-wal"), 0U);
    EXPECT_EQ(spool.jobs().value().size(), 1U);
}

TEST_F(SpoolOpenTest, shouldCopyTheWalWhenAsked) {
    Spool spool = open();
    const Job job = make_job(spool);
    const auto run = spool.begin_run(job.id, job.records, "{}");
    ASSERT_TRUE(run.has_value());
    ASSERT_TRUE(spool.checkpoint().has_value());
    // The database alone, without its WAL, now has the row.
    std::filesystem::copy(path, directory / "copy.db");
    path = directory / "copy.db";
    EXPECT_EQ(sql("SELECT count(*) FROM ledger"), "1");
}

TEST_F(SpoolOpenTest, shouldTakeTheTimeFromTheSystemWithoutAClock) {
    auto spool = Spool::open(path, {});
    ASSERT_TRUE(spool.has_value());
    EXPECT_GT(make_job(*spool).created_ns, 1'600'000'000'000'000'000);
}

} // namespace
} // namespace linefeed::spool
