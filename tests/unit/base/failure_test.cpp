// What can go wrong in operation is a value with a kind and one line for the operator.
#include "base/failure.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace linefeed {
namespace {

Result<int> printed(bool reachable) {
    if (reachable) {
        return 42;
    }
    return Failure{FailureKind::unreachable, "tcp://192.0.2.1:3000 refuses the connection"};
}

TEST(Failure, shouldTravelInAResult) {
    EXPECT_EQ(printed(true).value(), 42);
    const auto failed = printed(false);
    ASSERT_TRUE(failed.has_error());
    EXPECT_EQ(failed.error(), (Failure{FailureKind::unreachable, "tcp://192.0.2.1:3000 refuses the connection"}));
}

TEST(Failure, shouldBecomeAnExceptionWithItsMessageWhereAValueIsDemanded) {
    try {
        static_cast<void>(printed(false).value());
        FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "tcp://192.0.2.1:3000 refuses the connection");
    }
}

TEST(Failure, shouldDifferByKindAndByMessage) {
    const Failure failure{FailureKind::input, "a"};
    EXPECT_NE(failure, (Failure{FailureKind::storage, "a"}));
    EXPECT_NE(failure, (Failure{FailureKind::input, "b"}));
}

TEST(Failure, shouldNameEachKindForLogsAndJson) {
    EXPECT_EQ(to_string(FailureKind::usage), "usage");
    EXPECT_EQ(to_string(FailureKind::unreachable), "unreachable");
    EXPECT_EQ(to_string(FailureKind::stopped), "stopped");
    EXPECT_EQ(to_string(FailureKind::input), "input");
    EXPECT_EQ(to_string(FailureKind::in_doubt), "in_doubt");
    EXPECT_EQ(to_string(FailureKind::storage), "storage");
    EXPECT_EQ(to_string(FailureKind::internal), "internal");
}

TEST(FailureDeathTest, shouldAbortOnAKindThatDoesNotExist) {
    EXPECT_DEATH(static_cast<void>(to_string(static_cast<FailureKind>(99))), "FailureKind");
}

} // namespace
} // namespace linefeed
