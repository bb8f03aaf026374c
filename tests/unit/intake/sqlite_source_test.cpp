#include "intake_fixture.hpp"

namespace linefeed::intake {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using SqliteSourceTest = IntakeTest;

SourceOptions table(const std::string& name, std::vector<std::string> columns = {}) {
    SourceOptions options;
    options.table = name;
    options.columns = std::move(columns);
    return options;
}

SourceOptions query(const std::string& sql, std::vector<std::string> columns = {}) {
    SourceOptions options;
    options.query = sql;
    options.columns = std::move(columns);
    return options;
}

constexpr const char* people = "CREATE TABLE people (name TEXT, City TEXT);"
                               "INSERT INTO people VALUES ('c', 'x'), ('a', 'y'), ('b', 'z');";

TEST_F(SqliteSourceTest, shouldReadTheOnlyTableInTheOrderOfItsRows) {
    auto source = open_source(database(people), {});
    ASSERT_TRUE(source.has_value());
    EXPECT_THAT((*source)->column_names(), ElementsAre("name", "City"));
    EXPECT_THAT(rows_of(**source), ElementsAre("1: c|x", "2: a|y", "3: b|z"));
}

TEST_F(SqliteSourceTest, shouldKeepTheOrderOfRowsEvenIfAnIndexWouldBeFaster) {
    const auto file = database(std::string{people} + "CREATE INDEX by_name ON people (name); ANALYZE");
    EXPECT_THAT(rows_of(file, table("people", {"name"})), ElementsAre("1: c", "2: a", "3: b"));
}

TEST_F(SqliteSourceTest, shouldChooseTablesAndColumnsWithoutRegardToCase) {
    auto source = open_source(database(people), table("PEOPLE", {"CITY", "1"}));
    ASSERT_TRUE(source.has_value());
    EXPECT_THAT((*source)->column_names(), ElementsAre("City", "name"));
    EXPECT_THAT(rows_of(**source), ElementsAre("1: x|c", "2: y|a", "3: z|b"));
}

TEST_F(SqliteSourceTest, shouldGiveAColumnTwiceIfItIsAskedForTwice) {
    const auto file = database("CREATE TABLE t (a, b); INSERT INTO t VALUES (1, 2.5)");
    EXPECT_THAT(rows_of(file, table("t", {"b", "a", "b"})), ElementsAre("1: 2.5|1|2.5"));
    EXPECT_THAT(rows_of(file, query("SELECT * FROM t", {"b", "a", "b"})), ElementsAre("1: 2.5|1|2.5"));
}

TEST_F(SqliteSourceTest, shouldReadNamesThatNeedQuotes) {
    const auto file = database(R"(CREATE TABLE "my ""table"" --" ("a b" TEXT, "select" TEXT, "x""y" TEXT);)"
                               R"(INSERT INTO "my ""table"" --" VALUES ('1', '2', '3');)");
    EXPECT_THAT(rows_of(file, table("my \"table\" --", {"select", "x\"y", "a b"})), ElementsAre("1: 2|3|1"));
}

TEST_F(SqliteSourceTest, shouldNotTakeAColumnCalledRowidForTheRowNumber) {
    const auto file = database("CREATE TABLE t (rowid TEXT); INSERT INTO t VALUES ('z'), ('y'), ('x')");
    EXPECT_THAT(rows_of(file), ElementsAre("1: z", "2: y", "3: x"));
    const auto all =
        database("CREATE TABLE u (rowid TEXT, _ROWID_ TEXT, oid TEXT); INSERT INTO u VALUES (2, 2, 2), (1, 1, 1)");
    EXPECT_THAT(rows_of(all, table("u", {"oid"})), ElementsAre("1: 2", "2: 1"));
}

TEST_F(SqliteSourceTest, shouldReadTablesWithoutRowidInTheOrderOfTheirKey) {
    const auto file = database("CREATE TABLE t (a TEXT, b TEXT, c TEXT, PRIMARY KEY (c, a)) WITHOUT ROWID;"
                               "INSERT INTO t VALUES ('2', 'x', '1'), ('1', 'y', '1'), ('0', 'z', '2')");
    EXPECT_THAT(rows_of(file, table("t", {"b"})), ElementsAre("1: y", "2: x", "3: z"));
}

TEST_F(SqliteSourceTest, shouldReadViewsAsTheyAre) {
    const auto file =
        database(std::string{people} + "CREATE VIEW v AS SELECT upper(name) AS n FROM people ORDER BY name DESC");
    EXPECT_THAT(rows_of(file, table("v")), ElementsAre("1: C", "2: B", "3: A"));
}

TEST_F(SqliteSourceTest, shouldReadGeneratedColumns) {
    const auto file = database("CREATE TABLE t (a TEXT, b TEXT AS (a || '!')); INSERT INTO t (a) VALUES ('x')");
    EXPECT_THAT(rows_of(file), ElementsAre("1: x|x!"));
}

TEST_F(SqliteSourceTest, shouldReadWhatIsStillInTheWal) {
    const auto file = directory / "db.sqlite";
    sqlite3* writer = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &writer), SQLITE_OK);
    const auto run = [&](const char* sql) {
        ASSERT_EQ(sqlite3_exec(writer, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    };
    run("PRAGMA journal_mode = WAL; CREATE TABLE t (x); INSERT INTO t VALUES ('a'), ('b')");
    auto source = open_source(file, {});
    ASSERT_TRUE(source.has_value());
    Row row;
    ASSERT_TRUE((*source)->next(row).value());
    run("UPDATE t SET x = 'changed'"); // the reader stays with the moment when it began
    EXPECT_THAT(rows_of(**source), ElementsAre("2: b"));
    sqlite3_close(writer);
}

TEST_F(SqliteSourceTest, shouldNameWhatExistsIfATableOrColumnDoesNot) {
    const auto file = database(std::string{people} + "CREATE TABLE other (x)");
    EXPECT_EQ(
        refusal_of(file, table("persons")),
        (Failure{FailureKind::usage, file.string() + R"(: there is no table "persons", there are "other", "people")"}));
    EXPECT_EQ(refusal_of(file, table("people", {"zip"})),
              (Failure{FailureKind::usage, file.string() + R"(, table "people": there is no column "zip", there are )"
                                                           R"("name", "City")"}));
    EXPECT_EQ(refusal_of(file),
              (Failure{FailureKind::usage, file.string() + R"(: choose one of its tables with --table: )"
                                                           R"("other", "people")"}));
}

TEST_F(SqliteSourceTest, shouldRefuseADatabaseWithoutTables) {
    EXPECT_THAT(refusal_of(database("PRAGMA user_version = 1")),
                (Failure{FailureKind::input, (directory / "db.sqlite").string() + ": the database has no tables"}));
}

TEST_F(SqliteSourceTest, shouldReadAQuery) {
    auto source =
        open_source(database(people), query("SELECT City || '-' || name AS label, 7 FROM people ORDER BY name"));
    ASSERT_TRUE(source.has_value());
    EXPECT_THAT((*source)->column_names(), ElementsAre("label", "7"));
    EXPECT_THAT(rows_of(**source), ElementsAre("1: y-a|7", "2: z-b|7", "3: x-c|7"));
}

TEST_F(SqliteSourceTest, shouldChooseAmongTheColumnsOfAQuery) {
    const auto file = database(people);
    EXPECT_THAT(rows_of(file, query("SELECT *, 'k' AS k FROM people LIMIT 1;", {"K", "1"})), ElementsAre("1: k|c"));
    EXPECT_EQ(refusal_of(file, query("SELECT name FROM people", {"city"})),
              (Failure{FailureKind::usage,
                       file.string() + R"(, result of the query: there is no column "city", there are "name")"}));
}

TEST_F(SqliteSourceTest, shouldTakeEverythingThatIsOneSelect) {
    const auto file = database(people);
    EXPECT_THAT(
        rows_of(file, query("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT 2) SELECT i FROM n")),
        ElementsAre("1: 1", "2: 2"));
    EXPECT_THAT(rows_of(file, query("VALUES ('x')")), ElementsAre("1: x"));
    EXPECT_THAT(rows_of(file, query("SELECT 1; -- the end\n ; /* really */ ")), ElementsAre("1: 1"));
}

TEST_F(SqliteSourceTest, shouldRefuseEverythingThatIsNotOneSelect) {
    const auto file = database(people);
    for (const char* sql :
         {"DELETE FROM people", "INSERT INTO people VALUES ('1', '2') RETURNING name", "PRAGMA user_version",
          "SELECT 1; SELECT 2", "SELECT 1; DROP TABLE people", "SELECT 1; nonsense", "EXPLAIN SELECT 1",
          "ATTACH 'x' AS y", "CREATE TEMP TABLE t (x)", "BEGIN", "SELECT * FROM pragma_table_info('people')"}) {
        const Failure failure = refusal_of(file, query(sql));
        EXPECT_EQ(failure.kind, FailureKind::usage) << sql;
        EXPECT_THAT(failure.message, HasSubstr("the query is refused: it must be a single SELECT")) << sql;
    }
    EXPECT_THAT(refusal_of(file, query("")).message, HasSubstr("it is empty"));
    EXPECT_THAT(refusal_of(file, query(" -- nothing")).message, HasSubstr("it is empty"));
    EXPECT_THAT(refusal_of(file, query("SELECT ?")).message, HasSubstr("parameters without a value"));
    EXPECT_THAT(refusal_of(file, query("SELEC 1")).message, HasSubstr("syntax error"));
    EXPECT_THAT(refusal_of(file, query("SELECT nix FROM people")).message, HasSubstr("no such column: nix"));
}

TEST_F(SqliteSourceTest, shouldNotPrintAMisspeltColumnAsText) {
    EXPECT_THAT(refusal_of(database(people), query(R"(SELECT "nmae" FROM people)")).message,
                HasSubstr("no such column: nmae"));
}

TEST_F(SqliteSourceTest, shouldRefuseOptionsThatDoNotFit) {
    const auto file = database(people);
    SourceOptions both = table("people");
    both.query = "SELECT 1";
    EXPECT_EQ(refusal_of(file, both).kind, FailureKind::usage);
    SourceOptions delimiter;
    delimiter.delimiter = ',';
    EXPECT_EQ(refusal_of(file, delimiter).kind, FailureKind::usage);
    SourceOptions no_header;
    no_header.header = false;
    EXPECT_EQ(refusal_of(file, no_header).kind, FailureKind::usage);
}

TEST_F(SqliteSourceTest, shouldSayThatAnotherProgramHasLockedIt) {
    const auto file = database(people);
    sqlite3* other = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &other), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(other, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr), SQLITE_OK);
    EXPECT_EQ(refusal_of(file),
              (Failure{FailureKind::input, file.string() + ": the file is locked by another program (SQLITE_BUSY)"}));
    sqlite3_close(other);
}

TEST_F(SqliteSourceTest, shouldRefuseADamagedDatabase) {
    const auto file = write(std::string{"SQLite format 3\0", 16} + std::string(5000, '\x7F'), "db.sqlite");
    const Failure failure = refusal_of(file);
    EXPECT_EQ(failure.kind, FailureKind::input);
    EXPECT_THAT(failure.message, HasSubstr("the file is not an SQLite database"));
    EXPECT_THAT(refusal_of(write(std::string{"SQLite format 3\0", 16}, "db.sqlite")).message,
                HasSubstr("not an SQLite"));
}

TEST_F(SqliteSourceTest, shouldFailWhereADamagedTableBreaksOff) {
    std::string sql = "CREATE TABLE t (x TEXT);";
    for (int i = 0; i < 50; ++i) {
        sql += "INSERT INTO t VALUES ('" + std::string(1000, 'x') + "');";
    }
    const auto file = database(sql);
    std::fstream stream{file, std::ios::in | std::ios::out | std::ios::binary};
    stream.seekp(8 * 4096); // a leaf in the middle of the table
    stream << std::string(4096, '\x55');
    stream.close();
    const auto rows = rows_of(file);
    ASSERT_LT(rows.size(), 50U);
    EXPECT_THAT(rows.back(), HasSubstr("failed: " + file.string() + ": the file is damaged (SQLITE_CORRUPT)"));
}

TEST_F(SqliteSourceTest, shouldShowItsProgress) {
    auto source = open_source(database(people), {});
    ASSERT_TRUE(source.has_value());
    Row row;
    ASSERT_TRUE((*source)->next(row).value());
    EXPECT_NEAR((*source)->progress(), 1.0 / 3, 1e-9);
    rows_of(**source);
    EXPECT_DOUBLE_EQ((*source)->progress(), 1.0);
    EXPECT_FALSE((*source)->next(row).value());
    auto unknown = open_source(database(""), query("SELECT 1"));
    ASSERT_TRUE((*unknown)->next(row).value());
    EXPECT_DOUBLE_EQ((*unknown)->progress(), 0.0);
}

} // namespace
} // namespace linefeed::intake
