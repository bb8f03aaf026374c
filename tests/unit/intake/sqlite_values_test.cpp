// What becomes of the values of an SQLite database: exact text, or a bad row with its column.
#include "intake_fixture.hpp"

namespace linefeed::intake {
namespace {

using testing::HasSubstr;

class SqliteValuesTest : public IntakeTest {
protected:
    /// The row that a single value gives.
    std::string row_of(const std::string& value) const {
        const auto file = directory / "db.sqlite";
        if (!std::filesystem::exists(file)) {
            database("CREATE TABLE t (x)");
        }
        SourceOptions options;
        options.query = "SELECT " + value + " AS v";
        const auto rows = rows_of(file, options);
        return rows.size() == 1 ? rows.front() : std::to_string(rows.size()) + " rows";
    }
};

TEST_F(SqliteValuesTest, shouldGiveIntegersExactly) {
    EXPECT_EQ(row_of("0"), "1: 0");
    EXPECT_EQ(row_of("9223372036854775807"), "1: 9223372036854775807");
    EXPECT_EQ(row_of("-9223372036854775807 - 1"), "1: -9223372036854775808");
    EXPECT_EQ(row_of("1000000000000000"), "1: 1000000000000000");
}

TEST_F(SqliteValuesTest, shouldGiveTextAsItIs) {
    EXPECT_EQ(row_of("'007'"), "1: 007");
    EXPECT_EQ(row_of("' Müller '"), "1:  Müller ");
    EXPECT_EQ(row_of("'12345678901234567890'"), "1: 12345678901234567890");
    EXPECT_EQ(row_of("'a' || char(0) || 'b'"), (std::string{"1: a\0b", 6}));
    EXPECT_EQ(row_of("CAST(x'FF41' AS TEXT)"), "1: \xFF"
                                               "A");
}

TEST_F(SqliteValuesTest, shouldGiveRealsThatAreExactlyTheirText) {
    EXPECT_EQ(row_of("1.5"), "1: 1.5");
    EXPECT_EQ(row_of("5.0"), "1: 5.0");
    EXPECT_EQ(row_of("-0.25"), "1: -0.25");
    EXPECT_EQ(row_of("999999999999999.0"), "1: 999999999999999.0");
}

TEST_F(SqliteValuesTest, shouldRefuseRealsThatMayHaveLostDigits) {
    EXPECT_EQ(row_of("1e15"), "1: ! v: the number 1.0e+15 is a REAL and may have lost digits: store it as TEXT");
    EXPECT_THAT(row_of("-1e15"), HasSubstr("may have lost digits"));
    EXPECT_THAT(row_of("12345678901234567890"), HasSubstr("may have lost digits")); // too large for an integer
    EXPECT_THAT(row_of("1e-9"), HasSubstr("may have lost digits"));
    EXPECT_THAT(row_of("9e999"), HasSubstr("may have lost digits"));
}

TEST_F(SqliteValuesTest, shouldRefuseWhatIsNoText) {
    EXPECT_EQ(row_of("NULL"), "1: ! v: the value is NULL (use COALESCE in --query to print something)");
    EXPECT_EQ(row_of("x'41'"), "1: ! v: the value is a BLOB, not text (use CAST … AS TEXT or hex() in --query)");
    EXPECT_EQ(row_of("''"), "1: ! the record is empty");
}

TEST_F(SqliteValuesTest, shouldNameTheColumnAndGoOn) {
    const auto file =
        database("CREATE TABLE t (a, b); INSERT INTO t VALUES ('x', NULL), ('', ''), ('y', ''), (NULL, 'z')");
    EXPECT_EQ(rows_of(file),
              (std::vector<std::string>{"1: ! b: the value is NULL (use COALESCE in --query to print something)",
                                        "2: ! the record is empty", "3: y|",
                                        "4: ! a: the value is NULL (use COALESCE in --query to print something)"}));
}

TEST_F(SqliteValuesTest, shouldConvertUtf16Databases) {
    const auto file = database("PRAGMA encoding = 'UTF-16'; CREATE TABLE t (a); INSERT INTO t VALUES ('Müller €')");
    EXPECT_EQ(rows_of(file), std::vector<std::string>{"1: Müller €"});
}

} // namespace
} // namespace linefeed::intake
