#include "spool/schema.hpp"
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

namespace linefeed::spool {
namespace {

using testing::HasSubstr;
using SchemaTest = SpoolTest;

TEST_F(SchemaTest, shouldNumberItsMigrationsWithoutGaps) {
    int expected = 1;
    for (const Migration& migration : migrations()) {
        EXPECT_EQ(migration.version, expected++);
        EXPECT_FALSE(std::string_view{migration.sql}.empty());
    }
    EXPECT_GE(expected, 2);
}

TEST_F(SchemaTest, shouldLeaveTheVersionOfTheLastMigration) {
    { const Spool spool = open(); }
    EXPECT_EQ(sql("PRAGMA user_version"), std::to_string(migrations().size()));
    EXPECT_EQ(sql("PRAGMA application_id"), std::to_string(spool_application_id));
    EXPECT_EQ(sql("PRAGMA integrity_check"), "ok");
}

TEST_F(SchemaTest, shouldRefuseASpoolOfANewerProgram) {
    { const Spool spool = open(); }
    sql("PRAGMA user_version = 99");
    const auto spool = try_open();
    ASSERT_FALSE(spool.has_value());
    EXPECT_EQ(spool.error().kind, FailureKind::storage);
    EXPECT_THAT(spool.error().message, HasSubstr("written by a newer linefeed (schema 99, this program knows"));
}

TEST_F(SchemaTest, shouldRefuseTheDatabaseOfAnotherProgramAndNotTouchIt) {
    sql("CREATE TABLE customers (name TEXT)");
    const auto spool = try_open();
    ASSERT_FALSE(spool.has_value());
    EXPECT_THAT(spool.error().message, HasSubstr("the database of another program"));
    EXPECT_EQ(sql("SELECT count(*) FROM sqlite_schema"), "1");
    EXPECT_EQ(sql("PRAGMA journal_mode"), "delete");
}

TEST_F(SchemaTest, shouldRefuseASpoolWithoutVersion) {
    { const Spool spool = open(); }
    sql("PRAGMA user_version = 0");
    const auto spool = try_open();
    ASSERT_FALSE(spool.has_value());
    EXPECT_THAT(spool.error().message, HasSubstr("no schema version"));
}

TEST_F(SchemaTest, shouldApplyEachMigrationOnceAndNoneIfItIsUpToDate) {
    auto database = Database::open(path.string(), {});
    ASSERT_TRUE(database.has_value());
    ASSERT_EQ(check_schema(**database).value(), 0);
    ASSERT_TRUE(apply_migrations(**database, 0).has_value());
    const int version = check_schema(**database).value();
    EXPECT_EQ(version, static_cast<int>(migrations().size()));
    EXPECT_TRUE(apply_migrations(**database, version).has_value());
    // A second application would fail: its tables exist.
    EXPECT_FALSE(apply_migrations(**database, 0).has_value());
    EXPECT_FALSE((*database)->in_transaction());
}

TEST_F(SchemaTest, shouldTakeOverTheJobsOfTheFirstSchema) {
    {
        auto database = Database::open(path.string(), {});
        ASSERT_TRUE((*database)->execute(migrations().front().sql).has_value());
        ASSERT_TRUE((*database)->execute("PRAGMA user_version = 1").has_value());
    }
    ASSERT_EQ(
        sql("INSERT INTO jobs (source_path, source_size, source_modified_ns, source_inode, source_companion, layout, "
            "base, state, created_ns) VALUES ('/data/names.csv', 1000, 77, 5, '', '{}', 0, 'ready', 1)"),
        "");
    Spool spool = open();
    const auto jobs = spool.jobs();
    ASSERT_EQ(jobs->size(), 1U);
    EXPECT_EQ(jobs->front().spec.source.path, "/data/names.csv");
    EXPECT_EQ(jobs->front().spec.source_sha256, "");
}

} // namespace
} // namespace linefeed::spool
