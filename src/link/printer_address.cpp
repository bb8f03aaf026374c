#include "link/printer_address.hpp"

#include <boost/asio/io_context.hpp>

#include <charconv>

namespace linefeed::link {

namespace {

Failure malformed(std::string_view text) {
    return {FailureKind::usage,
            "\"" + std::string{text} +
                "\" is not a printer address: expected tcp://HOST:PORT, e.g. tcp://192.168.1.20:3000"};
}

} // namespace

Result<PrinterAddress> parse_printer_address(std::string_view text) {
    constexpr std::string_view scheme = "tcp://";
    if (!text.starts_with(scheme)) {
        return malformed(text);
    }
    std::string_view rest = text.substr(scheme.size());
    if (rest.ends_with('/')) {
        rest.remove_suffix(1);
    }
    PrinterAddress address;
    std::string_view port;
    if (rest.starts_with('[')) {
        const std::size_t bracket = rest.find(']');
        if (bracket == std::string_view::npos) {
            return malformed(text);
        }
        address.host = rest.substr(1, bracket - 1);
        port = rest.substr(bracket + 1);
    } else {
        const std::size_t colon = rest.find(':');
        address.host = rest.substr(0, colon);
        port = colon == std::string_view::npos ? std::string_view{} : rest.substr(colon);
    }
    if (address.host.empty() || address.host.find_first_of("/@ \t") != std::string::npos) {
        return malformed(text);
    }
    if (port.empty()) {
        return address;
    }
    const char* const end = port.data() + port.size();
    const auto [stop, error] = std::from_chars(port.data() + 1, end, address.port);
    if (port.front() != ':' || port.size() < 2 || error != std::errc{} || stop != end || address.port == 0) {
        return malformed(text);
    }
    return address;
}

std::string to_string(const PrinterAddress& address) {
    const bool ipv6 = address.host.find(':') != std::string::npos;
    return "tcp://" + (ipv6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

Result<std::vector<boost::asio::ip::tcp::endpoint>> resolve(const PrinterAddress& address) {
    boost::asio::io_context context;
    boost::asio::ip::tcp::resolver resolver{context};
    boost::system::error_code error;
    const auto found = resolver.resolve(address.host, std::to_string(address.port), error);
    if (error) {
        return Failure{FailureKind::unreachable, to_string(address) + ": cannot find the host: " + error.message()};
    }
    std::vector<boost::asio::ip::tcp::endpoint> endpoints;
    for (const auto& entry : found) {
        endpoints.push_back(entry.endpoint());
    }
    return endpoints;
}

} // namespace linefeed::link
