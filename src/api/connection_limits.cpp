#include "api/connection_limits.hpp"

#include "base/assert.hpp"
#include "config/checks.hpp"

#include <algorithm>

namespace linefeed::api {

std::size_t ConnectionLimits::most_from_address() const {
    constexpr std::size_t share = 4;
    constexpr std::size_t least = 4;
    return std::max(most_ / share, least);
}

ConnectionLimits::Verdict ConnectionLimits::verdict(const std::string& address) const {
    const auto same = by_address_.find(address);
    if (same != by_address_.end() && same->second >= most_from_address() && !config::is_loopback(address)) {
        return Verdict::too_many_from_address;
    }
    return open_ >= most_ ? Verdict::too_many : Verdict::admitted;
}

void ConnectionLimits::enter(const std::string& address) {
    ++open_;
    ++by_address_[address];
}

void ConnectionLimits::leave(const std::string& address) {
    const auto same = by_address_.find(address);
    LINEFEED_ASSERT(open_ > 0 && same != by_address_.end());
    --open_;
    if (--same->second == 0) {
        by_address_.erase(same);
    }
}

} // namespace linefeed::api
