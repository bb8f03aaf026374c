#include "api/answers.hpp"
#include "api/handlers.hpp"
#include "api/url.hpp"
#include "api/views.hpp"

#include <algorithm>

namespace linefeed::api::handlers {

namespace {

Checked<std::vector<daemon::JobPhase>> read_phases(std::string_view text) {
    std::vector<daemon::JobPhase> phases;
    while (!text.empty()) {
        const std::string_view name = text.substr(0, text.find(','));
        text.remove_prefix(std::min(name.size() + 1, text.size()));
        const auto phase = job_phase(name);
        if (!phase) {
            return Problem{ProblemType::malformed, "there is no phase \"" + std::string{name} + '"',
                           "give some of these, separated by commas: " + job_phase_names()};
        }
        phases.push_back(*phase);
    }
    return phases;
}

std::string jobs_target(const Query& query) {
    std::string target = "/api/v1/jobs";
    for (const std::string_view name : {"printer", "phase"}) {
        if (const std::string* const value = query.find(name)) {
            target +=
                (target.find('?') == std::string::npos ? '?' : '&') + std::string{name} + '=' + url_encoded(*value);
        }
    }
    return target;
}

} // namespace

Outcome jobs(const Request& request, Services& services) {
    const auto page = read_page(request.query);
    if (!page) {
        return page.error();
    }
    auto phases = read_phases(request.query.text("phase"));
    if (!phases) {
        return phases.error();
    }
    const auto jobs = services.operations.jobs({request.query.text("printer"), std::move(*phases),
                                                spool::JobId{static_cast<std::int64_t>(page->after)}, page->limit});
    if (!jobs) {
        return to_problem(jobs.error());
    }
    const auto last = jobs->empty() ? 0 : static_cast<std::uint64_t>(jobs->back().id);
    return json_answer(
        {{"items", items_json(*jobs)}, {"next", next_page(jobs_target(request.query), *page, jobs->size(), last)}});
}

Outcome job(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    const auto job = services.operations.job(*id);
    if (!job) {
        return to_problem(job.error());
    }
    if (!*job) {
        return no_such_job(request.parameter);
    }
    return json_answer(to_json(**job));
}

Outcome doubt(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    const auto doubt = services.operations.doubt(*id);
    if (!doubt) {
        return job_problem(doubt.error(), *id, services);
    }
    return json_answer(to_json(*doubt));
}

Outcome history(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    const auto page = read_page(request.query);
    if (!page) {
        return page.error();
    }
    RecordRange records = RecordRange::closed(RecordNumber{0}, RecordNumber::max());
    if (const std::string* const text = request.query.find("records")) {
        const auto range = parse_records(*text);
        if (!range) {
            return range.error();
        }
        records = *range;
    }
    const auto stretches = services.operations.history(*id, records);
    if (!stretches) {
        return job_problem(stretches.error(), *id, services);
    }
    Json items = Json::array();
    for (std::size_t k = 0; k < std::min(stretches->size(), page->limit); ++k) {
        items.push_back(to_json((*stretches)[k]));
    }
    Json next;
    if (stretches->size() > page->limit) {
        next = "/api/v1/jobs/" + request.parameter +
               "/ledger?records=" + std::to_string((*stretches)[page->limit].range.first().value()) + '-' +
               std::to_string(records.last().value()) + "&limit=" + std::to_string(page->limit);
    }
    return json_answer({{"items", std::move(items)}, {"next", std::move(next)}});
}

Outcome ledger_rows(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    const auto page = read_page(request.query);
    if (!page) {
        return page.error();
    }
    const auto rows = services.operations.ledger(*id, static_cast<std::int64_t>(page->after), page->limit);
    if (!rows) {
        return job_problem(rows.error(), *id, services);
    }
    const auto last = rows->empty() ? 0 : static_cast<std::uint64_t>(rows->back().sequence);
    return json_answer(
        {{"items", items_json(*rows)},
         {"next", next_page("/api/v1/jobs/" + request.parameter + "/ledger/rows", *page, rows->size(), last)}});
}

} // namespace linefeed::api::handlers
