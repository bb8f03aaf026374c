// One reader of the event stream. It is sent what is new when it has taken what was sent before: what waits for it is
// one batch, and the rest stays in the store. A reader that does not take it is cut off, and comes again with
// Last-Event-ID.
#pragma once

#include "api/core.hpp"

#include <boost/asio/steady_timer.hpp>

#include <array>
#include <memory>
#include <string>

namespace linefeed::api {

/// Flow: start(); it keeps itself alive until it is closed. Lives on the control thread.
class EventStream : public EventListener, public std::enable_shared_from_this<EventStream> {
public:
    static constexpr std::chrono::seconds heartbeat{15};
    static constexpr std::chrono::seconds write_timeout{10};

    /// Events behind `after`; `over_tcp`: by the rights that a token gives.
    EventStream(Socket socket, Core& core, std::unique_ptr<ConnectionSlot> slot, std::uint64_t after, bool over_tcp);
    ~EventStream() override;

    /// `head` is the answer's.
    void start(std::string head);
    void on_new_events() override;
    void close();
    [[nodiscard]] bool over_tcp() const { return over_tcp_; }

private:
    void pump();
    void write(std::string text);
    void on_written(const boost::system::error_code& error);
    void watch_for_end();
    void arm(std::chrono::steady_clock::duration time);
    void on_timer();

    Socket socket_;
    Core& core_;
    std::unique_ptr<ConnectionSlot> slot_;
    boost::asio::steady_timer timer_;
    std::uint64_t timer_turn_ = 0;
    std::uint64_t sent_; ///< id of the last event that was sent
    bool over_tcp_;
    bool writing_ = false;
    bool reading_ = false; ///< events are being read for it
    bool closed_ = false;
    std::string text_; ///< that is being written
    std::array<char, 64> received_{};
};

} // namespace linefeed::api
