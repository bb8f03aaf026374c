// TAB-separated parameters: empty ones are absent, excess ones ignored, the first bad one is named.
#include "protocol/parameter_reader.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

using namespace std::string_view_literals;

TEST(ParameterReader, shouldGiveTextInOrder) {
    ParameterReader in{"V62.0.7.0\t\t 4711 "};
    EXPECT_EQ(in.text(), "V62.0.7.0");
    EXPECT_EQ(in.text(), std::nullopt) << "empty";
    EXPECT_EQ(in.text(), " 4711 ") << "as it came";
    EXPECT_EQ(in.text(), std::nullopt) << "no more";
    EXPECT_TRUE(in.ok());
}

TEST(ParameterReader, shouldGiveNumbersWithoutTheBlanksAroundThem) {
    ParameterReader in{"256  \t 0\t3\0\0\t-5"sv};
    EXPECT_EQ(in.number("a FIFO depth"), 256U);
    EXPECT_EQ(in.optional_number("a number"), 0U);
    EXPECT_EQ(in.record_number(), RecordNumber{3});
    EXPECT_EQ(in.signed_number("an error number"), -5);
    EXPECT_TRUE(in.ok());
}

TEST(ParameterReader, shouldTakeBlanksAloneForAbsent) {
    ParameterReader in{"  \t"};
    EXPECT_EQ(in.optional_number("a number"), std::nullopt);
    EXPECT_EQ(in.optional_number("a number"), std::nullopt);
    EXPECT_EQ(in.optional_number("a number"), std::nullopt);
    EXPECT_TRUE(in.ok());
}

TEST(ParameterReader, shouldReadTheSignedAndTheUnsignedFormOf32Bits) {
    ParameterReader in{"-2147483648\t2147483647\t2583692487\t4294967295"};
    EXPECT_EQ(in.signed_number("an error number"), INT32_MIN);
    EXPECT_EQ(in.signed_number("an error number"), INT32_MAX);
    EXPECT_EQ(in.signed_number("an error number"), -1711274809);
    EXPECT_EQ(in.signed_number("an error number"), -1);
    EXPECT_TRUE(in.ok());
}

TEST(ParameterReader, shouldReadNumbersBeyond32Bits) {
    ParameterReader in{"9999999999\t10000000000\t"};
    EXPECT_EQ(in.wide_number("a counter value", 9'999'999'999), 9'999'999'999U);
    EXPECT_EQ(in.wide_number("a counter value", 9'999'999'999), 0U);
    EXPECT_EQ(in.problem(), "parameter 2 is not a counter value: \"10000000000\"");
}

TEST(ParameterReader, shouldTakeASignedNumberThatMayBeMissing) {
    ParameterReader in{"-3\t\t4294967295\tx"};
    EXPECT_EQ(in.optional_signed_number("a correction"), -3);
    EXPECT_EQ(in.optional_signed_number("a correction"), std::nullopt);
    EXPECT_EQ(in.optional_signed_number("a correction"), -1);
    EXPECT_TRUE(in.ok());
    EXPECT_EQ(in.optional_signed_number("a correction"), std::nullopt);
    EXPECT_EQ(in.problem(), "parameter 4 is not a correction: \"x\"");
}

TEST(ParameterReader, shouldGiveTheRestWithItsTabs) {
    ParameterReader in{"1\ta\tb"};
    EXPECT_EQ(in.number("a number"), 1U);
    EXPECT_EQ(in.rest(), "a\tb");
    EXPECT_EQ(in.rest(), "");
    in.refuse("a text", "a\tb");
    EXPECT_EQ(in.problem(), "parameter 3 is not a text: \"a?b\"");
}

TEST(ParameterReader, shouldNameTheFirstParameterThatCannotBeRead) {
    ParameterReader in{"256\tx\ty"};
    EXPECT_EQ(in.number("a FIFO depth"), 256U);
    EXPECT_EQ(in.number("a number of entries"), 0U);
    EXPECT_EQ(in.record_number(), RecordNumber{0});
    ASSERT_FALSE(in.ok());
    EXPECT_EQ(in.problem(), "parameter 2 is not a number of entries: \"x\"");
}

TEST(ParameterReader, shouldNameAMissingParameter) {
    ParameterReader empty{"256\t\t3"};
    EXPECT_EQ(empty.number("a FIFO depth"), 256U);
    EXPECT_EQ(empty.number("a number of entries"), 0U);
    EXPECT_EQ(empty.problem(), "parameter 2 is missing: a number of entries");

    ParameterReader none{"256"};
    EXPECT_EQ(none.number("a FIFO depth"), 256U);
    EXPECT_EQ(none.signed_number("an error number"), 0);
    EXPECT_EQ(none.problem(), "parameter 2 is missing: an error number");
}

TEST(ParameterReader, shouldKeepNumbersWithinTheirRange) {
    ParameterReader low{"0"};
    EXPECT_EQ(low.number("a machine state", 1, 6), 1U);
    EXPECT_EQ(low.problem(), "parameter 1 is not a machine state: \"0\"");
    ParameterReader high{"7"};
    EXPECT_EQ(high.number("a machine state", 1, 6), 1U);
    EXPECT_FALSE(high.ok());
    ParameterReader optional{"2"};
    EXPECT_EQ(optional.optional_number("0 or 1", 1), std::nullopt);
    EXPECT_EQ(optional.problem(), "parameter 1 is not 0 or 1: \"2\"");
    ParameterReader huge{"4294967296"};
    EXPECT_EQ(huge.optional_number("a print counter"), std::nullopt);
    EXPECT_EQ(huge.problem(), "parameter 1 is not a print counter: \"4294967296\"");
    ParameterReader number{"-2147483649"};
    EXPECT_EQ(number.signed_number("an error number"), 0);
    EXPECT_FALSE(number.ok());
}

TEST(ParameterReader, shouldShowBadValuesPrintableAndShort) {
    ParameterReader in{"\x1B[2J\xE4"};
    EXPECT_EQ(in.number("a number"), 0U);
    EXPECT_EQ(in.problem(), "parameter 1 is not a number: \"?[2J?\"");
    const std::string long_value(60, 'x');
    ParameterReader longer{long_value};
    EXPECT_EQ(longer.number("a number"), 0U);
    EXPECT_EQ(longer.problem(), "parameter 1 is not a number: \"" + std::string(40, 'x') + "...\"");
}

TEST(ParameterReaderDeathTest, shouldHaveNoProblemWhenAllIsWell) {
    const ParameterReader in{""};
    EXPECT_DEATH(static_cast<void>(in.problem()), "ok");
}

} // namespace
} // namespace linefeed::protocol
