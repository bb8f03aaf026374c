// What of the requests stands in the log: who was refused, and what failed. A flood of such requests leaves some lines
// a minute and their number, so that nobody fills the disk by knocking.
#pragma once

#include "api/core.hpp"
#include "base/flood_bound.hpp"
#include "base/time.hpp"
#include "config/settings.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace linefeed::api {

/// One thread.
class RequestLog {
public:
    struct Line {
        config::LogLevel level = config::LogLevel::debug;
        std::string text; ///< any bytes of the client may be in it
        friend bool operator==(const Line&, const Line&) = default;
    };
    /// What is to be written of a request that was answered now; a few lines at most.
    [[nodiscard]] std::vector<Line> take(const AccessRecord& request, Instant now);

    static constexpr std::uint32_t lines_a_minute = 20; ///< of a kind
    static constexpr std::size_t longest_target = 200;  ///< characters of it that are shown

private:
    FloodBound refused_{lines_a_minute};
    FloodBound failed_{lines_a_minute}; ///< of their own, so that failures do not hide who was refused
};

} // namespace linefeed::api
