// The vectors of the manual, section "CRC32": they hold.
#include "protocol/crc32.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

TEST(Crc32, shouldAgreeWithTheManual) {
    EXPECT_EQ(crc32("^0?JL"), 3957421711U);
    EXPECT_EQ(crc32("^0=JL\\FFSDISK\\JOBS\\Testprint.job"), 3560773416U);
}

TEST(Crc32, shouldBeTheCommonOne) {
    EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
    EXPECT_EQ(crc32(""), 0U);
}

TEST(Crc32, shouldCoverEveryByte) {
    EXPECT_NE(crc32("^0?JL"), crc32("^0?JM"));
    EXPECT_NE(crc32(std::string_view{"\0", 1}), crc32(std::string_view{"\0\0", 2}));
}

TEST(Crc32, shouldNotCoverALineFeedBeforeTheCr) {
    EXPECT_TRUE(is_announced_by("^0?JL", 3957421711));
    EXPECT_TRUE(is_announced_by("^0?JL\n", 3957421711));
    EXPECT_FALSE(is_announced_by("^0?JL\n\n", 3957421711));
    EXPECT_FALSE(is_announced_by("^0?JM", 3957421711));
}

} // namespace
} // namespace linefeed::protocol
