// Where a printer is: `tcp://HOST:PORT`, or `serial:///dev/ttyUSB0?baud=115200&flow=rtscts`; `crc=on` behind either
// secures every frame (protocol, section 6).
#pragma once

#include "base/failure.hpp"

#include <boost/asio/ip/tcp.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace linefeed::link {

/// Port of the printers' interface protocol on Ethernet (field notes, "Connection").
inline constexpr std::uint16_t default_port = 3000;

struct TcpAddress {
    std::string host; ///< name or numeric address; IPv6 without brackets
    std::uint16_t port = default_port;

    friend bool operator==(const TcpAddress&, const TcpAddress&) = default;
};

/// Whether RTS and CTS tell when bytes may come. The printers want it (protocol, section 1).
enum class FlowControl {
    none,
    rtscts,
};

/// A serial line, 8N1.
struct SerialAddress {
    std::string device;          ///< absolute path
    std::uint32_t baud = 115200; ///< one of the rates that serial_speeds() names
    FlowControl flow = FlowControl::rtscts;

    friend bool operator==(const SerialAddress&, const SerialAddress&) = default;
};

struct PrinterAddress {
    std::variant<TcpAddress, SerialAddress> place;
    /// Frames are secured by CRC32, both ways.
    bool crc = false;

    [[nodiscard]] const SerialAddress* serial() const { return std::get_if<SerialAddress>(&place); }
    friend bool operator==(const PrinterAddress&, const PrinterAddress&) = default;
};

/// What an address may look like, for messages.
inline constexpr std::string_view printer_address_forms =
    "tcp://HOST:PORT such as tcp://192.168.1.20:3000, or serial:///dev/ttyUSB0?baud=115200&flow=rtscts; and crc=on "
    "behind ? for a noisy line";

/// Reads `tcp://HOST[:PORT]`, `tcp://[IPV6]:PORT`. FailureKind::usage otherwise, saying what is expected.
[[nodiscard]] Result<TcpAddress> parse_tcp_address(std::string_view text);

/// Reads `tcp://…[?crc=on|off]` and `serial:///DEVICE[?baud=…&flow=rtscts|none&crc=on|off]`. FailureKind::usage
/// otherwise, saying what is expected.
[[nodiscard]] Result<PrinterAddress> parse_printer_address(std::string_view text);

/// `tcp://HOST:PORT`.
[[nodiscard]] std::string to_string(const TcpAddress& address);
/// As parse_printer_address() reads it, without what goes without saying.
[[nodiscard]] std::string to_string(const PrinterAddress& address);

/// Where to connect to: nothing is left to be looked up.
struct Endpoints {
    std::vector<boost::asio::ip::tcp::endpoint> tcp; ///< tried in turn
    std::optional<SerialAddress> serial{};
    bool crc = false;
};

/// Looks the name of a host up; blocks. FailureKind::unreachable if there is no such host.
[[nodiscard]] Result<std::vector<boost::asio::ip::tcp::endpoint>> resolve(const TcpAddress& address);
/// The same for any address. A serial device is not looked at before it is opened.
[[nodiscard]] Result<Endpoints> resolve(const PrinterAddress& address);

} // namespace linefeed::link
