#include "api/admission.hpp"

#include "api/media_type.hpp"

#include <algorithm>

namespace linefeed::api {

namespace {

constexpr std::size_t max_key = 128;

Problem malformed(std::string detail, std::string advice) {
    return {ProblemType::malformed, std::move(detail), std::move(advice)};
}

/// A request target taken apart.
struct Target {
    std::string_view path;
    std::string_view query;
    std::string_view authority; ///< of the absolute form; empty = it was not absolute
};

Checked<Target> take_apart(std::string_view text) {
    Target target;
    constexpr std::string_view scheme = "http://";
    if (text.starts_with(scheme)) {
        text.remove_prefix(scheme.size());
        target.authority = text.substr(0, text.find('/'));
        text.remove_prefix(target.authority.size());
    }
    const bool printable =
        std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~' && c != '#'; });
    if (!text.starts_with('/') || !printable) {
        return malformed("the request's target is not a path", "let it begin with / and write other characters as %NN");
    }
    target.path = text.substr(0, text.find('?'));
    target.query = text.substr(std::min(target.path.size() + 1, text.size()));
    return target;
}

/// The name under which the service was called; empty over the Unix socket, where nobody can be misled.
Checked<std::string> host_of(const Header& header, const Target& target, const Peer& peer, const AccessRules& rules) {
    if (peer.unix_socket) {
        return std::string{};
    }
    const std::size_t hosts = header.count("host");
    if (hosts > 1 || (hosts == 0 && !header.http_1_0)) {
        return malformed("there must be one Host", "send \"Host: ADDRESS:PORT\" once");
    }
    const std::string_view host = target.authority.empty() ? header.field("host") : target.authority;
    if (hosts == 0 && target.authority.empty()) {
        return std::string{};
    }
    if (const auto right = check_host(host, peer, rules); !right) {
        return right.error();
    }
    return std::string{host};
}

Checked<void> check_parameters(const Query& query, const Route& route) {
    for (const auto& [name, value] : query.all()) {
        if (!route.takes(name)) {
            std::string allowed;
            for (const std::string_view known : route.query) {
                allowed += (allowed.empty() || known.empty() ? "" : ", ") + std::string{known};
            }
            return malformed("there is no parameter \"" + name + "\" here",
                             allowed.empty() ? "leave the query out" : "there may be: " + allowed);
        }
    }
    return {};
}

Checked<std::string> read_key(const Header& header, const Route& route) {
    if (route.key == Key::none) {
        return std::string{};
    }
    const std::string_view key = header.field("idempotency-key");
    if (header.count("idempotency-key") > 1 || key.size() > max_key ||
        !std::all_of(key.begin(), key.end(), [](char c) { return c > ' ' && c <= '~'; })) {
        return malformed("the Idempotency-Key is not usable",
                         "send one of 1 to 128 printable characters without blanks");
    }
    if (key.empty() && route.key == Key::required) {
        return malformed(
            "this could print something again if it came twice, so it needs an Idempotency-Key",
            "send \"Idempotency-Key: …\" with a text that is new for every request, such as a UUID, and the "
            "same one if you repeat it");
    }
    return std::string{key};
}

/// What the body may be, and how large.
Checked<void> read_body_header(const Header& header, const BodyLimits& limits, Admitted& admitted) {
    const Route& route = *admitted.route;
    const bool comes = header.chunked || header.content_length.value_or(0) > 0;
    if (route.method == Method::get) {
        return comes ? Checked<void>{malformed("a GET has no body", "put what you ask for into the query")}
                     : Checked<void>{};
    }
    admitted.media_type = media_type_of(header.field("content-type"));
    admitted.upload =
        (route.body == Body::import && (admitted.media_type == media::csv || admitted.media_type == media::sqlite)) ||
        (route.body == Body::file && admitted.media_type == media::bytes);
    const bool untyped =
        admitted.media_type.empty() && !comes && route.body != Body::import && route.body != Body::file;
    const std::string_view encoding = header.field("content-encoding");
    const bool json = admitted.media_type == media::json && route.body != Body::file;
    if ((!untyped && !admitted.upload && !json) || (!encoding.empty() && encoding != "identity")) {
        return Problem{ProblemType::unsupported_type,
                       encoding.empty() ? "the body has the type \"" + admitted.media_type + '"'
                                        : "the body is encoded: " + std::string{encoding},
                       route.body == Body::file ? "send the bytes as application/octet-stream"
                       : route.body == Body::import
                           ? "send JSON as application/json, or the file as text/csv or application/vnd.sqlite3"
                           : "send JSON as application/json, or no body and no Content-Type where none is needed"};
    }
    if (!header.chunked && !header.content_length &&
        (route.body == Body::json || route.body == Body::import || route.body == Body::file)) {
        return Problem{ProblemType::length_required, "there is no body, or its length is not known",
                       "send it with Content-Length, or in chunks"};
    }
    admitted.max_body = admitted.upload ? limits.upload : std::min(limits.json, limits.upload);
    if (header.content_length.value_or(0) > admitted.max_body) {
        return Problem{ProblemType::too_large,
                       "the body has " + std::to_string(*header.content_length) + " bytes; at most " +
                           std::to_string(admitted.max_body) + " are taken",
                       admitted.upload ? "split the file, drop it into a folder of the service, or raise http.max_body"
                                       : "send less"};
    }
    return {};
}

Checked<void> read_stream_position(const Header& header, Admitted& admitted) {
    const std::string_view position = header.field("last-event-id");
    const std::string* const after = admitted.request.query.find("after");
    if (position.empty() && after == nullptr) {
        return {};
    }
    constexpr std::uint64_t max_id = 9'223'372'036'854'775'807;
    admitted.last_event = parse_number(position.empty() ? std::string_view{*after} : position, max_id);
    return admitted.last_event ? Checked<void>{}
                               : Checked<void>{malformed("Last-Event-ID is not the number of an event",
                                                         "send the id of the last event that you have seen")};
}

std::optional<Method> method_of(std::string_view name) {
    if (name == "GET" || name == "HEAD") {
        return Method::get;
    }
    return name == "POST" ? std::optional{Method::post} : std::nullopt;
}

Checked<Found> find(std::string_view method, std::string_view path) {
    Found found = find_route(method_of(method), path);
    if (found.allow.empty()) {
        return Problem{ProblemType::not_found, "there is nothing at " + std::string{path},
                       "/api/v1/openapi.yaml lists what there is"};
    }
    found.allow += ", OPTIONS";
    if (found.route == nullptr && method != "OPTIONS") {
        Problem problem{ProblemType::method_not_allowed, std::string{path} + " does not know " + std::string{method},
                        "use " + found.allow};
        problem.allow = found.allow;
        return problem;
    }
    return found;
}

/// The rest of a request whose host is right and whose path exists.
Checked<Admitted> check(const Header& header, const Found& found, std::string_view query, const Identity& identity,
                        bool over_unix_socket, const BodyLimits& limits) {
    Admitted admitted;
    admitted.route = found.route;
    admitted.request.caller = identity.caller;
    admitted.request.role = identity.role;
    admitted.request.over_unix_socket = over_unix_socket;
    admitted.request.parameter = found.parameter;
    admitted.request.what = found.what;
    if (!accepts(header.field("accept"), found.route->produces)) {
        return Problem{ProblemType::not_acceptable, "you do not accept " + media_type_of(found.route->produces),
                       "there is no other representation: accept it, or leave Accept out"};
    }
    auto parameters = Query::parse(query);
    if (!parameters) {
        return parameters.error();
    }
    admitted.request.query = std::move(*parameters);
    if (const auto known = check_parameters(admitted.request.query, *found.route); !known) {
        return known.error();
    }
    auto key = read_key(header, *found.route);
    if (!key) {
        return key.error();
    }
    admitted.key = std::move(*key);
    const std::string expectation = media_type_of(header.field("expect"));
    if (!expectation.empty() && expectation != "100-continue") {
        return Problem{ProblemType::expectation, "\"" + expectation + "\" cannot be expected", "leave Expect out"};
    }
    admitted.wants_continue = !expectation.empty() && !header.http_1_0;
    if (const auto body = read_body_header(header, limits, admitted); !body) {
        return body.error();
    }
    if (found.route->kind() == Kind::stream) {
        if (const auto position = read_stream_position(header, admitted); !position) {
            return position.error();
        }
    }
    return admitted;
}

} // namespace

std::string_view Header::field(std::string_view name) const {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.first == name; });
    return found == fields.end() ? std::string_view{} : std::string_view{found->second};
}

std::size_t Header::count(std::string_view name) const {
    return static_cast<std::size_t>(
        std::count_if(fields.begin(), fields.end(), [&](const auto& field) { return field.first == name; }));
}

Admission admit(const Header& header, const Peer& peer, const AccessRules& rules, const BodyLimits& limits) {
    Admission admission;
    admission.without_body = header.method == "HEAD";
    const auto target = take_apart(header.target);
    if (!target) {
        admission.admitted = target.error();
        return admission;
    }
    const auto host = host_of(header, *target, peer, rules);
    if (!host) {
        admission.admitted = host.error();
        return admission;
    }
    const std::string_view origin = header.field("origin");
    if (!peer.unix_socket && is_configured_origin(origin, rules)) {
        admission.cors_origin = origin;
    }
    const auto found = find(header.method, target->path);
    if (!found) {
        admission.admitted = found.error();
        return admission;
    }
    if (header.method != "GET" && header.method != "HEAD" && !peer.unix_socket && !origin.empty()) {
        if (const auto right = check_origin(origin, *host, rules); !right) {
            admission.admitted = right.error();
            return admission;
        }
    }
    if (header.method == "OPTIONS") {
        admission.preflight = header.count("access-control-request-method") > 0 && !admission.cors_origin.empty();
        admission.answer.emplace();
        admission.answer->status = 204;
        admission.answer->allow = found->allow;
        return admission;
    }
    const auto identity = identify(header.field("authorization"), peer, rules);
    if (!identity) {
        admission.admitted = identity.error();
        return admission;
    }
    admission.caller = identity->caller.name;
    if (const auto may = check_role(*identity, found->route->role, rules); !may) {
        admission.admitted = may.error();
        return admission;
    }
    admission.admitted = check(header, *found, target->query, *identity, peer.unix_socket, limits);
    return admission;
}

} // namespace linefeed::api
