// A request and its answer without the wire: what the connection hands to a route's handler, and takes from it.
#pragma once

#include "api/problem.hpp"
#include "api/query.hpp"
#include "daemon/operations.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::api {

class Metrics;

namespace media {
inline constexpr std::string_view json = "application/json";
inline constexpr std::string_view problem = "application/problem+json";
inline constexpr std::string_view yaml = "application/yaml";
inline constexpr std::string_view metrics = "text/plain; version=0.0.4; charset=utf-8";
inline constexpr std::string_view events = "text/event-stream";
inline constexpr std::string_view csv = "text/csv";
inline constexpr std::string_view sqlite = "application/vnd.sqlite3";
inline constexpr std::string_view bytes = "application/octet-stream";
} // namespace media

/// What a client may do. Each role may do what those before it may.
enum class Role {
    anyone,   ///< has shown no token
    viewer,   ///< looks at everything
    operator_ ///< and changes things
};
[[nodiscard]] std::string_view to_string(Role role);

/// What a handler is given. Flow: the connection has checked host, origin, role, media types and limits before.
struct Request {
    daemon::Caller caller;
    Role role = Role::anyone;
    bool over_unix_socket = false;
    std::string parameter; ///< what stands for `{…}` in the route's path, decoded; empty = it has none
    std::string what;      ///< what stands for a second one
    Query query;
    std::string body;                            ///< JSON; empty = none
    std::optional<std::filesystem::path> upload; ///< the body as a file
};

/// An answer; what belongs to every answer (security headers, length) is added by the connection.
struct Answer {
    int status = 200;
    std::string_view content_type = media::json;
    std::string body;
    std::string location{};             ///< of what was made; empty = none
    std::string allow{};                ///< methods, of status 405 and OPTIONS; empty = none
    std::optional<int> retry_after_s{}; ///< when to try again
    bool replayed = false;              ///< given before to the same key
};

/// A problem as it is answered.
[[nodiscard]] Answer to_answer(const Problem& problem);

/// What handlers work with.
struct Services {
    daemon::Operations& operations;
    Metrics& metrics;
};

/// A problem, or the answer.
using Outcome = Checked<Answer>;

} // namespace linefeed::api
