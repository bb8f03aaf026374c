#include "link/channel.hpp"

#include "link/serial_port.hpp"

#include <boost/asio/buffer.hpp>

#include <array>

namespace linefeed::link {

using boost::system::error_code;

namespace {

void hang_up(Channel::Socket& socket) {
    error_code ignored;
    socket.shutdown(Channel::Socket::shutdown_send, ignored);
    constexpr int reads_at_most = 16;
    std::array<char, 4096> unread{};
    for (int i = 0; i < reads_at_most && !ignored; ++i) {
        static_cast<void>(socket.read_some(boost::asio::buffer(unread), ignored));
    }
    socket.close(ignored);
}

void hang_up(Channel::Port& port) {
    if (port.is_open() && bytes_waiting(port.native_handle()) > 0) {
        discard_waiting(port.native_handle());
    }
    error_code ignored;
    port.close(ignored);
}

} // namespace

void Channel::cancel() {
    error_code ignored;
    std::visit([&](auto& place) { place.cancel(ignored); }, place_);
}

int Channel::bytes_waiting() {
    Port* const port = std::get_if<Port>(&place_);
    return port != nullptr && port->is_open() ? link::bytes_waiting(port->native_handle()) : 0;
}

void Channel::hang_up() {
    std::visit([](auto& place) { link::hang_up(place); }, place_);
}

} // namespace linefeed::link
