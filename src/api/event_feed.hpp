// Events for all streams at once: what is new is read once, whoever listens, so that many readers cost the store no
// more than one. Streams that are further behind than the newest events here read on their own until they have caught
// up.
#pragma once

#include "api/workers.hpp"
#include "base/time.hpp"
#include "daemon/operations.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace linefeed::api {

/// Somebody who follows the events. Called on the control thread.
class EventListener {
public:
    virtual ~EventListener() = default;
    virtual void on_new_events() = 0;
};

/// Events as they go over the wire.
struct EventBatch {
    std::string text;       ///< server-sent events
    std::uint64_t last = 0; ///< id of the last of them
};

/// As a server-sent event. Every line break in it is JSON's.
[[nodiscard]] std::string to_server_sent(const daemon::EventView& event);

/// Lives on the control thread. Flow: start(), then listeners come and go, then stop().
class EventFeed : public std::enable_shared_from_this<EventFeed> {
public:
    static constexpr std::size_t max_kept = 1024;
    static constexpr std::size_t max_batch = 256;

    EventFeed(boost::asio::io_context& context, daemon::Operations& operations, Workers& workers);

    /// May wait for the store.
    void start();
    void stop();

    /// The id of the newest event; absent = not known yet, since the store could not be read.
    [[nodiscard]] const std::optional<std::uint64_t>& last() const { return last_; }
    void listen(EventListener& listener) { listeners_.insert(&listener); }
    void leave(EventListener& listener) { listeners_.erase(&listener); }
    /// Those behind `after`, at most max_batch; calls back at once if they are at hand. std::nullopt: they cannot be
    /// read now.
    void read(std::uint64_t after, std::function<void(std::optional<EventBatch>)> done);

private:
    struct Kept {
        std::uint64_t id;
        std::string text;
    };

    void poll();
    void take(Result<std::uint64_t> newest, Result<std::vector<daemon::EventView>> events);

    boost::asio::io_context& context_;
    daemon::Operations& operations_;
    Workers& workers_;
    boost::asio::steady_timer retry_;
    std::shared_ptr<std::atomic<bool>> noticed_ = std::make_shared<std::atomic<bool>>(false);
    std::uint64_t subscription_ = 0;
    std::optional<std::uint64_t> last_;
    std::uint64_t kept_after_ = 0; ///< every event behind this one is in kept_
    std::deque<Kept> kept_;
    std::set<EventListener*> listeners_;
    bool polling_ = false;
    bool again_ = false; ///< there was a notice while polling
    bool stopped_ = false;
};

} // namespace linefeed::api
