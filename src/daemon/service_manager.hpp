// What linefeedd tells systemd (Type=notify), and the watchdog: it is fed only while the threads that matter show
// progress of their own, so that a stalled feed thread ends in a restart and not in a line that starves for hours.
#pragma once

#include "base/time.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::daemon {

// Nothing is sent where nobody listens, i.e. without NOTIFY_SOCKET. `status` is one line for `systemctl status`.
void notify_ready(std::string_view status);
void notify_status(std::string_view status);
/// Ends with notify_ready(), whether the new settings were taken or not.
void notify_reloading();
void notify_stopping(std::string_view status);

/// A thread whose counter rises as long as it gets on.
struct Heart {
    std::string name; ///< "feed thread"
    std::function<std::uint64_t()> beats;
};

/// Flow: look() every look_interval(), on the control thread, which so proves its own progress as well.
class Watchdog {
public:
    explicit Watchdog(std::vector<Heart> hearts);

    /// A quarter of what systemd grants (WatchdogSec=), at most a second; absent: nobody watches. WatchdogSec must be
    /// at least 5 s: an idle store thread beats once a second.
    [[nodiscard]] static std::optional<Duration> look_interval();
    /// Tells systemd that all is well if each heart has beaten since that was told last. The names of those that have
    /// not; whoever calls it says so in the log when that lasts.
    [[nodiscard]] std::vector<std::string> look();

private:
    std::vector<Heart> hearts_;
    std::vector<std::uint64_t> told_; ///< their beats when systemd was told last
};

} // namespace linefeed::daemon
