#include "link/tcp_link.hpp"

#include <boost/asio/bind_allocator.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace linefeed::link {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

template <typename Kind>
bool has(const session::Effects& effects) {
    return std::ranges::any_of(effects, [](const auto& effect) { return std::holds_alternative<Kind>(effect); });
}

} // namespace

TcpLink::TcpLink(asio::io_context& context, session::Session& session, EffectHandler& handler)
    : socket_(context)
    , timer_(context)
    , session_(session)
    , handler_(handler) {}

Instant TcpLink::now() {
    return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

void TcpLink::connect(std::vector<asio::ip::tcp::endpoint> endpoints, Duration timeout) {
    endpoints_ = std::move(endpoints);
    connect_timeout_ = timeout;
    try_next_endpoint();
}

void TcpLink::try_next_endpoint() {
    if (endpoint_ == endpoints_.size()) {
        handler_.on_unreachable(last_error_);
        return;
    }
    error_code ignored;
    socket_.close(ignored);
    const std::size_t attempt = endpoint_++;
    timer_.expires_after(connect_timeout_);
    timer_.async_wait([this, attempt](const error_code& error) {
        if (!error && !open_ && attempt + 1 == endpoint_) {
            error_code close_error;
            socket_.close(close_error);
            last_error_ =
                "no connection within " +
                std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(connect_timeout_).count()) + " ms";
        }
    });
    socket_.async_connect(endpoints_[attempt], [this](const error_code& error) {
        timer_.cancel();
        if (given_up_) {
            return;
        }
        if (!error && socket_.is_open()) {
            connected();
            return;
        }
        if (error != asio::error::operation_aborted) {
            last_error_ = error.message();
        }
        try_next_endpoint();
    });
}

void TcpLink::connected() {
    open_ = true;
    error_code error;
    socket_.set_option(asio::ip::tcp::no_delay{true}, error);
    if (!error) {
        socket_.set_option(asio::socket_base::keep_alive{true}, error);
    }
    if (!error) {
        socket_.non_blocking(true, error);
    }
    if (error) {
        broken();
        return;
    }
    read();
    call([](session::Session& session, Instant at, session::Effects& effects) { session.on_connected(at, effects); });
}

void TcpLink::read() {
    auto handler = [this](const error_code& error, std::size_t bytes) {
        if (!open_) {
            return;
        }
        if (error) {
            broken();
            return;
        }
        call([this, bytes](session::Session& session, Instant at, session::Effects& effects) {
            session.on_received({received_.data(), bytes}, at, effects);
        });
        if (open_) {
            read();
        }
    };
    socket_.async_read_some(asio::buffer(received_), asio::bind_allocator(HandlerAllocator<>{memory_}, handler));
}

void TcpLink::carry_out(session::Effects& effects) {
    while (!effects.empty()) {
        // The printer first: nothing else is as urgent, and nothing else waits for the write to be done.
        const bool written = has<session::Write>(effects) && open_ && write();
        const Instant written_at = written ? now() : Instant{};
        for (const session::Effect& effect : effects) {
            if (!std::holds_alternative<session::Write>(effect) &&
                !std::holds_alternative<session::CloseLink>(effect)) {
                handler_.on_effect(effect);
            }
        }
        const bool closing = has<session::CloseLink>(effects);
        effects.clear();
        if (written) {
            session_.on_written(written_at, effects);
        }
        if (closing) {
            close();
        }
    }
}

bool TcpLink::write() {
    const session::WritePieces pieces = session_.pieces();
    write_next_ = 0;
    write_end_ = 0;
    for (const std::string_view piece : pieces) {
        write_buffers_[write_end_++] = asio::buffer(piece);
    }
    return continue_write();
}

bool TcpLink::continue_write() {
    while (write_next_ < write_end_) {
        error_code error;
        std::size_t written =
            socket_.write_some(std::span{write_buffers_}.subspan(write_next_, write_end_ - write_next_), error);
        if (error == asio::error::would_block || error == asio::error::try_again) {
            wait_until_writable();
            return false;
        }
        if (error) {
            return false; // the pending read reports the broken connection
        }
        while (written > 0) {
            asio::const_buffer& first = write_buffers_[write_next_];
            const std::size_t taken = std::min(written, first.size());
            first += taken;
            written -= taken;
            if (first.size() == 0) {
                ++write_next_;
            }
        }
    }
    return true;
}

void TcpLink::wait_until_writable() {
    auto handler = [this](const error_code& error) {
        if (!open_ || error) {
            return;
        }
        if (continue_write()) {
            call([](session::Session& session, Instant at, session::Effects& effects) {
                session.on_written(at, effects);
            });
        }
    };
    socket_.async_wait(asio::ip::tcp::socket::wait_write, asio::bind_allocator(HandlerAllocator<>{memory_}, handler));
}

void TcpLink::broken() {
    close();
    call([](session::Session& session, Instant at, session::Effects& effects) { session.on_closed(at, effects); });
}

void TcpLink::close() {
    open_ = false;
    error_code ignored;
    given_up_ = true;
    // Closing with unread bytes resets the connection, which could cost the printer our last command: shut down and
    // read them first.
    socket_.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    constexpr int reads_at_most = 16;
    for (int i = 0; i < reads_at_most && !ignored; ++i) {
        static_cast<void>(socket_.read_some(asio::buffer(received_), ignored));
    }
    socket_.close(ignored);
    timer_.cancel();
    armed_.reset();
}

void TcpLink::abort() {
    given_up_ = true;
    close();
}

void TcpLink::arm_timer() {
    const auto wake = session_.next_wake();
    if (!open_ || !wake || (armed_ && *armed_ <= *wake)) {
        return; // an earlier wake-up will look again
    }
    armed_ = wake;
    timer_.expires_at(std::chrono::steady_clock::time_point{wake->time_since_epoch()});
    auto handler = [this](const error_code& error) {
        if (error || !open_) {
            return;
        }
        armed_.reset();
        call([](session::Session& session, Instant at, session::Effects& effects) { session.on_time(at, effects); });
    };
    timer_.async_wait(asio::bind_allocator(HandlerAllocator<>{memory_}, handler));
}

} // namespace linefeed::link
