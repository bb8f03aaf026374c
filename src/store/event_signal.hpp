// Wakes a thread that waits on a file descriptor: no lock, no allocation, usable from the feed thread.
#pragma once

namespace linefeed::store {

/// An eventfd. notify() from any thread; one thread waits.
class EventSignal {
public:
    EventSignal();
    ~EventSignal();
    EventSignal(const EventSignal&) = delete;
    EventSignal& operator=(const EventSignal&) = delete;

    void notify() noexcept;
    /// Resets the signal; never blocks.
    void clear() noexcept;
    /// Waits until notified or `timeout_ms` have passed, and clears.
    void wait(int timeout_ms) noexcept;
    [[nodiscard]] int descriptor() const { return descriptor_; }

private:
    int descriptor_ = -1;
};

} // namespace linefeed::store
