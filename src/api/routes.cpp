#include "api/handlers.hpp"
#include "api/route.hpp"

#include <algorithm>
#include <vector>

namespace linefeed::api {

namespace {

constexpr Route get(std::string_view path, Role role, Lane lane, decltype(Route::handle) handle, RouteQuery query = {},
                    std::string_view produces = media::json) {
    return {Method::get, path, role, lane, Key::none, Body::none, produces, query, handle};
}

constexpr Route post(std::string_view path, Lane lane, Key key, Body body, decltype(Route::handle) handle,
                     RouteQuery query = {}) {
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
    get("/api/v1/printers/{printer}/inspect/{what}", Role::viewer, Lane::slow, handlers::inspect,
        {"type", "code", "argument", "path"}),
    get("/api/v1/printers/{printer}/files", Role::viewer, Lane::slow, handlers::read_file, {"path"}, media::bytes),
    post("/api/v1/printers/{printer}/files", Lane::slow, Key::accepted, Body::file, handlers::write_file,
         {"path", "replace"}),
    post("/api/v1/printers/{printer}/command", Lane::slow, Key::accepted, Body::json, handlers::command),
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

/// Takes the first segment, with the `/` before it, from the front of `path`.
std::string_view take_segment(std::string_view& path) {
    const std::string_view segment = path.substr(0, path.find('/', 1));
    path.remove_prefix(segment.size());
    return segment;
}

/// What stands for each `{…}` of `pattern` in `path`, decoded; std::nullopt if the path is another one.
std::optional<std::vector<std::string>> match(std::string_view pattern, std::string_view path) {
    std::vector<std::string> parameters;
    while (!pattern.empty() && !path.empty()) {
        const std::string_view wanted = take_segment(pattern);
        const std::string_view segment = take_segment(path);
        if (!wanted.starts_with("/{")) {
            if (wanted != segment) {
                return std::nullopt;
            }
            continue;
        }
        auto decoded = percent_decoded(segment.substr(1), false);
        if (!decoded || decoded->empty()) {
            return std::nullopt;
        }
        parameters.push_back(*std::move(decoded));
    }
    return pattern.empty() && path.empty() ? std::optional{std::move(parameters)} : std::nullopt;
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
        const auto parameters = match(route.path, path);
        if (!parameters) {
            continue;
        }
        found.allow += found.allow.empty() ? "" : ", ";
        found.allow += route.method == Method::get ? "GET, HEAD" : "POST";
        if (route.method == method) {
            found.route = &route;
            found.parameter = parameters->empty() ? std::string{} : parameters->front();
            found.what = parameters->size() < 2 ? std::string{} : parameters->back();
        }
    }
    return found;
}

} // namespace linefeed::api
