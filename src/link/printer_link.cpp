#include "link/printer_link.hpp"

#include "link/serial_port.hpp"

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

PrinterLink::PrinterLink(asio::io_context& context, session::Session& session, EffectHandler& handler)
    : dialer_(context)
    , channel_(context)
    , timer_(context)
    , drain_timer_(context)
    , session_(session)
    , handler_(handler) {}

Instant PrinterLink::now() {
    return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

void PrinterLink::connect(Endpoints endpoints, Duration timeout) {
    if (endpoints.serial) {
        byte_time_ = std::chrono::duration_cast<Duration>(
            std::chrono::duration<double>{1.0 / bytes_per_second(*endpoints.serial)});
    }
    dialer_.dial(std::move(endpoints), timeout, [this](Channel channel, const std::string& reason) {
        if (channel.is_open()) {
            connected(std::move(channel));
        } else {
            handler_.on_unreachable(reason);
        }
    });
}

void PrinterLink::connected(Channel channel) {
    channel_ = std::move(channel);
    open_ = true;
    read();
    call([](session::Session& session, Instant at, session::Effects& effects) { session.on_connected(at, effects); });
}

void PrinterLink::read() {
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
    channel_.async_read_some(asio::buffer(received_), asio::bind_allocator(HandlerAllocator<>{memory_}, handler));
}

void PrinterLink::carry_out(session::Effects& effects) {
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

bool PrinterLink::write() {
    const session::WritePieces pieces = session_.pieces();
    write_next_ = 0;
    write_end_ = 0;
    for (const std::string_view piece : pieces) {
        write_buffers_[write_end_++] = asio::buffer(piece);
    }
    return continue_write();
}

bool PrinterLink::continue_write() {
    while (write_next_ < write_end_) {
        error_code error;
        std::size_t written =
            channel_.write_some(std::span{write_buffers_}.subspan(write_next_, write_end_ - write_next_), error);
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
    return gone_out();
}

void PrinterLink::wait_until_writable() {
    auto handler = [this](const error_code& error) { write_on(error); };
    channel_.async_wait_writable(asio::bind_allocator(HandlerAllocator<>{memory_}, handler));
}

bool PrinterLink::gone_out() {
    const int waiting = channel_.bytes_waiting();
    if (waiting == 0) {
        return true;
    }
    constexpr Duration look_at_least = std::chrono::milliseconds{1};
    drain_timer_.expires_after(std::max(look_at_least, waiting * byte_time_));
    auto handler = [this](const error_code& error) { write_on(error); };
    drain_timer_.async_wait(asio::bind_allocator(HandlerAllocator<>{memory_}, handler));
    return false;
}

void PrinterLink::write_on(const error_code& error) {
    if (open_ && !error && continue_write()) {
        call([](session::Session& session, Instant at, session::Effects& effects) { session.on_written(at, effects); });
    }
}

void PrinterLink::broken() {
    close();
    call([](session::Session& session, Instant at, session::Effects& effects) { session.on_closed(at, effects); });
}

void PrinterLink::close() {
    open_ = false;
    channel_.hang_up();
    timer_.cancel();
    drain_timer_.cancel();
    armed_.reset();
}

void PrinterLink::abort() {
    dialer_.cancel();
    close();
}

void PrinterLink::arm_timer() {
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
