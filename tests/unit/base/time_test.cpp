// Time is a parameter: the core's clock cannot be read.
#include "base/time.hpp"

#include <gtest/gtest.h>

namespace linefeed {
namespace {

template <typename Clock>
concept readable = requires {
    Clock::now();
};

TEST(Time, shouldOfferNoClockToTheCore) {
    static_assert(!readable<MonotonicTime>);
    static_assert(readable<std::chrono::steady_clock>, "the check itself works");
    SUCCEED() << "checked by the compiler";
}

TEST(Time, shouldCountNanoseconds) {
    const Instant start{};
    EXPECT_EQ((start + std::chrono::milliseconds{3}) - start, Duration{3'000'000});
    EXPECT_LT(start, start + Duration{1});
}

} // namespace
} // namespace linefeed
