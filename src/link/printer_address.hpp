// Where a printer is: `tcp://HOST:PORT`.
#pragma once

#include "base/failure.hpp"

#include <boost/asio/ip/tcp.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::link {

/// Port of the printers' interface protocol on Ethernet (field notes, "Connection").
inline constexpr std::uint16_t default_port = 3000;

struct PrinterAddress {
    std::string host; ///< name or numeric address; IPv6 without brackets
    std::uint16_t port = default_port;

    friend bool operator==(const PrinterAddress&, const PrinterAddress&) = default;
};

/// Reads `tcp://HOST[:PORT]`, `tcp://[IPV6]:PORT`. FailureKind::usage otherwise, saying what is expected.
[[nodiscard]] Result<PrinterAddress> parse_printer_address(std::string_view text);

/// `tcp://HOST:PORT`.
[[nodiscard]] std::string to_string(const PrinterAddress& address);

/// Looks the name up; blocks. FailureKind::unreachable if there is no such host.
[[nodiscard]] Result<std::vector<boost::asio::ip::tcp::endpoint>> resolve(const PrinterAddress& address);

} // namespace linefeed::link
