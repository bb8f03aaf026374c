// The signals that the service waits for.
#pragma once

#include "base/time.hpp"

#include <chrono>
#include <csignal>
#include <pthread.h>

namespace linefeed::linefeedd {

/// Blocked from before the first thread on, and waited for by the main thread alone.
class Signals {
public:
    Signals() {
        sigemptyset(&signals_);
        for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
            sigaddset(&signals_, signal);
        }
        ::pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
        ::signal(SIGPIPE, SIG_IGN); // whoever reads may go away
    }
    /// The next signal, 0 if none comes in that time. Precondition: `time` ≤ 1 s.
    [[nodiscard]] int wait(Duration time) const {
        constexpr Duration second = std::chrono::seconds{1};
        const timespec patience{time / second, (time % second).count()};
        const int signal = ::sigtimedwait(&signals_, nullptr, &patience);
        return signal > 0 ? signal : 0;
    }

private:
    sigset_t signals_{};
};

} // namespace linefeed::linefeedd
