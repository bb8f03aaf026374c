// Record numbers as people type them.
#include "daemon/record_ranges.hpp"

#include <gtest/gtest.h>

namespace linefeed::daemon {
namespace {

RecordRange closed(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

std::string refusal_of(std::string_view text) {
    const auto ranges = parse_record_ranges(text);
    EXPECT_FALSE(ranges.has_value()) << text;
    if (ranges) {
        return {};
    }
    EXPECT_EQ(ranges.error().kind, FailureKind::usage);
    return ranges.error().message;
}

TEST(RecordRangeText, shouldReadANumberOrTwo) {
    EXPECT_EQ(parse_record_range("17"), closed(17, 17));
    EXPECT_EQ(parse_record_range("17-40"), closed(17, 40));
    EXPECT_EQ(parse_record_range("4294967295"), closed(4294967295, 4294967295));
    for (const char* text :
         {"", "-", "17-", "-17", "17-16", "17-40-50", "17 40", "x", "17x", "4294967296", "1-4294967296"}) {
        EXPECT_EQ(parse_record_range(text), std::nullopt) << text;
    }
}

TEST(RecordRangesText, shouldReadRangesInAnyOrderAndGiveThemAscending) {
    EXPECT_EQ(parse_record_ranges("161456-161474,161707").value(),
              (std::vector{closed(161456, 161474), closed(161707, 161707)}));
    EXPECT_EQ(parse_record_ranges(" 9 , 1-3,4 ").value(), (std::vector{closed(1, 3), closed(4, 4), closed(9, 9)}));
    EXPECT_EQ(parse_record_ranges(" none ").value(), std::vector<RecordRange>{});
}

TEST(RecordRangesText, shouldRefuseARecordThatIsNamedTwice) {
    EXPECT_EQ(refusal_of("5,5"), "record 5 is named twice, in 5 and in 5");
    EXPECT_EQ(refusal_of("12-20,1-12"), "record 12 is named twice, in 1-12 and in 12-20");
    EXPECT_EQ(refusal_of("1-100,3,5-6"), "record 3 is named twice, in 1-100 and in 3");
}

TEST(RecordRangesText, shouldNameThePartThatIsNoRange) {
    for (const auto& [text, part] :
         std::initializer_list<std::pair<const char*, const char*>>{{"", "\"\""},
                                                                    {"1,", "\"\""},
                                                                    {",1", "\"\""},
                                                                    {"1,,2", "\"\""},
                                                                    {"5-3", "\"5-3\""},
                                                                    {"1-2-3", "\"1-2-3\""},
                                                                    {"1;2", "\"1;2\""},
                                                                    {"none,1", "\"none\""},
                                                                    {"1,2,Smith", "\"Smith\""},
                                                                    {"1,4294967296", "\"4294967296\""}}) {
        EXPECT_NE(refusal_of(text).find(std::string{part} + " is neither"), std::string::npos) << text;
    }
}

TEST(RecordRangesText, shouldBeWrittenAsTheyAreRead) {
    EXPECT_EQ(to_text(std::vector{closed(5, 9), closed(12, 12)}), "5-9, 12");
    EXPECT_EQ(to_text(std::vector<RecordRange>{}), "none");
    EXPECT_EQ(to_text(RecordRange{}), "none");
    std::vector<RecordRange> many;
    for (std::uint32_t k = 1; k <= 50; k += 2) {
        many.push_back(closed(k, k));
    }
    EXPECT_NE(to_text(many).find("39 and 5 more ranges"), std::string::npos) << to_text(many);
}

} // namespace
} // namespace linefeed::daemon
