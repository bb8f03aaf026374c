// Decimal numbers: the whole text or nothing.
#include "protocol/decimal.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace linefeed::protocol {
namespace {

TEST(Decimal, shouldAppendDigits) {
    std::string out = "CM";
    append_decimal(out, 0U);
    append_decimal(out, 4'294'967'295U);
    append_decimal(out, -1'711'274'809);
    EXPECT_EQ(out, "CM04294967295-1711274809");
}

TEST(Decimal, shouldReadTheWholeText) {
    EXPECT_EQ(read_decimal<std::uint32_t>("4294967295"), 4'294'967'295U);
    EXPECT_EQ(read_decimal<std::uint32_t>("007"), 7U);
    EXPECT_EQ(read_decimal<std::int32_t>("-2147483648"), INT32_MIN);
}

TEST(Decimal, shouldRefuseWhatIsNoNumberOrDoesNotFit) {
    for (const char* const text : {"", "-", "-1", "+1", " 1", "1 ", "1x", "x", "0x1", "1.0", "4294967296"}) {
        EXPECT_EQ(read_decimal<std::uint32_t>(text), std::nullopt) << text;
    }
    EXPECT_EQ(read_decimal<std::int32_t>("2147483648"), std::nullopt);
}

} // namespace
} // namespace linefeed::protocol
