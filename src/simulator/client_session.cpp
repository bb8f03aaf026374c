// Reading, decoding and answering, see client_session.hpp.
#include "simulator/client_session.hpp"

#include "simulator/steady_instant.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/write.hpp>

#include <utility>
#include <variant>

namespace linefeed::simulator {

using boost::asio::ip::tcp;
using boost::system::error_code;

ClientSession::ClientSession(tcp::socket socket, Server& server, ConnectionId id)
    : socket_(std::move(socket))
    , server_(server)
    , id_(id)
    , decoder_(server.settings_.escapes)
    , delay_timer_(server.io_) {}

void ClientSession::start() {
    error_code error;
    socket_.set_option(tcp::no_delay{true}, error);
    socket_.non_blocking(true, error);
    read();
}

void ClientSession::read() {
    // Waits for bytes without a buffer, so that read_available() may take them at any time.
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](const error_code& error) {
        if (self->closed_) {
            return;
        }
        if (error) {
            self->close();
            return;
        }
        self->read_available();
        if (!self->closed_ && !self->ended_) {
            self->read();
        }
    });
}

void ClientSession::read_available() {
    for (int reads = 0; reads < max_reads && !closed_ && !ended_; ++reads) {
        error_code error;
        const std::size_t size = socket_.read_some(boost::asio::buffer(read_buffer_), error);
        if (error == boost::asio::error::would_block || error == boost::asio::error::try_again) {
            return;
        }
        if (error == boost::asio::error::eof) {
            ended_ = true;
            close_if_done();
            return;
        }
        if (error) {
            close();
            return;
        }
        take({read_buffer_.data(), size});
    }
}

void ClientSession::take(std::string_view bytes) {
    const Instant now = steady_now();
    while (!closed_) {
        const auto result = decoder_.next(bytes);
        if (const auto* frame = std::get_if<protocol::Frame>(&result)) {
            server_.handler_.on_frame(id_, *frame, now);
        } else if (std::holds_alternative<protocol::FrameError>(result)) {
            server_.handler_.on_damaged_bytes(id_);
        } else {
            return;
        }
    }
}

void ClientSession::send(std::string bytes) {
    if (closed_) {
        return;
    }
    if (server_.settings_.reply_delay == Duration::zero()) {
        write(std::move(bytes));
        return;
    }
    delayed_.push_back({steady_now() + server_.settings_.reply_delay, std::move(bytes)});
    if (delayed_.size() == 1) {
        wait_for_delayed();
    }
}

void ClientSession::wait_for_delayed() {
    delay_timer_.expires_at(to_steady(delayed_.front().due));
    delay_timer_.async_wait([self = shared_from_this()](const error_code& error) {
        if (error || self->closed_) {
            return;
        }
        const Instant now = steady_now();
        while (!self->closed_ && !self->delayed_.empty() && self->delayed_.front().due <= now) {
            self->write(std::move(self->delayed_.front().bytes));
            self->delayed_.pop_front();
        }
        if (!self->closed_ && !self->delayed_.empty()) {
            self->wait_for_delayed();
        }
        self->close_if_done();
    });
}

void ClientSession::write(std::string bytes) {
    if (waiting_.size() + bytes.size() > max_waiting_bytes) {
        close();
        return;
    }
    waiting_ += bytes;
    if (!is_writing_) {
        start_write();
    }
}

void ClientSession::start_write() {
    is_writing_ = true;
    writing_.clear();
    writing_.swap(waiting_);
    boost::asio::async_write(socket_, boost::asio::buffer(writing_),
                             [self = shared_from_this()](const error_code& error, std::size_t) {
                                 self->is_writing_ = false;
                                 if (self->closed_) {
                                     return;
                                 }
                                 if (error) {
                                     self->close();
                                 } else if (!self->waiting_.empty()) {
                                     self->start_write();
                                 }
                                 self->close_if_done();
                             });
}

void ClientSession::close_if_done() {
    if (ended_ && delayed_.empty() && !is_writing_ && waiting_.empty()) {
        close();
    }
}

void ClientSession::close() {
    if (std::exchange(closed_, true)) {
        return;
    }
    error_code ignored;
    socket_.close(ignored);
    delay_timer_.cancel();
    server_.forget(id_);
}

} // namespace linefeed::simulator
