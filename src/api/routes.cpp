#include "api/handlers.hpp"
#include "api/route.hpp"

#include <algorithm>

namespace linefeed::api {

namespace {

constexpr Route get(std::string_view path, Role role, Lane lane, decltype(Route::handle) handle,
                    std::array<std::string_view, 5> query = {}, std::string_view produces = media::json) {
    return {Method::get, path, role, lane, Key::none, Body::none, produces, query, handle};
}

constexpr Route post(std::string_view path, Lane lane, Key key, Body body, decltype(Route::handle) handle,
                     std::array<std::string_view, 5> query = {}) {
    return {Method::post, path, Role::operator_, lane, key, body, media::json, query, handle};
}

constexpr std::array table{
    get("/livez", Role::anyone, Lane::at_once, handlers::live),
    get("/readyz", Role::anyone, Lane::query, handlers::ready, {"verbose"}),
    get("/version", Role::anyone, Lane::query, handlers::version),
    get("/metrics", Role::viewer, Lane::query, handlers::metrics, {}, media::metrics),
    get("/api/v1/openapi.yaml", Role::anyone, Lane::at_once, handlers::openapi, {}, media::yaml),
    get("/api/v1/status", Role::viewer, Lane::query, handlers::status),
    get("/api/v1/doctor", Role::viewer, Lane::query, handlers::doctor),
    post("/api/v1/reload", Lane::slow, Key::accepted, Body::none, handlers::reload),
    get("/api/v1/audit", Role::viewer, Lane::query, handlers::audit, {"after", "limit"}),
    get("/api/v1/folders", Role::viewer, Lane::query, handlers::folders),
    get("/api/v1/printers", Role::viewer, Lane::query, handlers::printers),
    get("/api/v1/printers/{printer}", Role::viewer, Lane::query, handlers::printer),
    get("/api/v1/printers/{printer}/frames", Role::viewer, Lane::query, handlers::frames, {"error"}),
    post("/api/v1/printers/{printer}/preflight", Lane::slow, Key::accepted, Body::none, handlers::preflight),
    post("/api/v1/printers/{printer}/start", Lane::change, Key::required, Body::optional_json, handlers::start_printer),
    post("/api/v1/printers/{printer}/stop", Lane::stop, Key::accepted, Body::none, handlers::stop_printer),
    post("/api/v1/printers/{printer}/acknowledge", Lane::change, Key::accepted, Body::json, handlers::acknowledge),
    post("/api/v1/printers/{printer}/accept", Lane::change, Key::accepted, Body::json, handlers::accept_printer),
    post("/api/v1/printers/{printer}/suspend", Lane::change, Key::accepted, Body::json, handlers::suspend),
    get("/api/v1/jobs", Role::viewer, Lane::query, handlers::jobs, {"printer", "phase", "after", "limit"}),
    post("/api/v1/jobs", Lane::import, Key::required, Body::import, handlers::import,
         {"name", "layout", "printer", "autostart", "again"}),
    get("/api/v1/jobs/{job}", Role::viewer, Lane::query, handlers::job),
    get("/api/v1/jobs/{job}/doubt", Role::viewer, Lane::query, handlers::doubt),
    get("/api/v1/jobs/{job}/records", Role::viewer, Lane::query, handlers::records, {"records", "limit"}),
    get("/api/v1/jobs/{job}/ledger", Role::viewer, Lane::slow, handlers::history, {"records", "limit"}),
    get("/api/v1/jobs/{job}/ledger/rows", Role::viewer, Lane::query, handlers::ledger_rows, {"after", "limit"}),
    post("/api/v1/jobs/{job}/queue", Lane::change, Key::accepted, Body::json, handlers::queue_job),
    post("/api/v1/jobs/{job}/start", Lane::change, Key::required, Body::none, handlers::start_job),
    post("/api/v1/jobs/{job}/resume", Lane::change, Key::required, Body::none, handlers::start_job),
    post("/api/v1/jobs/{job}/cancel", Lane::change, Key::accepted, Body::none, handlers::cancel_job),
    post("/api/v1/jobs/{job}/reprint", Lane::change, Key::required, Body::json, handlers::reprint_job),
    post("/api/v1/jobs/{job}/settle", Lane::change, Key::required, Body::json, handlers::settle_job),
    post("/api/v1/ledger/verify", Lane::slow, Key::accepted, Body::none, handlers::verify_ledger),
    get("/api/v1/events", Role::viewer, Lane::query, handlers::events, {"after", "limit"}),
    get("/api/v1/events/stream", Role::viewer, Lane::query, nullptr, {"after"}, media::events),
};

/// Whether `path` is `pattern`; what stands for `{…}` goes to `parameter`, still encoded.
bool matches(std::string_view pattern, std::string_view path, std::string_view& parameter) {
    const std::size_t open = pattern.find('{');
    if (open == std::string_view::npos) {
        return pattern == path;
    }
    const std::string_view tail = pattern.substr(pattern.find('}') + 1);
    if (path.size() <= open + tail.size() || !path.starts_with(pattern.substr(0, open)) || !path.ends_with(tail)) {
        return false;
    }
    parameter = path.substr(open, path.size() - open - tail.size());
    return parameter.find('/') == std::string_view::npos;
}

} // namespace

std::string_view to_string(Method method) {
    return method == Method::get ? "GET" : "POST";
}

bool Route::takes(std::string_view parameter) const {
    return !parameter.empty() && std::find(query.begin(), query.end(), parameter) != query.end();
}

std::span<const Route> routes() {
    return table;
}

Found find_route(std::optional<Method> method, std::string_view path) {
    Found found;
    for (const Route& route : table) {
        std::string_view encoded;
        if (!matches(route.path, path, encoded)) {
            continue;
        }
        const auto decoded = percent_decoded(encoded, false);
        if (!decoded) {
            continue;
        }
        found.allow += found.allow.empty() ? "" : ", ";
        found.allow += route.method == Method::get ? "GET, HEAD" : "POST";
        if (route.method == method) {
            found.route = &route;
            found.parameter = *decoded;
        }
    }
    return found;
}

} // namespace linefeed::api
