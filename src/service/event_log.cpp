#include "service/event_log.hpp"

#include "daemon/wall_clock.hpp"

#include <algorithm>
#include <iterator>

namespace linefeed::service {

EventLog::~EventLog() {
    flush();
}

void EventLog::flush() {
    store_.call([](spool::Spool&) {}); // behind all that was posted
}

void EventLog::add(spool::Event event) {
    event.time_ns = daemon::wall_clock_ns();
    listen_(event);
    {
        const std::lock_guard lock{mutex_};
        waiting_.push_back(std::move(event));
        if (std::exchange(posted_, true)) {
            return;
        }
    }
    store_.post([this](spool::Spool& spool) { write(spool); });
}

/// On the store thread. What cannot be written is tried again with the next event.
void EventLog::write(spool::Spool& spool) {
    std::vector<spool::Event> events;
    {
        const std::lock_guard lock{mutex_};
        events.swap(waiting_);
        posted_ = false;
    }
    if (!spool.add_events(events)) {
        const std::lock_guard lock{mutex_};
        events.insert(events.end(), std::make_move_iterator(waiting_.begin()), std::make_move_iterator(waiting_.end()));
        const std::size_t lost = events.size() - std::min(events.size(), max_waiting);
        events.erase(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(lost));
        waiting_ = std::move(events);
        return;
    }
    const std::lock_guard lock{subscribers_mutex_};
    for (const auto& [subscription, on_events] : subscribers_) {
        on_events();
    }
}

std::uint64_t EventLog::subscribe(std::function<void()> on_events) {
    const std::lock_guard lock{subscribers_mutex_};
    subscribers_.emplace(++last_subscription_, std::move(on_events));
    return last_subscription_;
}

void EventLog::unsubscribe(std::uint64_t subscription) {
    const std::lock_guard lock{subscribers_mutex_};
    subscribers_.erase(subscription);
}

} // namespace linefeed::service
