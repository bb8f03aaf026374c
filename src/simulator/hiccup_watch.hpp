// Tells a stall of the platform from a host's fault: a thread that does nothing but sleep, and notes when it was woken
// late. Pinned to the same processor and scheduled like the thread it watches over (threads inherit both), it sees what
// happened to that thread as well.
#pragma once

#include "base/time.hpp"

#include <atomic>
#include <thread>
#include <vector>

namespace linefeed::simulator {

/// A stretch of time in which a thread that wanted to run did not.
struct Stall {
    Instant from;
    Instant to;
};

/// Flow: start(), stop(), stalls().
class HiccupWatch {
public:
    /// Shorter delays are no stalls.
    static constexpr Duration limit = std::chrono::milliseconds{1};
    static constexpr Duration beat = std::chrono::microseconds{500};
    /// More are counted only.
    static constexpr std::size_t max_stalls = 100000;

    HiccupWatch() { stalls_.reserve(max_stalls); }
    ~HiccupWatch() { stop(); }
    HiccupWatch(const HiccupWatch&) = delete;
    HiccupWatch& operator=(const HiccupWatch&) = delete;

    void start();
    void stop();
    /// In the order of time. Precondition: not running.
    [[nodiscard]] const std::vector<Stall>& stalls() const { return stalls_; }

private:
    void watch();

    std::vector<Stall> stalls_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

} // namespace linefeed::simulator
