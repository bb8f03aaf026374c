// Listening and accepting, see server.hpp.
#include "simulator/server.hpp"

#include "simulator/client_session.hpp"
#include "simulator/serial_line.hpp"

#include <boost/asio/error.hpp>

#include <utility>
#include <vector>

namespace linefeed::simulator {

using boost::asio::ip::tcp;
using boost::system::error_code;

Server::Server(boost::asio::io_context& io, ServerHandler& handler, ServerSettings settings)
    : io_(io)
    , handler_(handler)
    , settings_(settings)
    , acceptor_(io)
    , retry_(io) {}

Server::~Server() = default;

Result<std::string> Server::listen(const std::string& host, const std::string& port) {
    const auto failed = [&](const error_code& error) {
        return Failure{FailureKind::unreachable, "cannot listen on " + host + ":" + port + ": " + error.message()};
    };
    error_code error;
    tcp::resolver resolver{io_};
    const auto found = resolver.resolve(host, port, tcp::resolver::passive, error);
    if (error) {
        return failed(error);
    }
    const tcp::endpoint endpoint = *found.begin();
    acceptor_.open(endpoint.protocol(), error);
    if (!error) {
        acceptor_.set_option(tcp::acceptor::reuse_address{true}, error);
    }
    if (!error) {
        acceptor_.bind(endpoint, error);
    }
    if (!error) {
        acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
    }
    if (error) {
        return failed(error);
    }
    accept();
    const tcp::endpoint bound = acceptor_.local_endpoint();
    const std::string address = bound.address().to_string();
    return (bound.address().is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(bound.port());
}

Result<void> Server::open_serial() {
    if (!settings_.serial) {
        return {};
    }
    serial_ = std::make_unique<SerialLine>(io_, handler_, serial_id, *settings_.serial, settings_.escapes,
                                           settings_.reply_delay);
    return serial_->open();
}

void Server::accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
        if (error == boost::asio::error::operation_aborted) {
            return;
        }
        if (error) {
            // Out of descriptors, say: try again when some may have been closed.
            retry_.expires_after(std::chrono::milliseconds{100});
            retry_.async_wait([this](const error_code& stopped) {
                if (!stopped) {
                    accept();
                }
            });
            return;
        }
        accepted(std::move(socket));
        accept();
    });
}

void Server::accepted(tcp::socket socket) {
    const ConnectionId id{next_id_++};
    auto session = std::make_shared<ClientSession>(std::move(socket), *this, id);
    sessions_.emplace(id, session);
    handler_.on_connected(id);
    session->start();
}

std::size_t Server::connections() const {
    return sessions_.size() + (serial_ && serial_->in_use() ? 1 : 0);
}

void Server::send(ConnectionId connection, std::string bytes) {
    if (is_serial(connection)) {
        serial_->send(bytes);
        return;
    }
    if (const auto found = sessions_.find(connection); found != sessions_.end()) {
        found->second->send(std::move(bytes));
    }
}

void Server::read_available() {
    if (serial_) {
        serial_->read_available();
    }
    if (sessions_.size() == 1) { // the usual case, without allocation
        const auto session = sessions_.begin()->second;
        session->read_available();
        return;
    }
    std::vector<std::shared_ptr<ClientSession>> all; // a session that finds its connection closed leaves the map
    for (const auto& [id, session] : sessions_) {
        all.push_back(session);
    }
    for (const auto& session : all) {
        session->read_available();
    }
}

void Server::close_connections() {
    if (serial_) {
        serial_->replug();
    }
    while (!sessions_.empty()) {
        const auto session = sessions_.begin()->second;
        session->close();
    }
}

void Server::close() {
    error_code ignored;
    acceptor_.close(ignored);
    retry_.cancel();
    serial_.reset();
    close_connections();
}

void Server::forget(ConnectionId connection) {
    if (sessions_.erase(connection) > 0) {
        handler_.on_disconnected(connection);
    }
}

} // namespace linefeed::simulator
