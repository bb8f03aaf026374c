// Bytes to and from a printer over whatever leads there, so that nobody behind it has to know the difference. Two kinds
// in one, since only a socket can be told not to raise SIGPIPE.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

#include <cstddef>
#include <utility>
#include <variant>

namespace linefeed::link {

/// An AsyncReadStream and AsyncWriteStream that does not block. Closed unless made of something open.
class Channel {
public:
    using Socket = boost::asio::ip::tcp::socket;
    using Port = boost::asio::posix::stream_descriptor;
    using executor_type = Socket::executor_type;

    explicit Channel(boost::asio::io_context& context)
        : place_(Socket{context}) {}
    explicit Channel(Socket socket)
        : place_(std::move(socket)) {}
    explicit Channel(Port port)
        : place_(std::move(port)) {}

    [[nodiscard]] executor_type get_executor() {
        return std::visit([](auto& place) { return place.get_executor(); }, place_);
    }
    [[nodiscard]] bool is_open() const {
        return std::visit([](const auto& place) { return place.is_open(); }, place_);
    }

    template <typename Buffers>
    std::size_t write_some(const Buffers& buffers, boost::system::error_code& error) {
        return std::visit([&](auto& place) { return place.write_some(buffers, error); }, place_);
    }
    template <typename Buffers, typename Handler>
    void async_read_some(const Buffers& buffers, Handler&& handler) {
        std::visit([&](auto& place) { place.async_read_some(buffers, std::forward<Handler>(handler)); }, place_);
    }
    template <typename Buffers, typename Handler>
    void async_write_some(const Buffers& buffers, Handler&& handler) {
        std::visit([&](auto& place) { place.async_write_some(buffers, std::forward<Handler>(handler)); }, place_);
    }
    /// Calls the handler when bytes can be written.
    template <typename Handler>
    void async_wait_writable(Handler&& handler) {
        std::visit([&](auto& place) { place.async_wait(place.wait_write, std::forward<Handler>(handler)); }, place_);
    }
    /// What is under way ends with an error.
    void cancel();
    /// How many bytes wait to go out of a serial port, as far as its driver tells; 0 for TCP.
    [[nodiscard]] int bytes_waiting();
    /// Closes it so that what was sent last arrives: TCP would reset a connection with unread bytes, which could cost
    /// the printer our last command. On a serial line, what has not gone out by now is thrown away: closing would wait
    /// for it, for a printer that is switched off half a minute.
    void hang_up();

private:
    std::variant<Socket, Port> place_;
};

} // namespace linefeed::link
