#include "base/flood_bound.hpp"

#include <gtest/gtest.h>

namespace linefeed {
namespace {

using std::chrono::seconds;

constexpr Instant start{std::chrono::hours{5}};

TEST(FloodBound, shouldKeepSoManyAMinuteAndCountTheRest) {
    FloodBound bound{3};
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(bound.take(start + seconds{k}), 0U);
    }
    for (int k = 0; k < 1000; ++k) {
        EXPECT_EQ(bound.take(start + seconds{59}), std::nullopt);
    }
    EXPECT_EQ(bound.take(start + seconds{60}), 1000U);
    EXPECT_EQ(bound.take(start + seconds{61}), 0U);
}

TEST(FloodBound, shouldBeginAnewBehindAQuietMinute) {
    FloodBound bound{1};
    EXPECT_EQ(bound.take(start), 0U);
    EXPECT_EQ(bound.take(start + seconds{600}), 0U);
    EXPECT_EQ(bound.take(start + seconds{601}), std::nullopt);
}

} // namespace
} // namespace linefeed
