#include "spool/json_text.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace linefeed::spool {
namespace {

TEST(JsonObject, shouldKeepTheOrderOfItsKeys) {
    EXPECT_EQ(JsonObject{}.text(), "{}");
    EXPECT_EQ(JsonObject{}.add("b", "x").add("a", -1).add_json("c", "[]").text(), R"({"b":"x","a":-1,"c":[]})");
}

TEST(JsonObject, shouldWriteNumbersWhole) {
    EXPECT_EQ(JsonObject{}.add("n", std::numeric_limits<std::uint64_t>::max()).text(), R"({"n":18446744073709551615})");
    EXPECT_EQ(JsonObject{}.add("n", std::numeric_limits<std::int64_t>::min()).text(), R"({"n":-9223372036854775808})");
}

TEST(JsonObject, shouldEscapeTexts) {
    EXPECT_EQ(JsonObject{}.add("t", "a\"b\\c\t\n\x01Müller").text(), "{\"t\":\"a\\\"b\\\\c\\t\\n\\u0001Müller\"}");
}

TEST(JsonObject, shouldReplaceWhatIsNotUtf8) {
    EXPECT_EQ(JsonObject{}.add("t", "a\xFFz").text(), "{\"t\":\"a\uFFFDz\"}");
}

TEST(JsonString, shouldBeQuotedAndEscaped) {
    EXPECT_EQ(json_string("a\"\n\xFF"), "\"a\\\"\\n\uFFFD\"");
}

TEST(JsonArray, shouldSeparateItsValues) {
    EXPECT_EQ(json_array({}), "[]");
    EXPECT_EQ(json_array({"1"}), "[1]");
    EXPECT_EQ(json_array({"{}", "\"x\"", "3"}), R"([{},"x",3])");
}

} // namespace
} // namespace linefeed::spool
