#include "printer/printer_client.hpp"

#include "protocol/frame_encoder.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>

#include <utility>

namespace linefeed::printer {

namespace asio = boost::asio;
using boost::system::error_code;
using protocol::Message;
using protocol::Parameter;

namespace {

/// Whether it answers `?XX`.
bool answers(const Message& message, Parameter what) {
    switch (what) {
    case Parameter::RS:
        return std::holds_alternative<protocol::MachineStatus>(message);
    case Parameter::SM:
        return std::holds_alternative<protocol::MailStatus>(message);
    case Parameter::CC:
        return std::holds_alternative<protocol::Counters>(message);
    case Parameter::VS:
        return std::holds_alternative<protocol::VersionInfo>(message);
    case Parameter::JL:
        return std::holds_alternative<protocol::JobName>(message);
    default:
        return false;
    }
}

} // namespace

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

std::optional<Message> PrinterClient::ask_for(Parameter what) {
    std::string inquiry;
    protocol::append_inquiry(inquiry, what);
    if (!write(inquiry)) {
        return std::nullopt;
    }
    const auto deadline = Clock::now() + settings_.reply_timeout;
    while (open_ && Clock::now() < deadline) {
        std::string_view bytes = read(deadline);
        std::optional<Message> answer;
        while (!bytes.empty() && !answer) {
            auto message = next_message(bytes);
            if (message && answers(*message, what)) {
                answer = std::move(message);
            }
        }
        while (!bytes.empty()) { // what came behind it
            static_cast<void>(next_message(bytes));
        }
        if (answer) {
            return answer;
        }
    }
    return std::nullopt;
}

bool PrinterClient::write(const std::string& bytes) {
    if (!open_) {
        return false;
    }
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
    return bytes;
}

/// The next frame in `bytes` that is not damaged, if there is one; takes bytes from the front.
std::optional<Message> PrinterClient::next_message(std::string_view& bytes) {
    const protocol::DecodeResult result = decoder_.next(bytes);
    if (const auto* damage = std::get_if<protocol::FrameError>(&result)) {
        oddities_.damaged_bytes += damage->bytes;
        return std::nullopt;
    }
    const auto* const frame = std::get_if<protocol::Frame>(&result);
    if (frame == nullptr) {
        return std::nullopt;
    }
    oddities_.lengths = oddities_.lengths || frame->has_length;
    Message message = protocol::parse_message(*frame, settings_.escapes);
    if (const auto* malformed = std::get_if<protocol::MalformedMessage>(&message)) {
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
