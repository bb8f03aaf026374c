// Sleeping and looking at the clock, see hiccup_watch.hpp.
#include "simulator/hiccup_watch.hpp"

#include "simulator/steady_instant.hpp"

namespace linefeed::simulator {

void HiccupWatch::start() {
    thread_ = std::thread{[this] { watch(); }};
}

void HiccupWatch::stop() {
    stopping_ = true;
    if (thread_.joinable()) {
        thread_.join();
    }
}

void HiccupWatch::watch() {
    Instant due = steady_now();
    while (!stopping_) {
        due += beat;
        std::this_thread::sleep_until(to_steady(due));
        const Instant now = steady_now();
        if (now - due > limit) {
            if (stalls_.size() < max_stalls) {
                stalls_.push_back({due, now});
            }
            due = now;
        }
    }
}

} // namespace linefeed::simulator
