#include "api/service_address.hpp"

#include "config/settings.hpp"
#include "link/printer_address.hpp"

namespace linefeed::api {

Result<ServiceAddress> parse_service_address(std::string_view text) {
    constexpr std::string_view unix_scheme = "unix:";
    if (text.starts_with(unix_scheme)) {
        text.remove_prefix(unix_scheme.size());
    }
    if (text.starts_with('/')) {
        return ServiceAddress{std::string{text}, "", 0};
    }
    // Written as the address of a printer is, but for the port that there is without one.
    const bool has_port =
        text.find(':', text.rfind(']') == std::string_view::npos ? text.find("//") : text.rfind(']')) !=
        std::string_view::npos;
    const auto tcp = link::parse_tcp_address(text);
    if (!tcp) {
        return Failure{FailureKind::usage, '"' + std::string{text} +
                                               "\" is not the address of a service: expected the path of its socket, "
                                               "e.g. /run/linefeed/linefeed.sock, or tcp://HOST:PORT"};
    }
    return ServiceAddress{"", tcp->host, has_port ? tcp->port : config::HttpSettings{}.port};
}

std::string to_string(const ServiceAddress& address) {
    return address.socket.empty() ? to_string(link::TcpAddress{address.host, address.port}) : address.socket.string();
}

} // namespace linefeed::api
