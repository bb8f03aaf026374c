#include "printer/printer_client.hpp"

#include "link/serial_port.hpp"
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
    , decoder_(settings.profile.escapes)
    , secured_(settings.endpoints.crc)
    , line_({.bytes_per_second = settings.endpoints.serial ? link::bytes_per_second(*settings.endpoints.serial) : 0,
             .crc = true,
             .answer_takes = settings.reply_timeout}) {}

/// The last command may still be on its way out of a serial port.
PrinterClient::~PrinterClient() {
    const auto deadline = Clock::now() + settings_.reply_timeout;
    constexpr auto look_again = std::chrono::milliseconds{2};
    while (open_ && channel_.bytes_waiting() > 0 && Clock::now() < deadline) {
        context_.restart();
        context_.run_for(look_again);
    }
    channel_.hang_up();
}

Result<std::unique_ptr<PrinterClient>> PrinterClient::connect(const ClientSettings& settings) {
    std::unique_ptr<PrinterClient> client{new PrinterClient{settings}};
    std::string problem;
    link::Dialer dialer{client->context_};
    dialer.dial(settings.endpoints, settings.connect_timeout, [&](link::Channel channel, const std::string& reason) {
        client->channel_ = std::move(channel);
        problem = reason;
    });
    client->context_.run();
    client->open_ = client->channel_.is_open();
    if (!client->open_) {
        return Failure{FailureKind::unreachable, settings.address + ": " + problem};
    }
    return client;
}

bool PrinterClient::send(protocol::Action action) {
    std::string bytes;
    protocol::append_action(bytes, action);
    return deliver(bytes);
}

/// Nobody listens.
bool PrinterClient::deliver(const std::string& frame) {
    return secured_ ? exchange(frame, nullptr, settings_.reply_timeout) : write(frame);
}

std::string PrinterClient::frame_of(const Message& message) const {
    std::string bytes;
    protocol::append_any_message(bytes, message, settings_.profile.escapes);
    return bytes;
}

bool PrinterClient::converse(const std::string& bytes, const Listener& listener) {
    return converse(bytes, listener, settings_.reply_timeout);
}

bool PrinterClient::converse(const std::string& bytes, const Listener& listener, Duration reply_timeout) {
    oddities_.unreadable.clear();
    if (!secured_ || bytes.empty()) {
        return (bytes.empty() || write(bytes)) && listen(listener, reply_timeout);
    }
    std::string_view left{bytes};
    while (true) {
        const std::string_view frame = left.substr(0, left.find('\r') + 1);
        left.remove_prefix(frame.size());
        if (left.empty()) {
            return exchange(frame, listener, reply_timeout);
        }
        if (!exchange(frame, nullptr, reply_timeout)) {
            return false;
        }
    }
}

bool PrinterClient::listen(const Listener& listener, Duration reply_timeout) {
    // On a serial line a long frame takes longer than any time-out; but what never becomes a frame is no answer.
    const Duration longest_frame = time_on_line(protocol::max_frame_bytes);
    auto latest = Clock::now() + reply_timeout + longest_frame;
    auto deadline = Clock::now() + reply_timeout;
    while (open_ && Clock::now() < deadline) {
        const std::string_view bytes = read(deadline);
        const bool came = !bytes.empty();
        const Heard heard = hear(bytes, listener);
        if (heard == Heard::done) {
            return true;
        }
        if (heard == Heard::more) {
            latest = Clock::now() + reply_timeout + longest_frame;
        }
        if (heard == Heard::more || (settings_.endpoints.serial && came)) {
            deadline = std::min(Clock::now() + reply_timeout, latest);
        }
    }
    return false;
}

/// What stands behind the answer is decoded, but nobody is listening any more.
PrinterClient::Heard PrinterClient::hear(std::string_view bytes, const Listener& listener) {
    Heard most = Heard::ignored;
    for (auto result = decoder_.next(bytes); result.index() != 0; result = decoder_.next(bytes)) {
        if (const auto* const damage = std::get_if<protocol::FrameError>(&result)) {
            oddities_.damaged_bytes += damage->bytes;
        } else if (const auto* const frame = std::get_if<protocol::Frame>(&result)) {
            const Message message = message_of(*frame);
            const bool listened = listener != nullptr && most != Heard::done;
            const Heard heard = secured_   ? take_secured(*frame, message, listened ? listener : nullptr)
                                : listened ? listener(message, frame->raw)
                                           : Heard::ignored;
            most = std::max(most, heard);
        }
    }
    return most;
}

std::string PrinterClient::silence(std::string_view asked) const {
    const std::string of = settings_.address + ": the printer does not answer " + std::string{asked};
    if (!open_) {
        return settings_.address + ": the connection was lost while it was asked " + std::string{asked};
    }
    if (!oddities_.unreadable.empty()) {
        return settings_.address + ": the answer to " + std::string{asked} + " cannot be read: " + oddities_.unreadable;
    }
    if (oddities_.unsecured) {
        return of + " with CRC32: it is in standby, or its firmware knows no =NR; take crc=on out of its address";
    }
    if (oddities_.damaged_bytes > 0) {
        return of + ", but " + std::to_string(oddities_.damaged_bytes) +
               " bytes came that are no frame: another baud rate, a noisy line, or another device?";
    }
    return of + "; in standby, or with old firmware, it may not";
}

bool PrinterClient::write(const std::string& bytes) {
    if (!open_) {
        return false;
    }
    observer_(true, bytes);
    error_code result = asio::error::would_block;
    asio::async_write(channel_, asio::buffer(bytes),
                      [&result](const error_code& error, std::size_t) { result = error; });
    context_.restart();
    context_.run_for(settings_.reply_timeout + time_on_line(bytes.size()));
    if (result) { // also where it takes no bytes at all
        channel_.hang_up();
        context_.restart();
        context_.run();
        open_ = false;
    }
    return open_;
}

Duration PrinterClient::time_on_line(std::size_t bytes) const {
    const auto& serial = settings_.endpoints.serial;
    const std::chrono::duration<double> seconds{serial ? static_cast<double>(bytes) / link::bytes_per_second(*serial)
                                                       : 0.0};
    return std::chrono::duration_cast<Duration>(seconds);
}

/// Empty: nothing came, or the connection is closed.
std::string_view PrinterClient::read(Clock::time_point deadline) {
    error_code result = asio::error::would_block;
    std::size_t size = 0;
    channel_.async_read_some(asio::buffer(buffer_), [&](const error_code& error, std::size_t bytes) {
        result = error;
        size = bytes;
    });
    context_.restart();
    context_.run_until(deadline);
    if (result == asio::error::would_block) {
        channel_.cancel();
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
    Message message = protocol::parse_message(frame, settings_.profile.escapes);
    if (const auto* const malformed = std::get_if<protocol::MalformedMessage>(&message)) {
        oddities_.damaged_bytes += malformed->payload.size();
        oddities_.unreadable = malformed->reason;
    }
    const auto* const action = std::get_if<protocol::ActionMessage>(&message);
    const bool own = action != nullptr &&
                     (action->action == protocol::Action::crc_ok || action->action == protocol::Action::end_of_data);
    oddities_.echoes = oddities_.echoes || (action != nullptr && !own);
    return message;
}

void PrinterClient::note_filling(std::string_view bytes) {
    for (const char byte : bytes) {
        oddities_.filled = oddities_.filled || ((last_byte_ == '\r' || last_byte_ == '\n') && byte == ' ');
        last_byte_ = byte;
    }
}

} // namespace linefeed::printer
