// How many connections one client may have.
#include "api/connection_limits.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace linefeed::api {
namespace {

using Verdict = ConnectionLimits::Verdict;

TEST(ConnectionLimits, OneAddressHasAQuarterAndTheRestIsForOthers) {
    ConnectionLimits limits{40};
    std::vector<std::unique_ptr<ConnectionSlot>> slots;
    while (limits.verdict("10.0.0.1") == Verdict::admitted) {
        slots.push_back(std::make_unique<ConnectionSlot>(limits, "10.0.0.1"));
    }
    EXPECT_EQ(slots.size(), 10U);
    EXPECT_EQ(limits.verdict("10.0.0.1"), Verdict::too_many_from_address);
    EXPECT_EQ(limits.verdict("10.0.0.2"), Verdict::admitted);
    slots.pop_back();
    EXPECT_EQ(limits.verdict("10.0.0.1"), Verdict::admitted);
}

TEST(ConnectionLimits, TheLoopbackIsNotOneClient) {
    ConnectionLimits limits{40};
    std::vector<std::unique_ptr<ConnectionSlot>> slots;
    while (limits.verdict("127.0.0.1") == Verdict::admitted) {
        slots.push_back(std::make_unique<ConnectionSlot>(limits, "127.0.0.1"));
    }
    EXPECT_EQ(slots.size(), 40U);
    EXPECT_EQ(limits.verdict("127.0.0.1"), Verdict::too_many);
    EXPECT_EQ(limits.verdict("10.0.0.1"), Verdict::too_many);
    slots.clear();
    EXPECT_EQ(limits.open(), 0U);
}

TEST(ConnectionLimits, FewerAreAllowedFromNowOn) {
    ConnectionLimits limits{3};
    const ConnectionSlot one{limits, "10.0.0.1"};
    EXPECT_EQ(limits.verdict("10.0.0.1"), Verdict::admitted) << "an address has at least 4";
    limits.set_most(1);
    EXPECT_EQ(limits.verdict("10.0.0.2"), Verdict::too_many);
}

} // namespace
} // namespace linefeed::api
