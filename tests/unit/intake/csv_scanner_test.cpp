#include "intake/csv_scanner.hpp"

#include <gmock/gmock.h>

#include <string>

namespace linefeed::intake {
namespace {

using testing::ElementsAre;

CsvScanner scanned(std::string_view text, CsvDelimiter delimiter = ',') {
    CsvScanner scanner{delimiter};
    std::size_t taken = 0;
    for (const char& byte : text) { // byte by byte: any split must do
        taken += scanner.scan({&byte, 1});
        if (scanner.ended()) {
            break;
        }
    }
    CsvScanner at_once{delimiter};
    EXPECT_EQ(at_once.scan(text), taken);
    EXPECT_EQ(at_once.ended(), scanner.ended());
    EXPECT_EQ(at_once.problem(), scanner.problem());
    EXPECT_EQ(at_once.line_breaks(), scanner.line_breaks());
    return scanner;
}

std::vector<std::string> split(std::string row, CsvDelimiter delimiter = ',') {
    std::vector<std::string_view> fields;
    split_quoted_row(row.data(), row.data() + row.size(), delimiter, fields);
    return {fields.begin(), fields.end()};
}

std::vector<std::string> split_plain(const std::string& row, CsvDelimiter delimiter = ',') {
    std::vector<std::string_view> fields;
    split_plain_row(row, delimiter, fields);
    return {fields.begin(), fields.end()};
}

TEST(CsvScanner, shouldEndARowAtALineBreakOutsideQuotes) {
    EXPECT_TRUE(scanned("a,b\n").ended());
    EXPECT_TRUE(scanned("a,b\r").ended());
    EXPECT_TRUE(scanned("\"a\nb\"\n").ended());
    EXPECT_FALSE(scanned("\"a\nb\"").ended());
    EXPECT_FALSE(scanned("\"a\"\"\nb").ended());
    CsvScanner scanner{','};
    EXPECT_EQ(scanner.scan("\"x\ny\",z\r\nnext"), 7U);
}

TEST(CsvScanner, shouldCountLineBreaksInsideQuotes) {
    EXPECT_EQ(scanned("\"a\nb\rc\r\nd\"\n").line_breaks(), 3U);
    EXPECT_EQ(scanned("\"a\n\nb\r\rc\"\n").line_breaks(), 4U);
    EXPECT_EQ(scanned("\"a\r\"\"\nb\"\n").line_breaks(), 2U); // quotes between CR and LF part them
    EXPECT_EQ(scanned("\"a\r\",\"\nb\"\n").line_breaks(), 2U);
    EXPECT_EQ(scanned("a\n").line_breaks(), 0U);
}

TEST(CsvScanner, shouldFindAQuoteInAPlainField) {
    EXPECT_EQ(scanned("5\" pipe,x\n").problem(), CsvProblem::quote_in_field);
    EXPECT_EQ(scanned("x, \"y\"\n").problem(), CsvProblem::quote_in_field); // a blank before the quote is text
    EXPECT_TRUE(scanned("5\" pipe\n").ended());
}

TEST(CsvScanner, shouldFindTextBehindAQuotedField) {
    EXPECT_EQ(scanned("\"a\"b,c\n").problem(), CsvProblem::text_after_quote);
    EXPECT_EQ(scanned("\"a\" ,c\n").problem(), CsvProblem::text_after_quote);
    EXPECT_EQ(scanned("\"a\"b,\"c\nd\"\n").line_breaks(), 1U); // fields behind the bad one are read as usual
}

TEST(CsvScanner, shouldFindAQuoteThatIsNeverClosed) {
    CsvScanner scanner = scanned("\"a\",\"\n\n");
    EXPECT_EQ(scanner.problem(), CsvProblem::none);
    scanner.end_of_file();
    EXPECT_EQ(scanner.problem(), CsvProblem::quote_not_closed);
    CsvScanner closed = scanned("\"a\"");
    closed.end_of_file();
    EXPECT_EQ(closed.problem(), CsvProblem::none);
    EXPECT_TRUE(closed.ended());
}

TEST(CsvScanner, shouldKnowWhereTheLastQuoteWasOpened) {
    EXPECT_EQ(scanned("\"a\nb\",\"c\n").line_breaks_at_quote(), 1U);
}

TEST(CsvScanner, shouldBeginAnewAfterReset) {
    CsvScanner scanner = scanned("\"a\"b,\"c\n");
    scanner.reset();
    EXPECT_EQ(scanner.problem(), CsvProblem::none);
    EXPECT_EQ(scanner.line_breaks(), 0U);
    EXPECT_EQ(scanner.scan("a,b\n"), 3U);
    EXPECT_TRUE(scanner.ended());
}

TEST(CsvScanner, shouldTakeTheWholeLineWithoutDelimiter) {
    EXPECT_EQ(scanned("a,\"b\n", std::nullopt).problem(), CsvProblem::quote_in_field);
    EXPECT_EQ(scanned("\"a,b\"\n", std::nullopt).problem(), CsvProblem::none);
}

TEST(SplitPlainRow, shouldKeepEmptyFieldsAndBlanks) {
    EXPECT_THAT(split_plain("a, b ,,c,"), ElementsAre("a", " b ", "", "c", ""));
    EXPECT_THAT(split_plain(""), ElementsAre(""));
    EXPECT_THAT(split_plain(","), ElementsAre("", ""));
    EXPECT_THAT(split_plain("a;b,c", ';'), ElementsAre("a", "b,c"));
    EXPECT_THAT(split_plain("a,b", std::nullopt), ElementsAre("a,b"));
}

TEST(SplitQuotedRow, shouldUndoQuotes) {
    EXPECT_THAT(split(R"("a","b,c",d)"), ElementsAre("a", "b,c", "d"));
    EXPECT_THAT(split(R"("say ""hi""",x)"), ElementsAre("say \"hi\"", "x"));
    EXPECT_THAT(split(R"("","""",a,"""""")"), ElementsAre("", "\"", "a", "\"\""));
    EXPECT_THAT(split("\"a\r\nb\",\"\n\""), ElementsAre("a\r\nb", "\n"));
    EXPECT_THAT(split(R"("a",)"), ElementsAre("a", ""));
    EXPECT_THAT(split(R"(,"a")"), ElementsAre("", "a"));
    EXPECT_THAT(split(R"("a,b")", std::nullopt), ElementsAre("a,b"));
    EXPECT_THAT(split(""), ElementsAre(""));
}

TEST(GuessDelimiter, shouldTakeTheMostFrequentOutsideQuotes) {
    EXPECT_EQ(guess_delimiter("a,b;c,d\n").delimiter, ',');
    EXPECT_EQ(guess_delimiter("a;b;c,d\n").delimiter, ';');
    EXPECT_EQ(guess_delimiter("a\tb\n1,2,3,4\n").delimiter, '\t');
    EXPECT_EQ(guess_delimiter("\"a,b,c\";d\n").delimiter, ';');
    EXPECT_EQ(guess_delimiter("a,b;c\n").delimiter, ',');
    EXPECT_EQ(guess_delimiter("\n\r\na;b\n,,,\n").delimiter, ';');
}

TEST(GuessDelimiter, shouldFindNoneInASingleColumn) {
    EXPECT_EQ(guess_delimiter("name\nSmith, John\n").delimiter, std::nullopt);
    EXPECT_EQ(guess_delimiter("\"a,b\"\n").delimiter, std::nullopt);
    EXPECT_EQ(guess_delimiter("").delimiter, std::nullopt);
}

TEST(GuessDelimiter, shouldSayWhetherItSawAWholeRow) {
    EXPECT_TRUE(guess_delimiter("a,b\n").complete);
    EXPECT_FALSE(guess_delimiter("a,b").complete);
    EXPECT_FALSE(guess_delimiter("\"a\n").complete);
    EXPECT_FALSE(guess_delimiter("\n\n").complete);
}

} // namespace
} // namespace linefeed::intake
