#include "api/event_stream.hpp"

#include <boost/asio/write.hpp>

#include <algorithm>

namespace linefeed::api {

using boost::system::error_code;

EventStream::EventStream(Socket socket, Core& core, std::unique_ptr<ConnectionSlot> slot, std::uint64_t after,
                         bool over_tcp)
    : socket_(std::move(socket))
    , core_(core)
    , slot_(std::move(slot))
    , timer_(core.context)
    , sent_(after)
    , over_tcp_(over_tcp) {
    core_.streams.insert(this);
    core_.feed.listen(*this);
}

EventStream::~EventStream() {
    core_.feed.leave(*this);
    core_.streams.erase(this);
}

void EventStream::start(std::string head) {
    constexpr std::string_view come_again_after = "retry: 2000\n\n"; // ms
    watch_for_end();
    write(head.append(come_again_after));
}

void EventStream::on_new_events() {
    pump();
}

void EventStream::pump() {
    if (writing_ || reading_ || closed_ || !core_.feed.last() || sent_ >= *core_.feed.last()) {
        return;
    }
    reading_ = true;
    core_.feed.read(sent_, [self = shared_from_this()](std::optional<EventBatch> batch) {
        self->reading_ = false;
        if (self->closed_) {
            return;
        }
        if (!batch) { // the reader comes again, and is then told why or what he missed
            self->close();
            return;
        }
        self->sent_ = batch->last;
        if (!batch->text.empty()) {
            self->write(std::move(batch->text));
        }
    });
}

void EventStream::write(std::string text) {
    writing_ = true;
    text_ = std::move(text);
    arm(write_timeout);
    boost::asio::async_write(
        socket_, boost::asio::buffer(text_),
        [self = shared_from_this()](const error_code& error, std::size_t) { self->on_written(error); });
}

void EventStream::on_written(const error_code& error) {
    writing_ = false;
    if (error || closed_) {
        close();
        return;
    }
    arm(heartbeat);
    pump();
}

void EventStream::watch_for_end() {
    socket_.async_read_some(boost::asio::buffer(received_),
                            [self = shared_from_this()](const error_code&, std::size_t) {
                                self->close(); // the reader is gone, or sends what has no meaning here
                            });
}

void EventStream::arm(std::chrono::steady_clock::duration time) {
    timer_.expires_after(time);
    timer_.async_wait([self = shared_from_this(), turn = ++timer_turn_](const error_code& cancelled) {
        if (!cancelled && turn == self->timer_turn_) {
            self->on_timer();
        }
    });
}

void EventStream::on_timer() {
    if (writing_) {
        close();
    } else {
        write(": still here\n\n");
    }
}

void EventStream::close() {
    if (std::exchange(closed_, true)) {
        return;
    }
    ++timer_turn_;
    timer_.cancel();
    error_code ignored;
    socket_.close(ignored);
    slot_.reset();
    core_.feed.leave(*this);
    core_.streams.erase(this);
}

} // namespace linefeed::api
