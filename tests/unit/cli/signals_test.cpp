#include "cli/signals.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace linefeed::cli {
namespace {

TEST(SignalWatch, shouldTurnSignalsIntoFacts) {
    SignalWatch watch;
    EXPECT_EQ(watch.take(), 0);
    ASSERT_EQ(std::raise(SIGINT), 0);
    EXPECT_EQ(watch.take(), 1);
    EXPECT_EQ(watch.take(), 0);
    ASSERT_EQ(std::raise(SIGTERM), 0);
    ASSERT_EQ(std::raise(SIGHUP), 0);
    EXPECT_EQ(watch.take(), 2);
}

} // namespace
} // namespace linefeed::cli
