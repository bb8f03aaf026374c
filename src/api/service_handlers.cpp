#include "api/answers.hpp"
#include "api/handlers.hpp"
#include "api/metrics.hpp"
#include "api/openapi.hpp"
#include "api/views.hpp"

#include <limits>

namespace linefeed::api::handlers {

namespace {

constexpr std::string_view too_few_rights = "with checks in full: show a token of role viewer or operator";

} // namespace

Outcome live(const Request& /*request*/, Services& /*services*/) {
    return json_answer({{"live", true}});
}

Outcome ready(const Request& request, Services& services) {
    const auto verbose = request.query.flag("verbose");
    if (!verbose) {
        return verbose.error();
    }
    if (*verbose && request.role == Role::anyone) {
        return Problem{ProblemType::token_missing, "the checks name printers and folders", std::string{too_few_rights}};
    }
    const daemon::ServiceStatus status = services.operations.status();
    Json json{{"ready", status.ready}};
    if (*verbose) {
        json["checks"] = items_json(status.checks);
    }
    return json_answer(json, status.ready ? 200 : 503);
}

Outcome version(const Request& /*request*/, Services& services) {
    return json_answer({{"version", visible(services.operations.status().version)}, {"api", "v1"}});
}

Outcome metrics(const Request& /*request*/, Services& services) {
    Answer answer;
    answer.content_type = media::metrics;
    answer.body = services.metrics.text(services.operations);
    return answer;
}

Outcome openapi(const Request& /*request*/, Services& /*services*/) {
    Answer answer;
    answer.content_type = media::yaml;
    answer.body = openapi_text;
    return answer;
}

Outcome status(const Request& /*request*/, Services& services) {
    return json_answer(to_json(services.operations.status()));
}

Outcome doctor(const Request& /*request*/, Services& services) {
    return json_answer(findings_json(services.operations.status().checks));
}

Outcome reload(const Request& request, Services& services) {
    const auto changes = services.operations.reload(request.caller);
    if (!changes) {
        return to_problem(changes.error());
    }
    Json lines = Json::array();
    for (const std::string& change : *changes) {
        lines.push_back(visible(change));
    }
    return json_answer({{"changes", std::move(lines)}});
}

Outcome audit(const Request& request, Services& services) {
    const auto page = read_page(request.query);
    if (!page) {
        return page.error();
    }
    const auto entries = services.operations.audit(page->after, page->limit);
    if (!entries) {
        return to_problem(entries.error());
    }
    const auto last = services.operations.last_audit();
    if (!last) {
        return to_problem(last.error());
    }
    return json_answer(
        {{"items", items_json(*entries)},
         {"next", next_page("/api/v1/audit", *page, entries->size(), entries->empty() ? 0 : entries->back().id)},
         {"last_id", *last}});
}

Outcome folders(const Request& /*request*/, Services& services) {
    return json_answer({{"items", items_json(services.operations.folders())}});
}

Outcome events(const Request& request, Services& services) {
    const auto page = read_page(request.query);
    if (!page) {
        return page.error();
    }
    const auto events = services.operations.events(page->after, page->limit);
    if (!events) {
        return to_problem(events.error());
    }
    const auto last = services.operations.last_event();
    if (!last) {
        return to_problem(last.error());
    }
    return json_answer(
        {{"items", items_json(*events)},
         {"next", next_page("/api/v1/events", *page, events->size(), events->empty() ? 0 : events->back().id)},
         {"last_id", *last}});
}

Outcome verify_ledger(const Request& /*request*/, Services& services) {
    const auto rows = services.operations.verify_ledger();
    if (!rows) {
        return to_problem(rows.error());
    }
    return json_answer({{"rows", *rows}});
}

} // namespace linefeed::api::handlers
