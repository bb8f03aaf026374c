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

/// The parameter `records`; all there can be, if it is not given.
Checked<RecordRange> wanted_records(const Query& query) {
    const std::string* const text = query.find("records");
    return text == nullptr ? Checked<RecordRange>{RecordRange::closed(RecordNumber{0}, RecordNumber::max())}
                           : parse_records(*text);
}

/// The records that are in both; either may be empty.
RecordRange common(const RecordRange& a, const RecordRange& b) {
    return a.empty() || b.empty() ? RecordRange{}
                                  : RecordRange::closed(std::max(a.first(), b.first()), std::min(a.last(), b.last()));
}

std::string records_target(const std::string& job, std::string_view what, RecordNumber first, RecordNumber last,
                           std::size_t limit) {
    return "/api/v1/jobs/" + job + '/' + std::string{what} + "?records=" + std::to_string(first.value()) + '-' +
           std::to_string(last.value()) + "&limit=" + std::to_string(limit);
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

Outcome records(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    const auto page = read_page(request.query);
    if (!page) {
        return page.error();
    }
    const auto wanted = wanted_records(request.query);
    if (!wanted) {
        return wanted.error();
    }
    const auto job = services.operations.job(*id);
    if (!job) {
        return to_problem(job.error());
    }
    if (!*job) {
        return no_such_job(request.parameter);
    }
    const RecordRange asked = common(*wanted, (*job)->records);
    const RecordRange shown{asked.first(), RecordCount{std::min<std::uint64_t>(asked.count().value(), page->limit)}};
    std::vector<daemon::DoubtView::Record> found;
    if (!shown.empty()) {
        auto records = services.operations.records(*id, shown);
        if (!records) {
            return job_problem(records.error(), *id, services);
        }
        found = std::move(*records);
    }
    Json next;
    if (shown.count() < asked.count()) {
        next = records_target(request.parameter, "records", shown.last().next(), asked.last(), page->limit);
    }
    return json_answer({{"items", items_json(found)}, {"next", std::move(next)}});
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
    const auto records = wanted_records(request.query);
    if (!records) {
        return records.error();
    }
    const auto stretches = services.operations.history(*id, *records);
    if (!stretches) {
        return job_problem(stretches.error(), *id, services);
    }
    Json items = Json::array();
    for (std::size_t k = 0; k < std::min(stretches->size(), page->limit); ++k) {
        items.push_back(to_json((*stretches)[k]));
    }
    Json next;
    if (stretches->size() > page->limit) {
        next = records_target(request.parameter, "ledger", (*stretches)[page->limit].range.first(), records->last(),
                              page->limit);
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
