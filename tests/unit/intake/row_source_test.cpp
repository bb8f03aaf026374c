#include "intake_fixture.hpp"

#include <chrono>
#include <sys/stat.h>
#include <unistd.h>

namespace linefeed::intake {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

using RowSourceTest = IntakeTest;

TEST_F(RowSourceTest, shouldRefuseWhatIsNotAReadableFile) {
    const auto expect_refused = [](const std::filesystem::path& file, const std::string& words) {
        EXPECT_EQ(refusal_of(file), (Failure{FailureKind::input, file.string() + ": " + words}));
        const auto print = fingerprint(file);
        ASSERT_FALSE(print.has_value());
        EXPECT_EQ(print.error(), refusal_of(file));
    };
    expect_refused(directory / "missing.csv", "there is no such file");
    expect_refused(directory, "this is a directory, not a file");
    expect_refused(write(""), "the file is empty");
    const auto pipe = directory / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    expect_refused(pipe, "this is a pipe or a device: a source must be a file, so that it can be recognised later");
    expect_refused("/dev/null",
                   "this is a pipe or a device: a source must be a file, so that it can be recognised later");
    const auto below_a_file = write("x") / "y";
    EXPECT_THAT(refusal_of(below_a_file).message, HasSubstr("Not a directory"));
}

TEST_F(RowSourceTest, shouldRefuseAFileWithoutPermission) {
    if (::geteuid() == 0) {
        GTEST_SKIP() << "root may read everything";
    }
    const auto file = write("a\nb\n");
    ASSERT_EQ(::chmod(file.c_str(), 0), 0);
    EXPECT_THAT(refusal_of(file).message, HasSubstr("no permission to read it"));
}

TEST_F(RowSourceTest, shouldTellADatabaseByItsBeginning) {
    EXPECT_EQ(rows_of(database("CREATE TABLE t (x); INSERT INTO t VALUES ('a')")), std::vector<std::string>{"1: a"});
    EXPECT_EQ(rows_of(write("SQLite format 3\nb\n")), std::vector<std::string>{"2: b"}); // text, not the 16 bytes
}

TEST_F(RowSourceTest, shouldNotTakeTheNameOfAFileForAnUri) {
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(directory);
    std::filesystem::copy(database("CREATE TABLE t (x); INSERT INTO t VALUES ('a')"), "file:db?mode=memory");
    EXPECT_EQ(rows_of("file:db?mode=memory"), std::vector<std::string>{"1: a"});
    std::filesystem::current_path(before);
}

TEST_F(RowSourceTest, shouldRecogniseAnUnchangedFile) {
    const auto file = write("a\nb\n");
    const auto first = fingerprint(file).value();
    EXPECT_EQ(first.path, std::filesystem::canonical(file));
    EXPECT_EQ(first.size_bytes, 4U);
    EXPECT_GT(first.modified_ns, 1'600'000'000'000'000'000);
    EXPECT_NE(first.inode, 0U);
    EXPECT_EQ(first.companion, "");
    EXPECT_EQ(fingerprint(file).value(), first);
    EXPECT_EQ(fingerprint(directory / "." / "source.csv").value(), first);
    std::filesystem::create_symlink(file, directory / "link");
    EXPECT_EQ(fingerprint(directory / "link").value(), first);
}

TEST_F(RowSourceTest, shouldMakeTheFingerprintAbsolute) {
    write("a\nb\n");
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(directory);
    EXPECT_EQ(fingerprint("source.csv").value().path, std::filesystem::canonical(directory / "source.csv"));
    std::filesystem::current_path(before);
}

TEST_F(RowSourceTest, shouldNoticeEveryChangeOfAFile) {
    const auto file = write("a\nb\n");
    const auto first = fingerprint(file).value();
    const auto time = std::filesystem::last_write_time(file);
    std::filesystem::last_write_time(file, time + std::chrono::nanoseconds{1000});
    EXPECT_NE(fingerprint(file).value(), first);
    std::filesystem::last_write_time(file, time);
    EXPECT_EQ(fingerprint(file).value(), first);
    std::filesystem::copy(file, directory / "copy");
    std::filesystem::rename(directory / "copy", file); // same bytes, another file
    std::filesystem::last_write_time(file, time);
    EXPECT_NE(fingerprint(file).value(), first);
}

TEST_F(RowSourceTest, shouldNoticeAChangeInTheWalOfADatabase) {
    const auto file = directory / "db.sqlite";
    sqlite3* connection = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &connection), SQLITE_OK);
    const auto run = [&](const char* sql) {
        ASSERT_EQ(sqlite3_exec(connection, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    };
    run("PRAGMA journal_mode = WAL; CREATE TABLE t (x); PRAGMA wal_checkpoint(TRUNCATE)");
    const auto first = fingerprint(file).value();
    EXPECT_EQ(first.companion, ""); // an empty WAL holds nothing
    run("INSERT INTO t VALUES (1)");
    const auto second = fingerprint(file).value();
    EXPECT_THAT(second.companion, MatchesRegex("[0-9]+:[0-9]+:[0-9]+"));
    EXPECT_EQ(second.size_bytes, first.size_bytes);
    run("INSERT INTO t VALUES (2)");
    EXPECT_NE(fingerprint(file).value(), second);
    sqlite3_close(connection);
}

TEST_F(RowSourceTest, shouldHaveTheSameFingerprintAfterReading) {
    const auto file = database("PRAGMA journal_mode = WAL; CREATE TABLE t (x); INSERT INTO t VALUES ('a')");
    const auto first = fingerprint(file).value();
    EXPECT_EQ(rows_of(file), std::vector<std::string>{"1: a"});
    EXPECT_EQ(fingerprint(file).value(), first);
}

TEST_F(RowSourceTest, shouldNotLookForAWalBesideATextFile) {
    const auto file = write("a\nb\n");
    write("x", "source.csv-wal");
    EXPECT_EQ(fingerprint(file).value().companion, "");
}

} // namespace
} // namespace linefeed::intake
