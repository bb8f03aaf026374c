// Where the service is, as people write it.
#pragma once

#include "base/failure.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace linefeed::api {

/// A socket file, or host and port.
struct ServiceAddress {
    std::filesystem::path socket; ///< empty = over TCP
    std::string host;             ///< name or numeric address; IPv6 without brackets
    std::uint16_t port = 0;

    friend bool operator==(const ServiceAddress&, const ServiceAddress&) = default;
};

/// Reads `/PATH`, `unix:PATH`, `tcp://HOST[:PORT]`, `tcp://[IPV6]:PORT`; the port is 8631 unless it is given.
/// FailureKind::usage otherwise, saying what is expected.
[[nodiscard]] Result<ServiceAddress> parse_service_address(std::string_view text);
[[nodiscard]] std::string to_string(const ServiceAddress& address);

} // namespace linefeed::api
