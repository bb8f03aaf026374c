// The printer's interfaces: a listening socket with any number of clients and perhaps a serial line, frames in and
// bytes out. Asio callbacks in one thread; what the frames mean is the business of the handler.
#pragma once

#include "base/failure.hpp"
#include "protocol/frame_decoder.hpp"
#include "simulator/printer_effects.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace linefeed::simulator {

/// What the server tells. Called in the thread of the io_context.
class ServerHandler {
public:
    virtual ~ServerHandler() = default;
    virtual void on_connected(ConnectionId connection) = 0;
    /// `now` is when the bytes were read.
    virtual void on_frame(ConnectionId connection, const protocol::Frame& frame, Instant now) = 0;
    virtual void on_damaged_bytes(ConnectionId connection) = 0;
    virtual void on_disconnected(ConnectionId connection) = 0;
};

/// The RS-232 side, if there is one.
struct SerialSettings {
    std::string link; ///< where the terminal's device can be found
    std::uint32_t baud = 115200;
    std::uint64_t one_damaged_in = 0; ///< bytes, each way; 0 = none
    std::uint64_t one_lost_in = 0;    ///< bytes, each way; 0 = none
    std::uint64_t seed = 1;           ///< of the damage
};

/// How it answers.
struct ServerSettings {
    protocol::EscapeMode escapes = protocol::EscapeMode::backslash;
    Duration reply_delay{}; ///< each answer waits so long; the order is kept
    std::optional<SerialSettings> serial;
};

class ClientSession;
class SerialLine;

/// Flow: listen(); then the io_context runs it. close() ends everything.
class Server {
public:
    Server(boost::asio::io_context& io, ServerHandler& handler, ServerSettings settings);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Binds to HOST:PORT (port 0: any free one) and begins to accept. The address it listens on, as HOST:PORT.
    [[nodiscard]] Result<std::string> listen(const std::string& host, const std::string& port);
    /// Makes the serial line, if the settings have one.
    [[nodiscard]] Result<void> open_serial();
    /// Sends bytes to a client; nothing if it is gone.
    void send(ConnectionId connection, std::string bytes);
    /// Reads what has arrived on all connections, now.
    void read_available();
    /// Closes all connections; new ones are accepted. The serial line is pulled out, and plugged in again after a
    /// while.
    void close_connections();
    /// Closes everything.
    void close();
    [[nodiscard]] std::size_t connections() const;
    [[nodiscard]] static bool is_serial(ConnectionId connection) { return connection == serial_id; }

private:
    friend class ClientSession;
    void accept();
    void accepted(boost::asio::ip::tcp::socket socket);
    void forget(ConnectionId connection);

    static constexpr ConnectionId serial_id{0};

    boost::asio::io_context& io_;
    ServerHandler& handler_;
    ServerSettings settings_;
    boost::asio::ip::tcp::acceptor acceptor_;
    boost::asio::steady_timer retry_;
    std::map<ConnectionId, std::shared_ptr<ClientSession>> sessions_;
    std::unique_ptr<SerialLine> serial_;
    std::uint64_t next_id_ = 1;
};

} // namespace linefeed::simulator
