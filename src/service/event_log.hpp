// What happens in the service, for those who watch it: told at once to the log, and to everybody else when it is
// durable, so that nobody ever sees an event whose number another one gets after a crash.
#pragma once

#include "spool/ticket.hpp"
#include "store/store_thread.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::service {

/// Any thread but the feed thread. The store thread must outlive it.
class EventLog {
public:
    /// `listen` hears of each event at once, on the thread where it happens; it must not call back.
    using Listener = std::function<void(const spool::Event&)>;
    EventLog(store::StoreThread& store, Listener listen)
        : store_(store)
        , listen_(std::move(listen)) {}
    ~EventLog();
    EventLog(const EventLog&) = delete;
    EventLog& operator=(const EventLog&) = delete;

    /// Does not wait for the disk.
    void add(spool::Event event);
    /// Waits until what was added before is written, or could not be.
    void flush();

    /// `on_events` is called when there are events, on any thread, and must not block or call back. The returned number
    /// ends it.
    [[nodiscard]] std::uint64_t subscribe(std::function<void()> on_events);
    /// After this it is not called any more.
    void unsubscribe(std::uint64_t subscription);

    /// So many wait while they cannot be written; older ones are lost then.
    static constexpr std::size_t max_waiting = 1000;

private:
    void write(spool::Spool& spool);

    store::StoreThread& store_;
    Listener listen_;
    std::mutex mutex_; ///< for what follows
    std::vector<spool::Event> waiting_;
    bool posted_ = false;
    std::mutex subscribers_mutex_; ///< for what follows
    std::map<std::uint64_t, std::function<void()>> subscribers_;
    std::uint64_t last_subscription_ = 0;
};

} // namespace linefeed::service
