#include "link/dialer.hpp"

#include "link/serial_port.hpp"

#include <boost/asio/post.hpp>

#include <utility>

namespace linefeed::link {

namespace asio = boost::asio;
using boost::system::error_code;

Dialer::Dialer(asio::io_context& context)
    : context_(context)
    , socket_(context)
    , timer_(context) {}

void Dialer::dial(Endpoints endpoints, Duration timeout, Done done) {
    endpoints_ = std::move(endpoints);
    timeout_ = timeout;
    done_ = std::move(done);
    if (!endpoints_.serial) {
        try_next_endpoint();
        return;
    }
    const auto port = open_serial(*endpoints_.serial);
    reason_ = port ? "" : port.error().message;
    Channel channel = port ? Channel{Channel::Port{context_, *port}} : Channel{context_};
    asio::post(context_, [this, opened = std::move(channel)]() mutable { finish(std::move(opened), reason_); });
}

void Dialer::try_next_endpoint() {
    if (next_ == endpoints_.tcp.size()) {
        asio::post(context_, [this] { finish(Channel{context_}, reason_); });
        return;
    }
    error_code ignored;
    socket_.close(ignored);
    const std::size_t attempt = next_++;
    timer_.expires_after(timeout_);
    timer_.async_wait([this, attempt](const error_code& error) {
        if (!error && done_ && attempt + 1 == next_) {
            error_code close_error;
            socket_.close(close_error);
            const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout_);
            reason_ = "no connection within " + std::to_string(ms.count()) + " ms";
        }
    });
    socket_.async_connect(endpoints_.tcp[attempt], [this](const error_code& error) { connected(error); });
}

void Dialer::connected(const error_code& error) {
    timer_.cancel();
    if (!done_) {
        return;
    }
    if (error || !socket_.is_open()) {
        if (error != asio::error::operation_aborted) {
            reason_ = error.message();
        }
        try_next_endpoint();
        return;
    }
    error_code wrong;
    socket_.set_option(asio::ip::tcp::no_delay{true}, wrong);
    if (!wrong) {
        socket_.set_option(asio::socket_base::keep_alive{true}, wrong);
    }
    if (!wrong) {
        socket_.non_blocking(true, wrong);
    }
    if (wrong) {
        reason_ = wrong.message();
        try_next_endpoint();
        return;
    }
    finish(Channel{std::exchange(socket_, asio::ip::tcp::socket{context_})}, "");
}

void Dialer::finish(Channel channel, const std::string& reason) {
    if (const Done done = std::exchange(done_, nullptr)) {
        done(std::move(channel), reason);
    }
}

void Dialer::cancel() {
    done_ = nullptr;
    error_code ignored;
    socket_.close(ignored);
    timer_.cancel();
}

} // namespace linefeed::link
