#include "store/event_signal.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <poll.h>
#include <thread>

namespace linefeed::store {
namespace {

using std::chrono::steady_clock;

bool is_readable(const EventSignal& signal) {
    pollfd waiting{signal.descriptor(), POLLIN, 0};
    return ::poll(&waiting, 1, 0) == 1;
}

TEST(EventSignal, shouldBeReadableUntilCleared) {
    EventSignal signal;
    EXPECT_FALSE(is_readable(signal));
    signal.notify();
    EXPECT_TRUE(is_readable(signal));
    signal.clear();
    EXPECT_FALSE(is_readable(signal));
}

TEST(EventSignal, shouldCollapseSeveralNotificationsIntoOne) {
    EventSignal signal;
    signal.notify();
    signal.notify();
    signal.wait(0);
    EXPECT_FALSE(is_readable(signal));
}

TEST(EventSignal, shouldNotBlockWhenThereIsNothingToClear) {
    EventSignal signal;
    signal.clear();
    EXPECT_FALSE(is_readable(signal));
}

TEST(EventSignal, shouldWaitNoLongerThanAsked) {
    EventSignal signal;
    const auto begun = steady_clock::now();
    signal.wait(20);
    EXPECT_GE(steady_clock::now() - begun, std::chrono::milliseconds{19});
}

TEST(EventSignal, shouldReturnAtOnceIfNotifiedBefore) {
    EventSignal signal;
    signal.notify();
    const auto begun = steady_clock::now();
    signal.wait(60000);
    EXPECT_LT(steady_clock::now() - begun, std::chrono::seconds{30});
}

TEST(EventSignal, shouldWakeAnotherThread) {
    EventSignal signal;
    const auto begun = steady_clock::now();
    std::thread other{[&signal] {
        std::this_thread::sleep_for(std::chrono::milliseconds{20});
        signal.notify();
    }};
    signal.wait(60000);
    EXPECT_LT(steady_clock::now() - begun, std::chrono::seconds{30});
    other.join();
}

} // namespace
} // namespace linefeed::store
