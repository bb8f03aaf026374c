// Figures that one thread writes without locks or allocation, and any thread reads while it does.
#pragma once

#include "base/histogram.hpp"

#include <atomic>
#include <cstdint>

namespace linefeed::store {

/// A count that one thread raises and any thread reads.
class SharedCount {
public:
    SharedCount& operator+=(std::uint64_t more) noexcept {
        value_.store(value_.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
        return *this;
    }
    operator std::uint64_t() const noexcept { return value_.load(std::memory_order_relaxed); }

private:
    std::atomic<std::uint64_t> value_{0};
};

using SharedHistogram = Histogram<SharedCount>;

} // namespace linefeed::store
