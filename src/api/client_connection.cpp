#include "api/client_connection.hpp"

#include "link/printer_address.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>

#include <fstream>

namespace linefeed::api {

namespace http = boost::beast::http;
using boost::system::error_code;
using Socket = boost::asio::generic::stream_protocol::socket;

namespace {

constexpr std::size_t piece_bytes = std::size_t{64} << 10U;

} // namespace

class ClientConnection::Impl {
public:
    Impl(ServiceAddress address, Duration connect_timeout)
        : address_(std::move(address))
        , connect_timeout_(connect_timeout) {}

    Result<WireReply> exchange(const WireRequest& request, Duration timeout) {
        auto reply = open(request, timeout);
        if (!reply || reply->status != 200) {
            return reply;
        }
        if (auto read = read_body(*reply, timeout); !read) {
            return read.error();
        }
        return reply;
    }

    Result<WireReply> open(const WireRequest& request, Duration timeout) {
        sent_ = false;
        if (!socket_.is_open()) {
            if (auto connected = connect(); !connected) {
                return connected.error();
            }
        }
        const auto sent = send(request, timeout);
        if (!sent && sent.error().kind == FailureKind::input) {
            close();
            return sent.error();
        }
        parser_.emplace(); // also after a failed write: the service may have said why it reads no further
        parser_->body_limit(boost::none);
        const error_code error =
            wait(timeout, [&](auto done) { http::async_read_header(socket_, buffer_, *parser_, std::move(done)); });
        if (error) {
            return lost(sent ? error.message() : sent.error().message);
        }
        const auto& head = parser_->get();
        WireReply reply{static_cast<int>(head.result_int()), std::string{head[http::field::content_type]},
                        head.count("Idempotency-Replayed") > 0, ""};
        if (reply.status != 200) {
            if (auto read = read_body(reply, timeout); !read) {
                return read.error();
            }
        }
        return reply;
    }

    Result<std::string> read_piece(Duration timeout) {
        if (parser_->is_done()) {
            finish();
            return std::string{};
        }
        std::string piece(piece_bytes, '\0');
        auto& body = parser_->get().body();
        body.data = piece.data();
        body.size = piece.size();
        // What has come is wanted at once, not when the piece is full.
        error_code error =
            wait(timeout, [&](auto done) { http::async_read_some(socket_, buffer_, *parser_, std::move(done)); });
        if (error && error != http::error::need_buffer) {
            return lost(error.message());
        }
        piece.resize(piece.size() - parser_->get().body().size);
        return piece.empty() ? read_piece(timeout) : Result<std::string>{std::move(piece)};
    }

    void close() {
        error_code ignored;
        socket_.close(ignored);
        buffer_.clear();
    }

    [[nodiscard]] bool is_open() const { return socket_.is_open(); }
    [[nodiscard]] bool was_sent() const { return sent_; }

private:
    /// Starts something and waits for its end, at most for `timeout`.
    template <typename Start>
    error_code wait(Duration timeout, Start&& start) {
        std::optional<error_code> result;
        start([&result](const error_code& error, auto&&...) { result = error; });
        context_.restart();
        context_.run_for(timeout);
        if (result) {
            return *result;
        }
        close();
        context_.restart();
        context_.run();
        return boost::asio::error::timed_out;
    }

    Failure lost(const std::string& why) {
        close();
        return {FailureKind::unreachable,
                "the connection to the service at " + to_string(address_) + " was lost: " + why};
    }

    Result<void> connect() {
        error_code error;
        if (address_.socket.empty()) {
            const auto endpoints = link::resolve(link::TcpAddress{address_.host, address_.port});
            if (!endpoints) {
                return endpoints.error();
            }
            for (const auto& endpoint : *endpoints) {
                close();
                error = wait(connect_timeout_, [&](auto done) { socket_.async_connect(endpoint, std::move(done)); });
                if (!error) {
                    return {};
                }
            }
        } else {
            const boost::asio::local::stream_protocol::endpoint endpoint{address_.socket.string()};
            error = wait(connect_timeout_, [&](auto done) { socket_.async_connect(endpoint, std::move(done)); });
            if (!error) {
                return {};
            }
        }
        close();
        const char* const advice = error == boost::asio::error::access_denied
                                       ? ": you are not in the group of the socket (control.group)"
                                       : ": is linefeedd running, and is that its address?";
        return Failure{FailureKind::unreachable,
                       "the service is not reached at " + to_string(address_) + " (" + error.message() + ')' + advice};
    }

    [[nodiscard]] std::string head_of(const WireRequest& request, std::uint64_t length) const {
        const bool ipv6 = address_.host.find(':') != std::string::npos;
        const std::string host = address_.socket.empty() ? (ipv6 ? '[' + address_.host + ']' : address_.host) + ':' +
                                                               std::to_string(address_.port)
                                                         : "localhost";
        std::string head = request.method + ' ' + request.target + " HTTP/1.1\r\nHost: " + host + "\r\n";
        for (const auto& [name, value] : request.fields) {
            head.append(name).append(": ").append(value).append("\r\n");
        }
        if (request.method != "GET") {
            head += "Content-Length: " + std::to_string(length) + "\r\n";
        }
        return head + "\r\n";
    }

    Result<void> write(std::string_view bytes, Duration timeout) {
        const error_code error = wait(timeout, [&](auto done) {
            boost::asio::async_write(socket_, boost::asio::buffer(bytes.data(), bytes.size()), std::move(done));
        });
        return error ? Result<void>{Failure{FailureKind::unreachable, error.message()}} : Result<void>{};
    }

    Result<void> send(const WireRequest& request, Duration timeout) {
        if (!request.file) {
            sent_ = true;
            return write(head_of(request, request.body.size()) + request.body, timeout);
        }
        std::ifstream file{*request.file, std::ios::binary | std::ios::ate};
        const auto size = file ? static_cast<std::int64_t>(file.tellg()) : -1;
        file.seekg(0);
        const auto unreadable = [&] { return Failure{FailureKind::input, "cannot read " + request.file->string()}; };
        if (size < 0 || !file) {
            return unreadable();
        }
        sent_ = true;
        auto written = write(head_of(request, static_cast<std::uint64_t>(size)), timeout);
        std::string piece(piece_bytes, '\0');
        for (std::int64_t left = size; left > 0 && written;) {
            const auto wanted = std::min<std::int64_t>(left, static_cast<std::int64_t>(piece_bytes));
            if (!file.read(piece.data(), wanted)) { // it has become shorter
                return unreadable();
            }
            written = write({piece.data(), static_cast<std::size_t>(wanted)}, timeout);
            left -= wanted;
        }
        return written;
    }

    Result<void> read_body(WireReply& reply, Duration timeout) {
        for (;;) {
            auto piece = read_piece(timeout);
            if (!piece) {
                return piece.error();
            }
            if (piece->empty()) {
                return {};
            }
            reply.body += *piece;
            if (reply.body.size() > max_reply_bytes) {
                return lost("the answer is too long");
            }
        }
    }

    void finish() {
        if (!parser_->get().keep_alive()) {
            close();
        }
    }

    ServiceAddress address_;
    Duration connect_timeout_;
    boost::asio::io_context context_;
    Socket socket_{context_};
    boost::beast::flat_buffer buffer_;
    std::optional<http::response_parser<http::buffer_body>> parser_;
    bool sent_ = false;
};

ClientConnection::ClientConnection(ServiceAddress address, Duration connect_timeout)
    : impl_(std::make_unique<Impl>(std::move(address), connect_timeout)) {}

ClientConnection::~ClientConnection() = default;

Result<WireReply> ClientConnection::exchange(const WireRequest& request, Duration answer_timeout) {
    return impl_->exchange(request, answer_timeout);
}

Result<WireReply> ClientConnection::open(const WireRequest& request, Duration answer_timeout) {
    return impl_->open(request, answer_timeout);
}

Result<std::string> ClientConnection::read_piece(Duration timeout) {
    return impl_->read_piece(timeout);
}

bool ClientConnection::is_open() const {
    return impl_->is_open();
}

void ClientConnection::close() {
    impl_->close();
}

bool ClientConnection::was_sent() const {
    return impl_->was_sent();
}

} // namespace linefeed::api
