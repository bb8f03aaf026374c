// Assertions stay in every build and say what does not hold and where.
#include "base/assert.hpp"

#include <gtest/gtest.h>

namespace linefeed {
namespace {

TEST(Assert, shouldLetTheProgramGoOnWhenTheConditionHolds) {
    int evaluated = 0;
    LINEFEED_ASSERT(++evaluated == 1);
    EXPECT_EQ(evaluated, 1);
}

TEST(AssertDeathTest, shouldNameTheExpressionAndItsPlace) {
    EXPECT_DEATH(LINEFEED_ASSERT(1 + 1 == 3),
                 "linefeed: internal error: 1 \\+ 1 == 3 does not hold .*assert_test.cpp:");
}

} // namespace
} // namespace linefeed
