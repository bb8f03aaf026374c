#include "intake/csv_reader.hpp"

#include <gmock/gmock.h>

namespace linefeed::intake {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Gives the text in portions of one size.
CsvReader::ReadBytes portions(const std::string& text, std::size_t portion) {
    return [text, portion, at = std::size_t{0}](std::span<char> out) mutable -> Result<std::size_t> {
        const std::size_t size = std::min({portion, out.size(), text.size() - at});
        text.copy(out.data(), size, at);
        at += size;
        return size;
    };
}

/// "line@offset: a|b", "…: !problem", "…: (empty line)".
std::string to_text(const CsvRow& row) {
    std::string text = std::to_string(row.line) + "@" + std::to_string(row.offset) + ": ";
    if (row.problem != CsvProblem::none) {
        return text + "!" + describe(row);
    }
    if (row.empty_line) {
        EXPECT_THAT(row.fields, ElementsAre(""));
        return text + "(empty line)";
    }
    for (std::size_t i = 0; i < row.fields.size(); ++i) {
        text.append(i == 0 ? "" : "|").append(row.fields[i]);
    }
    return text;
}

std::vector<std::string> read_in_portions(const std::string& text, CsvDelimiter delimiter, std::size_t portion) {
    CsvReader reader{portions(text, portion)};
    EXPECT_TRUE(reader.open().has_value());
    reader.set_delimiter(delimiter);
    std::vector<std::string> rows;
    CsvRow row;
    while (reader.next(row).value()) {
        rows.push_back(to_text(row));
    }
    EXPECT_EQ(reader.offset(), text.size());
    return rows;
}

std::vector<std::string> read(const std::string& text, CsvDelimiter delimiter = ',') {
    const auto rows = read_in_portions(text, delimiter, 1 << 20);
    for (const std::size_t portion : {1U, 2U, 3U, 7U}) {
        EXPECT_EQ(read_in_portions(text, delimiter, portion), rows) << "in portions of " << portion;
    }
    return rows;
}

TEST(CsvReader, shouldReadRowsWithEveryKindOfLineBreak) {
    EXPECT_THAT(read("a,b\nc,d\n"), ElementsAre("1@0: a|b", "2@4: c|d"));
    EXPECT_THAT(read("a,b\r\nc,d\r\n"), ElementsAre("1@0: a|b", "2@5: c|d"));
    EXPECT_THAT(read("a,b\rc,d\r"), ElementsAre("1@0: a|b", "2@4: c|d"));
    EXPECT_THAT(read("a\nb\r\nc\rd"), ElementsAre("1@0: a", "2@2: b", "3@5: c", "4@7: d"));
}

TEST(CsvReader, shouldReadALastRowWithoutLineBreak) {
    EXPECT_THAT(read("a,b"), ElementsAre("1@0: a|b"));
    EXPECT_THAT(read("\"a\",\"b\""), ElementsAre("1@0: a|b"));
    EXPECT_THAT(read("a,"), ElementsAre("1@0: a|"));
    EXPECT_THAT(read(""), IsEmpty());
}

TEST(CsvReader, shouldReadQuotedFields) {
    EXPECT_THAT(read("\"a,b\",\"say \"\"hi\"\"\"\nx,\"\"\n"), ElementsAre("1@0: a,b|say \"hi\"", "2@19: x|"));
}

TEST(CsvReader, shouldCountTheLinesInsideQuotes) {
    EXPECT_THAT(read("\"a\r\nb\rc\nd\",x\ny\n"), ElementsAre("1@0: a\r\nb\rc\nd|x", "5@13: y"));
}

TEST(CsvReader, shouldKeepTextAsItIs) {
    EXPECT_THAT(read("007, 12345678901234567890 ,1e5,TRUE\n"), ElementsAre("1@0: 007| 12345678901234567890 |1e5|TRUE"));
    EXPECT_THAT(read(std::string{"a\0b,c\n", 6}), ElementsAre(std::string{"1@0: a\0b|c", 10}));
}

TEST(CsvReader, shouldMarkEmptyLines) {
    EXPECT_THAT(read("\na\n\r\n\n\"\"\n"),
                ElementsAre("1@0: (empty line)", "2@1: a", "3@3: (empty line)", "4@5: (empty line)", "5@6: "));
}

TEST(CsvReader, shouldSkipAByteOrderMark) {
    EXPECT_THAT(read("\xEF\xBB\xBF"
                     "a,b\n"),
                ElementsAre("1@3: a|b"));
    EXPECT_THAT(read("\xEF\xBB\xBF\"a\",b\n"), ElementsAre("1@3: a|b"));
    EXPECT_THAT(read("\xEF\xBB\xBF"), IsEmpty());
    EXPECT_THAT(read("a\xEF\xBB\xBF"), ElementsAre("1@0: a\xEF\xBB\xBF"));
}

TEST(CsvReader, shouldRefuseUtf16) {
    for (const char* mark : {"\xFF\xFE", "\xFE\xFF"}) {
        CsvReader reader{portions(std::string{mark} + "abcd", 1)};
        const auto opened = reader.open();
        ASSERT_FALSE(opened.has_value());
        EXPECT_EQ(opened.error(), (Failure{FailureKind::input, "the file is UTF-16: save it as UTF-8"}));
    }
}

TEST(CsvReader, shouldReportRowsOfBadFormAndGoOn) {
    EXPECT_THAT(
        read("a,5\" b\nc,d\n"),
        ElementsAre("1@0: !a quote inside a field that is not quoted (write \"\" inside a quoted field)", "2@7: c|d"));
    EXPECT_THAT(read("\"a\nb\"x,d\ne,f\n"), ElementsAre("1@0: !text behind the closing quote of a field", "3@9: e|f"));
}

TEST(CsvReader, shouldReportAQuoteThatIsNeverClosedWithItsLine) {
    EXPECT_THAT(read("a,b\nc,\"x\ny\",\"d\ne\n\n"),
                ElementsAre("1@0: a|b",
                            "2@4: !the quote opened in line 3 is never closed: everything up to the end of the file "
                            "belongs to this row"));
    EXPECT_THAT(read("\""), ElementsAre(HasSubstr("opened in line 1 is never closed")));
}

TEST(CsvReader, shouldKnowNoDelimiterIfThereIsNone) {
    EXPECT_THAT(read("Smith, John;\tx\n\"a,b\"\n", std::nullopt), ElementsAre("1@0: Smith, John;\tx", "2@15: a,b"));
}

TEST(CsvReader, shouldTakeARowOfTheGreatestLengthAndRefuseALongerOne) {
    const std::string longest(max_row_bytes, 'x');
    for (const std::string line_break : {"\n", "\r\n", ""}) {
        EXPECT_THAT(read_in_portions(longest + line_break, ',', 100'000), ElementsAre("1@0: " + longest));
        EXPECT_THAT(read_in_portions(longest + "x" + line_break, ',', 100'000),
                    ElementsAre(HasSubstr("longer than 1 MiB")));
    }
    const std::string quoted = "\"" + std::string(max_row_bytes - 2, 'x') + "\"";
    EXPECT_THAT(read_in_portions(quoted + "\n", ',', 100'000), ElementsAre(HasSubstr("xxx")));
    EXPECT_THAT(read_in_portions(quoted + ",\n", ',', 100'000), ElementsAre(HasSubstr("longer than 1 MiB")));
}

TEST(CsvReader, shouldSkipALongRowToItsEndInBoundedMemory) {
    for (const std::string quote : {"", "\""}) {
        // 20 MiB in one row, then a good one.
        std::size_t left = std::size_t{20} * 1024 * 1024;
        std::string tail = quote + "\nlast,row\n";
        bool begun = false;
        CsvReader reader{[&](std::span<char> out) -> Result<std::size_t> {
            if (!begun) {
                begun = true;
                const std::string head = "first,row\n" + quote;
                head.copy(out.data(), head.size());
                return head.size();
            }
            const std::size_t size = std::min(out.size(), left > 0 ? left : tail.size());
            if (left > 0) {
                std::fill_n(out.begin(), size, 'x');
                left -= size;
            } else {
                tail.copy(out.data(), size);
                tail.erase(0, size);
            }
            return size;
        }};
        ASSERT_TRUE(reader.open().has_value());
        reader.set_delimiter(',');
        std::vector<std::string> rows;
        CsvRow row;
        while (reader.next(row).value()) {
            rows.push_back(to_text(row));
            EXPECT_LE(reader.window_bytes(), max_row_bytes + 512 * 1024);
        }
        const std::string end = std::to_string(10 + 20 * 1024 * 1024 + 2 * quote.size() + 1);
        EXPECT_THAT(rows,
                    ElementsAre("1@0: first|row", HasSubstr("2@10: !the row is longer"), "3@" + end + ": last|row"));
    }
}

TEST(CsvReader, shouldReadFilesLargerThanItsWindow) {
    std::string text;
    std::vector<std::string> expected;
    for (int i = 0; i < 60'000; ++i) {
        expected.push_back(std::to_string(i + 1) + "@" + std::to_string(text.size()) + ": " + std::to_string(i) + "|" +
                           std::string(static_cast<std::size_t>(i % 23), 'y'));
        const char* quote = i % 7 == 0 ? "\"" : "";
        text += std::to_string(i) + "," + quote + std::string(static_cast<std::size_t>(i % 23), 'y') + quote + "\r\n";
    }
    EXPECT_EQ(read_in_portions(text, ',', 1 << 20), expected);
    EXPECT_EQ(read_in_portions(text, ',', 1000), expected);
}

TEST(CsvReader, shouldLookAtAWholeFirstRowForTheDelimiter) {
    const std::string wide = "\"" + std::string(400'000, ',') + "\";b\n";
    for (const std::size_t portion : {1'000U, 1U << 20}) {
        CsvReader reader{portions(wide, portion)};
        ASSERT_TRUE(reader.open().has_value());
        EXPECT_EQ(reader.guess_delimiter().value(), ';');
    }
}

TEST(CsvReader, shouldPassOnAFailureToRead) {
    const Failure disk{FailureKind::input, "the disk cannot read it"};
    bool fails = true;
    CsvReader broken{[&](std::span<char>) -> Result<std::size_t> { return disk; }};
    EXPECT_EQ(broken.open().error(), disk);
    CsvReader reader{[&](std::span<char> out) -> Result<std::size_t> {
        fails = !fails;
        if (fails) {
            return disk;
        }
        std::fill_n(out.begin(), 5, 'x');
        return 5;
    }};
    ASSERT_TRUE(reader.open().has_value());
    CsvRow row;
    EXPECT_EQ(reader.next(row).error(), disk);
}

} // namespace
} // namespace linefeed::intake
