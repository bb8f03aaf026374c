// Opens the way to a printer, whatever it is: a TCP connection or a serial line.
#pragma once

#include "base/time.hpp"
#include "link/channel.hpp"
#include "link/printer_address.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <functional>
#include <string>

namespace linefeed::link {

/// Flow: dial() once; `done` is called once, from within the context, unless cancel() comes before. Lives on the
/// context's thread, as long as anything of it is under way there.
class Dialer {
public:
    /// The channel is open, or the reason says why not.
    using Done = std::function<void(Channel channel, const std::string& reason)>;

    explicit Dialer(boost::asio::io_context& context);

    /// Tries TCP endpoints in turn, each for at most `timeout`; a serial port opens at once or not at all.
    void dial(Endpoints endpoints, Duration timeout, Done done);
    void cancel();

private:
    void try_next_endpoint();
    void connected(const boost::system::error_code& error);
    void finish(Channel channel, const std::string& reason);

    boost::asio::io_context& context_;
    boost::asio::ip::tcp::socket socket_;
    boost::asio::steady_timer timer_;
    Endpoints endpoints_;
    std::size_t next_ = 0;
    Duration timeout_{};
    std::string reason_ = "it has no address";
    Done done_;
};

} // namespace linefeed::link
