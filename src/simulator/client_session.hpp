// One client of the simulated printer: its socket, its decoder, the answers that wait for it.
#pragma once

#include "simulator/server.hpp"

#include <array>
#include <deque>

namespace linefeed::simulator {

/// Flow: start(), send() as often as wanted, close(). Lives as long as an operation of its is under way.
class ClientSession : public std::enable_shared_from_this<ClientSession> {
public:
    ClientSession(boost::asio::ip::tcp::socket socket, Server& server, ConnectionId id);

    void start();
    void send(std::string bytes);
    /// Takes in what has arrived without waiting.
    void read_available();
    void close();

private:
    /// An answer and when it may go.
    struct DelayedReply {
        Instant due;
        std::string bytes;
    };

    /// A client that does not read for so long that more than this waits for it is dropped.
    static constexpr std::size_t max_waiting_bytes = std::size_t{4} << 20U;
    static constexpr std::size_t read_bytes = std::size_t{64} << 10U;
    /// So many reads at a time, so that one busy client cannot hold up the line.
    static constexpr int max_reads = 16;

    void read();
    void take(std::string_view bytes);
    void wait_for_delayed();
    void write(std::string bytes);
    void start_write();
    void close_if_done();

    boost::asio::ip::tcp::socket socket_;
    Server& server_;
    ConnectionId id_;
    protocol::FrameDecoder decoder_;
    boost::asio::steady_timer delay_timer_;
    std::deque<DelayedReply> delayed_;
    std::array<char, read_bytes> read_buffer_{};
    std::string waiting_; ///< to be written after what is being written
    std::string writing_;
    bool is_writing_ = false;
    bool ended_ = false; ///< the client sends no more, but may wait for answers
    bool closed_ = false;
};

} // namespace linefeed::simulator
