// What differs between firmwares.
#include "protocol/profile.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

TEST(Profile, shouldBeFoundByName) {
    const auto jet3up = profile_by_name("jet3up");
    ASSERT_TRUE(jet3up);
    EXPECT_EQ(jet3up->escapes, EscapeMode::backslash);
    EXPECT_EQ(profile_by_name("jet2neo").value().escapes, EscapeMode::backslash);
}

TEST(Profile, shouldKnowTheFirmwareWithoutEscapes) {
    EXPECT_EQ(profile_by_name("jet3").value().escapes, EscapeMode::none);
    EXPECT_EQ(profile_by_name("jet2neo-v71").value().escapes, EscapeMode::none);
}

TEST(Profile, shouldNotGuess) {
    EXPECT_FALSE(profile_by_name("JET3"));
    EXPECT_FALSE(profile_by_name(""));
}

} // namespace
} // namespace linefeed::protocol
