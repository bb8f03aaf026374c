#include "spool/database.hpp"
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;

class DatabaseTest : public SpoolTest {
protected:
    std::unique_ptr<Database> open_database() {
        auto database = Database::open(path.string(), {});
        EXPECT_TRUE(database.has_value());
        return std::move(database).value();
    }
};

TEST_F(DatabaseTest, shouldBindAndReadNumbersTextAndBlobs) {
    const auto database = open_database();
    const std::string bytes{"a\0\xFF", 3};
    auto statement = database->prepare("SELECT ?1, ?2, ?3, typeof(?2), typeof(?3)");
    ASSERT_TRUE(statement.has_value());
    statement->bind(1, std::int64_t{-5}).bind(2, std::string_view{}).bind_blob(3, bytes);
    ASSERT_TRUE(statement->step().value());
    EXPECT_EQ(statement->number(0), -5);
    EXPECT_EQ(statement->text(1), "");
    EXPECT_EQ(statement->blob(2), bytes);
    EXPECT_EQ(statement->text(3), "text"); // empty is not NULL
    EXPECT_EQ(statement->text(4), "blob");
    EXPECT_FALSE(statement->step().value());
}

TEST_F(DatabaseTest, shouldKeepAStatementForItsNextUse) {
    const auto database = open_database();
    constexpr const char* sql_text = "SELECT ?1";
    for (std::int64_t value = 1; value <= 2; ++value) {
        auto statement = database->prepare(sql_text);
        ASSERT_TRUE(statement.has_value());
        ASSERT_TRUE(statement->bind(1, value).step().value());
        EXPECT_EQ(statement->number(0), value);
    }
}

TEST_F(DatabaseTest, shouldReportAFailedBindAtTheNextStep) {
    const auto database = open_database();
    auto statement = database->prepare("SELECT ?1");
    ASSERT_TRUE(statement.has_value());
    EXPECT_FALSE(statement->bind(2, std::int64_t{1}).step().has_value());
}

TEST_F(DatabaseTest, shouldSayWhatIsWrongWithSql) {
    const auto database = open_database();
    const auto done = database->execute("SELECT nix");
    ASSERT_FALSE(done.has_value());
    EXPECT_THAT(done.error().message, HasSubstr("no such column: nix"));
    EXPECT_FALSE(database->prepare("SELEC").has_value());
    EXPECT_FALSE(database->query_number("SELEC").has_value());
}

TEST_F(DatabaseTest, shouldReadSingleValues) {
    const auto database = open_database();
    EXPECT_EQ(database->query_number("SELECT 7").value(), 7);
    EXPECT_EQ(database->query_number("SELECT 7 WHERE 0").value(), 0);
    EXPECT_EQ(database->query_text("SELECT 'seven'").value(), "seven");
    EXPECT_EQ(database->query_text("SELECT NULL").value(), "");
}

TEST_F(DatabaseTest, shouldRollBackATransactionThatIsNotCommitted) {
    const auto database = open_database();
    ASSERT_TRUE(database->execute("CREATE TABLE t (x)").has_value());
    {
        auto transaction = Transaction::begin(*database);
        ASSERT_TRUE(transaction.has_value());
        ASSERT_TRUE(database->execute("INSERT INTO t VALUES (1)").has_value());
    }
    EXPECT_EQ(database->query_number("SELECT count(*) FROM t").value(), 0);
    {
        auto transaction = Transaction::begin(*database);
        ASSERT_TRUE(transaction.has_value());
        ASSERT_TRUE(database->execute("INSERT INTO t VALUES (1)").has_value());
        EXPECT_TRUE(transaction->commit().has_value());
    }
    EXPECT_EQ(database->query_number("SELECT count(*) FROM t").value(), 1);
}

TEST_F(DatabaseTest, shouldNameTheErrorThatTheOperatorCanDoSomethingAbout) {
    EXPECT_EQ(describe_sqlite_error(SQLITE_FULL), "the disk is full (SQLITE_FULL)");
    EXPECT_EQ(describe_sqlite_error(SQLITE_IOERR_FSYNC),
              "the disk did not confirm what was written (fsync failed) (SQLITE_IOERR_FSYNC)");
    EXPECT_EQ(describe_sqlite_error(SQLITE_IOERR_LOCK), "the disk failed (SQLITE_IOERR)");
    EXPECT_EQ(describe_sqlite_error(SQLITE_MISUSE), "bad parameter or other API misuse (SQLite error 21)");
}

TEST_F(DatabaseTest, shouldReportTheFullDiskInOneLine) {
    const auto database = open_database();
    ASSERT_TRUE(database->execute("CREATE TABLE t (x)").has_value());
    ASSERT_TRUE(database->execute("PRAGMA max_page_count = 3").has_value());
    const auto done = database->execute("INSERT INTO t VALUES (zeroblob(100000))");
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error(), (Failure{FailureKind::storage,
                                     path.string() + ": the disk is full (SQLITE_FULL): database or disk is full"}));
    EXPECT_EQ(database->last_error(), SQLITE_FULL);
}

TEST_F(DatabaseTest, shouldTakeAStrangeNameForAFileName) {
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(directory);
    for (const char* name : {":memory:", "file:x?mode=memory"}) {
        auto database = Database::open(name, {});
        ASSERT_TRUE(database.has_value());
        EXPECT_TRUE((*database)->execute("CREATE TABLE t (x)").has_value());
        EXPECT_TRUE(std::filesystem::exists(directory / name));
    }
    std::filesystem::current_path(before);
}

TEST_F(DatabaseTest, shouldFailForAFileSystemItDoesNotKnow) {
    const auto database = Database::open(path.string(), "no-such-vfs");
    ASSERT_FALSE(database.has_value());
    EXPECT_EQ(database.error().kind, FailureKind::storage);
}

} // namespace
} // namespace linefeed::spool
