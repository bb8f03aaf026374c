// The feed thread: one io_context with the sessions and links of all printers (design, section 3). It has what the
// operating system grants it once, whoever prints. Nothing on it may block, so no printer can hold up another.
#pragma once

#include "daemon/real_time.hpp"
#include "link/handler_memory.hpp"
#include "store/event_signal.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/lockfree/spsc_queue.hpp>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace linefeed::daemon {

/// Flow: construct, start(); then let_in() as often as wanted. All guests must have gone before it is destroyed.
class FeedThread {
public:
    /// Whoever lives on the thread.
    class Guest {
    public:
        virtual ~Guest() = default;
        /// Once for each let_in(), on the feed thread. What the guest does there must never block.
        virtual void on_feed_thread() = 0;
    };

    explicit FeedThread(const RealTimeSettings& settings);
    ~FeedThread();
    FeedThread(const FeedThread&) = delete;
    FeedThread& operator=(const FeedThread&) = delete;

    /// Returns what was granted, for people; empty if nothing was wanted.
    [[nodiscard]] std::string start();
    /// Any thread but the feed thread. Precondition: fewer than max_waiting have not been let in yet.
    void let_in(Guest& guest);
    /// Rises ten times a second as long as the thread gets on; any thread.
    [[nodiscard]] std::uint64_t beats() const { return beats_.load(std::memory_order_relaxed); }
    /// Whether the caller is on a feed thread: for the assertions of what has no place there.
    [[nodiscard]] static bool is_current() noexcept;
    /// For the feed thread alone: it never locks. Other threads come in through rings and signals.
    [[nodiscard]] boost::asio::io_context& context() { return context_; }

    static constexpr std::size_t max_waiting = 256;

private:
    void wait_for_guests();
    void beat();

    RealTimeSettings settings_;
    boost::asio::io_context context_{BOOST_ASIO_CONCURRENCY_HINT_UNSAFE};
    store::EventSignal door_signal_;
    boost::asio::posix::stream_descriptor door_;
    std::mutex outside_; ///< among those who call let_in(); the feed thread never takes it
    boost::lockfree::spsc_queue<Guest*, boost::lockfree::capacity<max_waiting>> waiting_;
    std::shared_ptr<link::HandlerMemory> beat_memory_ = std::make_shared<link::HandlerMemory>();
    boost::asio::steady_timer beat_timer_;
    std::atomic<std::uint64_t> beats_{0};
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

} // namespace linefeed::daemon
