#include "spool/schema.hpp"
#include "spool_fixture.hpp"

#include <gmock/gmock.h>

#include <chrono>

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

/// A ledger as linefeed wrote it before `reprint` was known, hashes included.
TEST_F(SchemaTest, shouldTakeOverTheLedgerWithItsChain) {
    {
        auto database = Database::open(path.string(), {}).value();
        for (const Migration& migration : migrations().first(2)) {
            ASSERT_TRUE(database->execute(migration.sql).has_value());
        }
        ASSERT_TRUE(database->execute("PRAGMA user_version = 2").has_value());
    }
    ASSERT_EQ(
        sql("INSERT INTO jobs VALUES (1, '/data/names.csv', 1000, 77, 5, '', '{}', 0, 'ready', 10, 1, 'x', 1, '', '')"),
        "");
    const std::vector<LedgerEntry> entries{{LedgerKind::run_started, RunId{1}, range(1, 10), "{}"},
                                           {LedgerKind::intent, RunId{1}, range(1, 10), ""},
                                           {LedgerKind::printed, RunId{1}, range(1, 10), "it's so"},
                                           {LedgerKind::run_ended, RunId{1}, {}, ""}};
    std::string hash(64, '0');
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const LedgerEntry& entry = entries[i];
        const auto sequence = static_cast<std::int64_t>(i + 1);
        hash = ledger_hash(hash, sequence, JobId{1}, entry, 5);
        const std::string quoted = i == 2 ? "it''s so" : entry.evidence;
        ASSERT_EQ(sql("INSERT INTO ledger VALUES (" + std::to_string(sequence) + ", 1, '" +
                      std::string{to_string(entry.kind)} + "', 1, " + std::to_string(entry.range.first().value()) +
                      ", " + std::to_string(entry.range.count().value()) + ", '" + quoted + "', 5, x'" + hash + "')"),
                  "");
    }
    ASSERT_EQ(sql("INSERT INTO ledger_segments VALUES (1, 1, 10, 'printed', 1)"), "");

    Spool spool = open();
    EXPECT_EQ(spool.verify_ledger().value(), 4);
    const LedgerEntry again{LedgerKind::reprint, RunId{1}, range(3, 4), R"({"reason":"smudged"})"};
    ASSERT_TRUE(spool.append(JobId{1}, {&again, 1}));
    EXPECT_EQ(spool.verify_ledger().value(), 5);
    EXPECT_EQ(spool.ledger_state(JobId{1})->next_printable(range(1, 10)), range(3, 4));
    EXPECT_THAT(sql("UPDATE ledger SET run = 2"), HasSubstr("append-only"));
    EXPECT_THAT(sql("DELETE FROM ledger"), HasSubstr("append-only"));
    EXPECT_THAT(sql("INSERT INTO ledger SELECT 9, job, kind, run, first, records, evidence, time_ns, hash FROM ledger "
                    "WHERE sequence = 1"),
                HasSubstr("append-only"));
    EXPECT_EQ(sql("PRAGMA foreign_key_check"), "");
    EXPECT_EQ(sql("PRAGMA integrity_check"), "ok");
}

/// Months of printing: the copy must not take longer for each row the more rows there are.
TEST_F(SchemaTest, shouldTakeOverALargeLedgerInATimeThatGrowsWithItOnly) {
    {
        auto database = Database::open(path.string(), {}).value();
        for (const Migration& migration : migrations().first(2)) {
            ASSERT_TRUE(database->execute(migration.sql).has_value());
        }
        ASSERT_TRUE(database->execute("PRAGMA user_version = 2").has_value());
    }
    ASSERT_EQ(
        sql("INSERT INTO jobs VALUES (1, '/data/names.csv', 1000, 77, 5, '', '{}', 0, 'ready', 10, 1, 'x', 1, '', '')"),
        "");
    ASSERT_EQ(
        sql("WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n WHERE i < 60000) "
            "INSERT INTO ledger SELECT i, 1, iif(i % 1000 = 1, 'run_started', 'printed'), i - (i - 1) % 1000, 1, 1, "
            "'{}', 5, zeroblob(32) FROM n"),
        "");
    const auto begun = std::chrono::steady_clock::now();
    { const Spool spool = open(); }
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds{20}); // it takes 0.3 s
    EXPECT_EQ(sql("SELECT count(*) FROM ledger"), "60000");
    EXPECT_EQ(sql("PRAGMA foreign_key_check"), "");
}

/// Files that go on with records of jobs from before first records were written down.
TEST_F(SchemaTest, shouldMakeUpForWhatIsKnownOfTheRecordsOfJobsFromBefore) {
    {
        Spool spool = open();
        static_cast<void>(make_job(spool, 30));
        static_cast<void>(make_job(spool, 10, 22117));
        static_cast<void>(make_job(spool, 10, 500));
    }
    ASSERT_EQ(sql("UPDATE pages SET crc = crc + 1 WHERE job = 3"), "") << "a damaged one holds up nothing";
    ASSERT_EQ(sql("UPDATE pages SET frames = CAST(frames || x'5C' AS BLOB) WHERE job = 1 AND first = 11"), "");
    ASSERT_EQ(sql("DROP TABLE job_heads; DROP TABLE printers; DROP TABLE printer_memory; DROP INDEX "
                  "pages_with_escapes; PRAGMA user_version = 3"),
              "");

    Spool spool = open();
    EXPECT_EQ(sql("PRAGMA user_version"), std::to_string(migrations().size()));
    const auto found = [&spool](std::uint32_t number) {
        return spool.find_by_first_record(page_of(number, 1).frames).value().size();
    };
    EXPECT_EQ(found(1), 1U);
    EXPECT_EQ(found(22118), 1U);
    EXPECT_EQ(found(2), 0U);
    EXPECT_EQ(found(501), 0U);
    EXPECT_TRUE(spool.has_escapes(JobId{1}).value());
    EXPECT_FALSE(spool.has_escapes(JobId{2}).value());
}

TEST_F(SchemaTest, shouldEnforceForeignKeysAfterAMigration) {
    auto database = Database::open(path.string(), {}).value();
    ASSERT_TRUE(database->execute("PRAGMA foreign_keys = ON").has_value());
    ASSERT_TRUE(apply_migrations(*database, 0).has_value());
    EXPECT_EQ(database->query_number("PRAGMA foreign_keys").value(), 1);
    EXPECT_FALSE(database->execute("INSERT INTO ledger_segments VALUES (7, 1, 1, 'open', 1)").has_value());
}

} // namespace
} // namespace linefeed::spool
