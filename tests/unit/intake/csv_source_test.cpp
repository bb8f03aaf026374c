#include "intake_fixture.hpp"

namespace linefeed::intake {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using CsvSourceTest = IntakeTest;

SourceOptions columns(std::vector<std::string> names) {
    SourceOptions options;
    options.columns = std::move(names);
    return options;
}

SourceOptions without_header(std::vector<std::string> names = {}) {
    SourceOptions options = columns(std::move(names));
    options.header = false;
    return options;
}

TEST_F(CsvSourceTest, shouldReadAllColumnsBehindTheHeader) {
    auto source = open_source(write("name,city\nMüller,Bonn\nSchulz,Kiel\n"), {});
    ASSERT_TRUE(source.has_value());
    EXPECT_THAT((*source)->column_names(), ElementsAre("name", "city"));
    EXPECT_THAT(rows_of(**source), ElementsAre("2: Müller|Bonn", "3: Schulz|Kiel"));
}

TEST_F(CsvSourceTest, shouldChooseColumnsByNameAndNumber) {
    auto source = open_source(write("name,city,zip\nMüller,Bonn,01067\n"), columns({"zip", "1"}));
    ASSERT_TRUE(source.has_value());
    EXPECT_THAT((*source)->column_names(), ElementsAre("zip", "name"));
    EXPECT_THAT(rows_of(**source), ElementsAre("2: 01067|Müller"));
}

TEST_F(CsvSourceTest, shouldRefuseAnUnknownColumnWithFileAndColumns) {
    const auto file = write("name,city\na,b\n");
    EXPECT_EQ(refusal_of(file, columns({"zip"})),
              (Failure{FailureKind::usage, file.string() + R"(: there is no column "zip", there are "name", "city")"}));
}

TEST_F(CsvSourceTest, shouldReadAFileWithoutHeader) {
    auto source = open_source(write("a,b\nc,d\n"), without_header({"2"}));
    ASSERT_TRUE(source.has_value());
    EXPECT_THAT((*source)->column_names(), ElementsAre("column 2"));
    EXPECT_THAT(rows_of(**source), ElementsAre("1: b", "2: d"));
    EXPECT_THAT(refusal_of(write("a,b\n"), without_header({"3"})).message, HasSubstr("there are 2 without names"));
}

TEST_F(CsvSourceTest, shouldNumberColumnsWithoutName) {
    auto source = open_source(write("a,,c\n1,2,3\n"), {});
    ASSERT_TRUE(source.has_value());
    EXPECT_THAT((*source)->column_names(), ElementsAre("a", "column 2", "c"));
}

TEST_F(CsvSourceTest, shouldFindTheDelimiter) {
    EXPECT_THAT(rows_of(write("a;b\n1,5;2\n")), ElementsAre("2: 1,5|2"));
    EXPECT_THAT(rows_of(write("a\tb\n1,5\t2\n")), ElementsAre("2: 1,5|2"));
    EXPECT_THAT(rows_of(write("name\nSmith, John\n")), ElementsAre("2: Smith, John"));
    EXPECT_THAT(rows_of(write("\xEF\xBB\xBF\"a,x\";b\n1;2\n"), columns({"a,x"})), ElementsAre("2: 1"));
}

TEST_F(CsvSourceTest, shouldUseTheDelimiterAskedFor) {
    SourceOptions options;
    options.delimiter = '|';
    EXPECT_THAT(rows_of(write("a|b,c\n1|2\n"), options), ElementsAre("2: 1|2"));
    for (const char bad : {'"', '\r', '\n', '\0', '\xFC'}) {
        options.delimiter = bad;
        EXPECT_EQ(refusal_of(write("a|b\n1|2\n"), options).kind, FailureKind::usage);
    }
}

TEST_F(CsvSourceTest, shouldReportRowsWithAnotherNumberOfFields) {
    EXPECT_THAT(rows_of(write("a,b,c\n1,2,3,4,5\n1\n1,2,3\n")),
                ElementsAre("2: ! 5 fields instead of 3", "3: ! 1 field instead of 3", "4: 1|2|3"));
}

TEST_F(CsvSourceTest, shouldReportRowsOfBadForm) {
    EXPECT_THAT(rows_of(write("a,b\n\"1\"2,3\n4,5\n")),
                ElementsAre("2: ! text behind the closing quote of a field", "3: 4|5"));
}

TEST_F(CsvSourceTest, shouldReportEmptyLinesInTheMiddleOnly) {
    EXPECT_THAT(
        rows_of(write("a,b\n\n1,2\n\n\r\n3,4\n\n\n\n")),
        ElementsAre("2: ! the line is empty", "3: 1|2", "4: ! the line is empty", "5: ! the line is empty", "6: 3|4"));
    EXPECT_THAT(rows_of(write("a\nx\n\ny\n\n")), ElementsAre("2: x", "3: ! the line is empty", "4: y"));
    EXPECT_THAT(rows_of(write("\n\na\nb\n"), without_header()),
                ElementsAre("1: ! the line is empty", "2: ! the line is empty", "3: a", "4: b"));
}

TEST_F(CsvSourceTest, shouldReportRecordsWithoutAnyText) {
    EXPECT_THAT(rows_of(write("a,b\n,\n,x\n")), ElementsAre("2: ! the record is empty", "3: |x"));
    EXPECT_THAT(rows_of(write("a,b\n,x\ny,\n"), columns({"a"})), ElementsAre("2: ! the record is empty", "3: y"));
    EXPECT_THAT(rows_of(write("a\n\"\"\nx\n")), ElementsAre("2: ! the record is empty", "3: x"));
}

TEST_F(CsvSourceTest, shouldKeepValuesAsText) {
    EXPECT_THAT(rows_of(write("n\n007\n12345678901234567890123\n 1.50 \n")),
                ElementsAre("2: 007", "3: 12345678901234567890123", "4:  1.50 "));
}

TEST_F(CsvSourceTest, shouldGiveTheLineWhereARowBegins) {
    EXPECT_THAT(rows_of(write("a,b\n\"x\ny\",1\nz,2\n")), ElementsAre("2: x\ny|1", "4: z|2"));
}

TEST_F(CsvSourceTest, shouldRefuseAFileWithoutRows) {
    EXPECT_THAT(
        refusal_of(write("name,city\n")),
        (Failure{FailureKind::input, (directory / "source.csv").string() + ": the file has a header but no rows"}));
    EXPECT_THAT(refusal_of(write("name,city\n\n\n")).message, HasSubstr("a header but no rows"));
    EXPECT_THAT(refusal_of(write("\n\n"), without_header()).message, HasSubstr("the file has no rows"));
    EXPECT_THAT(refusal_of(write("\xEF\xBB\xBF")).message, HasSubstr("line 1 is empty"));
    EXPECT_THAT(refusal_of(write("\nname\na\n")).message, HasSubstr("line 1 is empty"));
}

TEST_F(CsvSourceTest, shouldRefuseAHeaderThatCannotBeRead) {
    EXPECT_THAT(refusal_of(write("na\"me,city\na,b\n")).message,
                HasSubstr("the header in line 1 cannot be read: a quote inside"));
    EXPECT_THAT(
        refusal_of(write("a\"b,c\nd,e\n"), without_header()).message,
        HasSubstr(
            "line 1: a quote inside a field that is not quoted (write \"\" inside a quoted field); without header"));
}

TEST_F(CsvSourceTest, shouldRefuseUtf16) {
    const auto file = write(std::string{"\xFF\xFE"
                                        "a\0b\0",
                                        6});
    EXPECT_EQ(refusal_of(file),
              (Failure{FailureKind::input, file.string() + ": the file is UTF-16: save it as UTF-8"}));
}

TEST_F(CsvSourceTest, shouldRefuseTheOptionsOfDatabases) {
    SourceOptions options;
    options.table = "t";
    EXPECT_EQ(refusal_of(write("a\nb\n"), options).kind, FailureKind::usage);
    options.table.reset();
    options.query = "SELECT 1";
    EXPECT_EQ(refusal_of(write("a\nb\n"), options).kind, FailureKind::usage);
}

TEST_F(CsvSourceTest, shouldShowItsProgress) {
    std::string text = "a\n";
    for (int i = 0; i < 100; ++i) {
        text += "row\n";
    }
    auto source = open_source(write(text), {});
    ASSERT_TRUE(source.has_value());
    Row row;
    double before = -1;
    while ((*source)->next(row).value()) {
        EXPECT_GT((*source)->progress(), before - 1e-9);
        before = (*source)->progress();
    }
    EXPECT_DOUBLE_EQ((*source)->progress(), 1.0);
    EXPECT_FALSE((*source)->next(row).value()); // and stays at the end
}

} // namespace
} // namespace linefeed::intake
