#include "printer/printer_client.hpp"

#include "protocol/frame_encoder.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>

#include <utility>

namespace linefeed::printer {

namespace asio = boost::asio;
using boost::system::error_code;
using protocol::Message;

PrinterClient::PrinterClient(const ClientSettings& settings)
    : settings_(settings)
    , decoder_(settings.escapes) {}

/// Closing with unread bytes would reset the connection, which could cost the printer the last command.
PrinterClient::~PrinterClient() {
    error_code ignored;
    socket_.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    constexpr int reads_at_most = 16;
    socket_.non_blocking(true, ignored);
    for (int i = 0; i < reads_at_most && !ignored; ++i) {
        static_cast<void>(socket_.read_some(asio::buffer(buffer_), ignored));
    }
    socket_.close(ignored);
}

Result<std::unique_ptr<PrinterClient>> PrinterClient::connect(const ClientSettings& settings) {
    std::unique_ptr<PrinterClient> client{new PrinterClient{settings}};
    std::string problem = "it has no address";
    for (const auto& endpoint : settings.endpoints) {
        problem = client->connect_to(endpoint);
        if (problem.empty()) {
            return client;
        }
    }
    return Failure{FailureKind::unreachable, settings.address + ": " + problem};
}

/// What is wrong; empty = it is connected.
std::string PrinterClient::connect_to(const asio::ip::tcp::endpoint& endpoint) {
    error_code result = asio::error::would_block;
    error_code ignored;
    socket_.close(ignored);
    socket_.async_connect(endpoint, [&result](const error_code& error) { result = error; });
    context_.restart();
    context_.run_for(settings_.connect_timeout);
    if (result == asio::error::would_block) {
        socket_.close(ignored);
        context_.restart();
        context_.run();
        const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(settings_.connect_timeout);
        return "no connection within " + std::to_string(ms.count()) + " ms";
    }
    if (result) {
        return result.message();
    }
    socket_.set_option(asio::ip::tcp::no_delay{true}, ignored);
    open_ = true;
    return {};
}

bool PrinterClient::send(protocol::Action action) {
    std::string bytes;
    protocol::append_action(bytes, action);
    return write(bytes);
}

std::string PrinterClient::frame_of(const Message& message) const {
    std::string bytes;
    protocol::append_any_message(bytes, message, settings_.escapes);
    return bytes;
}

bool PrinterClient::converse(const std::string& bytes, const Listener& listener) {
    return converse(bytes, listener, settings_.reply_timeout);
}

bool PrinterClient::converse(const std::string& bytes, const Listener& listener, Duration reply_timeout) {
    if (!bytes.empty() && !write(bytes)) {
        return false;
    }
    auto deadline = Clock::now() + reply_timeout;
    while (open_ && Clock::now() < deadline) {
        bool prolonged = false;
        if (hear(read(deadline), listener, prolonged)) {
            return true;
        }
        if (prolonged) {
            deadline = Clock::now() + reply_timeout;
        }
    }
    return false;
}

/// What stands behind the answer is decoded, but nobody is listening any more.
bool PrinterClient::hear(std::string_view bytes, const Listener& listener, bool& prolonged) {
    bool done = false;
    for (auto result = decoder_.next(bytes); result.index() != 0; result = decoder_.next(bytes)) {
        if (const auto* const damage = std::get_if<protocol::FrameError>(&result)) {
            oddities_.damaged_bytes += damage->bytes;
        } else if (const auto* const frame = std::get_if<protocol::Frame>(&result)) {
            const Message message = message_of(*frame);
            const Heard heard = done ? Heard::ignored : listener(message, frame->raw);
            done = done || heard == Heard::done;
            prolonged = prolonged || heard == Heard::more;
        }
    }
    return done;
}

bool PrinterClient::write(const std::string& bytes) {
    if (!open_) {
        return false;
    }
    observer_(true, bytes);
    error_code result = asio::error::would_block;
    asio::async_write(socket_, asio::buffer(bytes),
                      [&result](const error_code& error, std::size_t) { result = error; });
    context_.restart();
    context_.run_for(settings_.reply_timeout);
    if (result) { // also where it takes no bytes at all
        error_code ignored;
        socket_.close(ignored);
        context_.restart();
        context_.run();
        open_ = false;
    }
    return open_;
}

/// Empty: nothing came, or the connection is closed.
std::string_view PrinterClient::read(Clock::time_point deadline) {
    error_code result = asio::error::would_block;
    std::size_t size = 0;
    socket_.async_read_some(asio::buffer(buffer_), [&](const error_code& error, std::size_t bytes) {
        result = error;
        size = bytes;
    });
    context_.restart();
    context_.run_until(deadline);
    if (result == asio::error::would_block) {
        error_code ignored;
        socket_.cancel(ignored);
        context_.restart();
        context_.run();
    } else if (result) {
        open_ = false;
    }
    const std::string_view bytes{buffer_.data(), size};
    note_filling(bytes);
    if (!bytes.empty()) {
        observer_(false, bytes);
    }
    return bytes;
}

Message PrinterClient::message_of(const protocol::Frame& frame) {
    oddities_.lengths = oddities_.lengths || frame.has_length;
    Message message = protocol::parse_message(frame, settings_.escapes);
    if (const auto* const malformed = std::get_if<protocol::MalformedMessage>(&message)) {
        oddities_.damaged_bytes += malformed->payload.size();
    }
    oddities_.echoes = oddities_.echoes || std::holds_alternative<protocol::ActionMessage>(message);
    return message;
}

void PrinterClient::note_filling(std::string_view bytes) {
    for (const char byte : bytes) {
        oddities_.filled = oddities_.filled || ((last_byte_ == '\r' || last_byte_ == '\n') && byte == ' ');
        last_byte_ = byte;
    }
}

} // namespace linefeed::printer
