// The printer's RS-232 side: a pseudo-terminal on which every byte takes its time, and may be damaged or lost on the
// way. Asio callbacks in one thread; what the frames mean is the business of the handler.
#pragma once

#include "base/failure.hpp"
#include "protocol/frame_decoder.hpp"
#include "simulator/server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace linefeed::simulator {

/// Flow: open(); then the io_context runs it. close() ends everything.
class SerialLine {
public:
    /// `handler` hears of the line as of connection `id`. Both outlive the line.
    SerialLine(boost::asio::io_context& io, ServerHandler& handler, ConnectionId id, SerialSettings settings,
               protocol::EscapeMode escapes, Duration reply_delay);
    ~SerialLine();
    SerialLine(const SerialLine&) = delete;
    SerialLine& operator=(const SerialLine&) = delete;

    /// Makes the terminal and the link to it. FailureKind::unreachable if that cannot be.
    [[nodiscard]] Result<void> open();
    /// Puts an answer on the line. What a host does not take in is lost in the end, as on a real line.
    void send(std::string_view bytes);
    /// Takes in what has arrived by now.
    void read_available();
    /// As if the adapter were pulled out, and plugged in again a second later.
    void replug();
    void close();
    /// Somebody has the port open.
    [[nodiscard]] bool in_use() const { return in_use_; }

private:
    [[nodiscard]] Result<void> make_terminal();
    void wait_for_bytes();
    void wait_for_host();
    void receive();
    void take(std::string_view bytes);
    void wait_to_send();
    void transmit();
    /// The bytes as they come out at the other end.
    [[nodiscard]] std::string over_the_line(std::string_view bytes);
    [[nodiscard]] bool draws(std::uint64_t one_in);
    void set_in_use(bool in_use);

    /// Answers wait for the line up to this; the printer stops answering then.
    static constexpr std::size_t max_waiting_bytes = std::size_t{1} << 20U;

    ServerHandler& handler_;
    ConnectionId id_;
    SerialSettings settings_;
    Duration reply_delay_;
    Duration byte_time_;
    std::uint64_t draw_;
    protocol::FrameDecoder decoder_;
    boost::asio::posix::stream_descriptor terminal_;
    boost::asio::steady_timer receive_timer_;
    boost::asio::steady_timer send_timer_;
    boost::asio::steady_timer plug_timer_;
    bool receiving_ = false;   ///< bytes are on the way in
    Instant received_until_{}; ///< the bytes that had arrived by then have been taken
    std::string waiting_;      ///< to be sent
    bool sending_ = false;
    Instant sent_until_{}; ///< the line is free from then on
    bool in_use_ = false;
    bool closed_ = false;
};

} // namespace linefeed::simulator
