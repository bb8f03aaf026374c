#include "api/access.hpp"

#include "config/checks.hpp"

#include <algorithm>

namespace linefeed::api {

namespace {

std::string lower_case(std::string_view text) {
    std::string lower{text};
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
    return lower;
}

std::string in_url(const std::string& address) {
    return address.find(':') == std::string::npos ? address : '[' + address + ']';
}

/// The names of the service as they may stand in Host, in lower case.
std::vector<std::string> names(const Peer& peer, const AccessRules& rules) {
    constexpr std::uint16_t http_port = 80;
    const std::string port = ':' + std::to_string(peer.local_port);
    std::vector<std::string> names;
    for (const std::string& own : {in_url(peer.local_address), std::string{"localhost"}}) {
        names.push_back(own + port);
        if (peer.local_port == http_port) {
            names.push_back(own);
        }
    }
    for (const std::string& configured : rules.hosts) {
        names.push_back(lower_case(configured));
        names.push_back(lower_case(configured) + port);
    }
    return names;
}

} // namespace

Result<AccessRules> AccessRules::load(const config::HttpSettings& settings) {
    AccessRules rules{settings.hosts, settings.origins};
    if (settings.tokens_file) {
        auto tokens = Tokens::load(*settings.tokens_file);
        if (!tokens) {
            return tokens.error();
        }
        rules.tokens = std::move(*tokens);
    } else if (!config::is_loopback(settings.listen)) {
        return Failure{FailureKind::usage, "http.listen " + settings.listen +
                                               " is reached from other machines: that needs http.tokens_file"};
    }
    return rules;
}

Checked<void> check_host(std::string_view host, const Peer& peer, const AccessRules& rules) {
    const std::vector<std::string> allowed = names(peer, rules);
    if (std::find(allowed.begin(), allowed.end(), lower_case(host)) != allowed.end()) {
        return {};
    }
    return Problem{ProblemType::host_not_allowed, "\"" + std::string{host} + "\" is no name of this service",
                   "use " + allowed.front() + ", or add the name to http.hosts in the configuration"};
}

bool is_configured_origin(std::string_view origin, const AccessRules& rules) {
    return std::find(rules.origins.begin(), rules.origins.end(), origin) != rules.origins.end();
}

Checked<void> check_origin(std::string_view origin, std::string_view host, const AccessRules& rules) {
    if (is_configured_origin(origin, rules) || lower_case(origin) == "http://" + lower_case(host)) {
        return {};
    }
    return Problem{ProblemType::origin_not_allowed, "pages of " + std::string{origin} + " may not change anything here",
                   "add the origin to http.origins in the configuration, if the page is one of yours"};
}

Checked<Identity> identify(std::string_view authorization, const Peer& peer, const AccessRules& rules) {
    if (peer.unix_socket) {
        return Identity{{peer.name}, Role::operator_};
    }
    if (authorization.empty()) {
        return Identity{{"anonymous (" + peer.name + ')'}, rules.tokens ? Role::anyone : Role::viewer};
    }
    constexpr std::string_view scheme = "bearer ";
    const bool bearer = lower_case(authorization.substr(0, scheme.size())) == scheme;
    const Token* const token =
        bearer && rules.tokens ? rules.tokens->find(authorization.substr(scheme.size())) : nullptr;
    if (token == nullptr) {
        return Problem{ProblemType::token_unknown,
                       rules.tokens ? "the token is not in http.tokens_file" : "the service has no tokens",
                       "linefeed token new NAME makes one; its line goes into http.tokens_file"};
    }
    return Identity{{"token " + token->name}, token->role};
}

Checked<void> check_role(const Identity& identity, Role needed, const AccessRules& rules) {
    if (identity.role >= needed) {
        return {};
    }
    if (!rules.tokens) {
        return Problem{ProblemType::not_permitted, "without tokens, nothing is changed over TCP",
                       "use the Unix socket (linefeed …), or set http.tokens_file and show a token of role operator"};
    }
    if (identity.role == Role::anyone) {
        return Problem{ProblemType::token_missing, "no token was shown",
                       "send \"Authorization: Bearer …\" with a token of role " + std::string{to_string(needed)}};
    }
    return Problem{ProblemType::not_permitted, identity.caller.name + " may look, but not change anything",
                   "use a token of role operator"};
}

} // namespace linefeed::api
