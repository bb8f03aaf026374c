// What others can cause as often as they like, and what is kept of it: so many a minute, and the number of the rest.
#pragma once

#include "base/time.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace linefeed {

/// One thread.
class FloodBound {
public:
    explicit FloodBound(std::uint32_t a_minute)
        : a_minute_(a_minute) {}

    /// How many were held back since the last that was kept; std::nullopt = this one is held back as well.
    [[nodiscard]] std::optional<std::uint64_t> take(Instant now) {
        if (kept_ == 0 || now - minute_ >= std::chrono::minutes{1}) {
            minute_ = now;
            kept_ = 0;
        }
        if (kept_ == a_minute_) {
            ++held_back_;
            return std::nullopt;
        }
        ++kept_;
        return std::exchange(held_back_, 0U);
    }

private:
    std::uint32_t a_minute_;
    std::uint32_t kept_ = 0; ///< of the minute that began at minute_
    Instant minute_{};
    std::uint64_t held_back_ = 0;
};

} // namespace linefeed
