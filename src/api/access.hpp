// Who asks, from where, and whether he may. Against pages in somebody's browser: the Host of a request must be a name
// of this service (a page that has rebound its own name to 127.0.0.1 has another), and what changes something must not
// come from a page of another origin.
#pragma once

#include "api/exchange.hpp"
#include "api/tokens.hpp"
#include "config/settings.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::api {

/// The rules in force; another one takes their place when the configuration is read again.
struct AccessRules {
    std::vector<std::string> hosts{};
    std::vector<std::string> origins{};
    std::optional<Tokens> tokens{}; ///< absent: on the loopback, everyone may look

    /// Reads the file of tokens. FailureKind::usage if it is not right, or missing where others may connect.
    [[nodiscard]] static Result<AccessRules> load(const config::HttpSettings& settings);
};

/// The other end of a connection, and this one.
struct Peer {
    bool unix_socket = false;
    std::string name;          ///< over the Unix socket, "anna (uid 1000)"; over TCP, the numeric address
    std::string local_address; ///< of TCP, numeric: where the client has connected to
    std::uint16_t local_port = 0;
};

struct Identity {
    daemon::Caller caller;
    Role role = Role::anyone;
};

/// `host` is the value of the header, `name[:port]`. ProblemType::host_not_allowed unless it is the address, localhost
/// or a configured name, with the port of the service; a configured name may come without port, or as configured.
[[nodiscard]] Checked<void> check_host(std::string_view host, const Peer& peer, const AccessRules& rules);

/// Whether a page of `origin` may read answers: it is among those configured.
[[nodiscard]] bool is_configured_origin(std::string_view origin, const AccessRules& rules);
/// ProblemType::origin_not_allowed unless `origin` is configured, or that of the service itself under the name `host`.
[[nodiscard]] Checked<void> check_origin(std::string_view origin, std::string_view host, const AccessRules& rules);

/// `authorization` is the value of the header; empty = none. ProblemType::token_unknown if it is not a token of ours.
[[nodiscard]] Checked<Identity> identify(std::string_view authorization, const Peer& peer, const AccessRules& rules);
/// ProblemType::token_missing or ::not_permitted, with what to do, if a role has not what `needed` may.
[[nodiscard]] Checked<void> check_role(const Identity& identity, Role needed, const AccessRules& rules);

} // namespace linefeed::api
