#include "link/printer_address.hpp"

#include "link/serial_port.hpp"

#include <boost/asio/io_context.hpp>

#include <algorithm>
#include <charconv>

namespace linefeed::link {

namespace {

constexpr std::string_view tcp_scheme = "tcp://";
constexpr std::string_view serial_scheme = "serial://";

Failure malformed(std::string_view text, std::string_view problem = {}) {
    return {FailureKind::usage, '"' + std::string{text} + "\" is not a printer address" +
                                    (problem.empty() ? std::string{} : ": " + std::string{problem}) + ": expected " +
                                    std::string{printer_address_forms}};
}

template <typename Number>
bool read_number(std::string_view text, Number& out) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, out);
    return !text.empty() && error == std::errc{} && stop == end;
}

/// What is wrong with `key=value` behind the `?`; empty if nothing is.
std::string take_option(std::string_view key, std::string_view value, PrinterAddress& out) {
    auto* const serial = std::get_if<SerialAddress>(&out.place);
    if (key == "crc" && (value == "on" || value == "off")) {
        out.crc = value == "on";
        return {};
    }
    if (serial != nullptr && key == "flow" && (value == "rtscts" || value == "none")) {
        serial->flow = value == "none" ? FlowControl::none : FlowControl::rtscts;
        return {};
    }
    if (serial != nullptr && key == "baud") {
        const bool known = read_number(value, serial->baud) &&
                           std::ranges::find(serial_speeds(), serial->baud) != serial_speeds().end();
        return known ? std::string{} : "a serial line has no speed of \"" + std::string{value} + "\" baud";
    }
    if (key == "crc") {
        return "crc is on or off";
    }
    if (serial != nullptr && key == "flow") {
        return "flow is rtscts or none";
    }
    return "it has no option \"" + std::string{key} + '"';
}

/// The options behind the `?`. What is wrong with them; empty if nothing is.
std::string take_options(std::string_view options, PrinterAddress& out) {
    std::vector<std::string_view> seen;
    while (!options.empty()) {
        const std::string_view option = options.substr(0, options.find('&'));
        options.remove_prefix(std::min(option.size() + 1, options.size()));
        const std::size_t equals = std::min(option.find('='), option.size());
        const std::string_view key = option.substr(0, equals);
        if (std::ranges::find(seen, key) != seen.end()) {
            return '"' + std::string{key} + "\" is there twice";
        }
        seen.push_back(key);
        const std::string problem = take_option(key, option.substr(std::min(equals + 1, option.size())), out);
        if (!problem.empty()) {
            return problem;
        }
    }
    return {};
}

} // namespace

Result<TcpAddress> parse_tcp_address(std::string_view text) {
    if (!text.starts_with(tcp_scheme)) {
        return malformed(text);
    }
    std::string_view rest = text.substr(tcp_scheme.size());
    if (rest.ends_with('/')) {
        rest.remove_suffix(1);
    }
    TcpAddress address;
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
    if (address.host.empty() || address.host.find_first_of("/@ \t?&") != std::string::npos) {
        return malformed(text);
    }
    if (port.empty()) {
        return address;
    }
    if (port.front() != ':' || !read_number(port.substr(1), address.port) || address.port == 0) {
        return malformed(text);
    }
    return address;
}

Result<PrinterAddress> parse_printer_address(std::string_view text) {
    const std::string_view place = text.substr(0, text.find('?'));
    PrinterAddress address;
    if (place.starts_with(serial_scheme)) {
        SerialAddress serial{.device = std::string{place.substr(serial_scheme.size())}};
        if (!serial.device.starts_with('/') || serial.device.size() < 2 ||
            serial.device.find('\0') != std::string::npos) {
            return malformed(text, "the device is an absolute path");
        }
        address.place = std::move(serial);
    } else {
        auto tcp = parse_tcp_address(place);
        if (!tcp) {
            return malformed(text);
        }
        address.place = *std::move(tcp);
    }
    const std::string problem =
        place.size() == text.size() ? std::string{} : take_options(text.substr(place.size() + 1), address);
    return problem.empty() ? Result<PrinterAddress>{std::move(address)} : malformed(text, problem);
}

std::string to_string(const TcpAddress& address) {
    const bool ipv6 = address.host.find(':') != std::string::npos;
    return std::string{tcp_scheme} + (ipv6 ? "[" + address.host + "]" : address.host) + ":" +
           std::to_string(address.port);
}

std::string to_string(const PrinterAddress& address) {
    const std::string crc = address.crc ? "crc=on" : "";
    if (const auto* const tcp = std::get_if<TcpAddress>(&address.place)) {
        return to_string(*tcp) + (crc.empty() ? "" : "?" + crc);
    }
    const SerialAddress& serial = *address.serial();
    return std::string{serial_scheme} + serial.device + "?baud=" + std::to_string(serial.baud) +
           (serial.flow == FlowControl::none ? "&flow=none" : "") + (crc.empty() ? "" : "&" + crc);
}

Result<std::vector<boost::asio::ip::tcp::endpoint>> resolve(const TcpAddress& address) {
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

Result<Endpoints> resolve(const PrinterAddress& address) {
    if (const SerialAddress* const serial = address.serial()) {
        return Endpoints{.tcp = {}, .serial = *serial, .crc = address.crc};
    }
    auto tcp = resolve(std::get<TcpAddress>(address.place));
    if (!tcp) {
        return tcp.error();
    }
    return Endpoints{.tcp = *std::move(tcp), .crc = address.crc};
}

} // namespace linefeed::link
