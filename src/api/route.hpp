// Every route of the service in one table: routing, roles, threads and the test against openapi.yaml come from it.
#pragma once

#include "api/exchange.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace linefeed::api {

enum class Method { get, post };
[[nodiscard]] std::string_view to_string(Method method);

/// The threads that carry a request out. What may take long must not keep the rest from being served, and nothing keeps
/// a stop from being served.
enum class Lane {
    at_once, ///< the control thread itself: needs nobody
    query,   ///< reads
    change,  ///< jobs, queue, start
    stop,    ///< stops, and only these
    slow,    ///< waits for a printer, or reads much
    import,  ///< reads files
    disk,    ///< writes uploads; no route
};
inline constexpr std::size_t lanes = 7;

/// Whether a POST needs an Idempotency-Key.
enum class Key {
    none,     ///< GET
    accepted, ///< a repetition does no harm
    required, ///< a repetition could print something again
};

enum class Body {
    none,
    optional_json,
    json,
    import, ///< JSON, or a file to print
    file,   ///< bytes
};

/// How an answer comes about.
enum class Kind {
    answer, ///< by the handler
    stream, ///< server-sent events, written by the connection
};

/// Names of the parameters that a route takes; "" = no more.
using RouteQuery = std::array<std::string_view, 5>;

struct Route {
    Method method = Method::get;
    std::string_view path; ///< with up to two `{…}`, each a whole segment
    Role role = Role::viewer;
    Lane lane = Lane::query;
    Key key = Key::none;
    Body body = Body::none;
    std::string_view produces = media::json;
    RouteQuery query{};                                                      ///< names of its parameters; "" = no more
    Outcome (*handle)(const Request& request, Services& services) = nullptr; ///< nullptr: Kind::stream
    [[nodiscard]] Kind kind() const { return handle == nullptr ? Kind::stream : Kind::answer; }
    [[nodiscard]] bool takes(std::string_view parameter) const;
};

[[nodiscard]] std::span<const Route> routes();

/// Where a path leads.
struct Found {
    const Route* route = nullptr; ///< nullptr: not with this method, or nothing is there
    std::string parameter;        ///< for the first `{…}`, decoded
    std::string what;             ///< for the second one
    std::string allow;            ///< the methods that the path has, e.g. "GET, HEAD, POST"; empty = nothing is there
};

/// `path` is encoded and without query. std::nullopt as method finds no route, only `allow`.
[[nodiscard]] Found find_route(std::optional<Method> method, std::string_view path);

} // namespace linefeed::api
