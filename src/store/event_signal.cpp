#include "store/event_signal.hpp"

#include "base/assert.hpp"

#include <cstdint>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace linefeed::store {

EventSignal::EventSignal()
    : descriptor_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    LINEFEED_ASSERT(descriptor_ >= 0);
}

EventSignal::~EventSignal() {
    ::close(descriptor_);
}

void EventSignal::notify() noexcept {
    const std::uint64_t one = 1;
    // Fails only when the counter is full: then the reader is notified already.
    [[maybe_unused]] const auto written = ::write(descriptor_, &one, sizeof one);
}

void EventSignal::clear() noexcept {
    std::uint64_t count = 0;
    [[maybe_unused]] const auto read = ::read(descriptor_, &count, sizeof count);
}

void EventSignal::wait(int timeout_ms) noexcept {
    pollfd waiting{descriptor_, POLLIN, 0};
    ::poll(&waiting, 1, timeout_ms);
    clear();
}

} // namespace linefeed::store
