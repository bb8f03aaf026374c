#include "api/answers.hpp"

#include "api/url.hpp"

namespace linefeed::api {

Answer json_answer(const Json& json, int status) {
    Answer answer;
    answer.status = status;
    answer.body = dump(json);
    return answer;
}

Checked<PageRequest> read_page(const Query& query) {
    const auto after = query.number("after", 0, max_id, 0);
    if (!after) {
        return after.error();
    }
    const auto limit = query.number("limit", 1, max_page, PageRequest{}.limit);
    if (!limit) {
        return limit.error();
    }
    return PageRequest{*after, *limit};
}

Json next_page(std::string_view target, const PageRequest& page, std::size_t got, std::uint64_t last) {
    if (got < page.limit) {
        return nullptr;
    }
    return std::string{target} + (target.find('?') == std::string_view::npos ? '?' : '&') +
           "after=" + std::to_string(last) + "&limit=" + std::to_string(page.limit);
}

Checked<spool::JobId> job_id(const Request& request) {
    const auto number = parse_number(request.parameter, max_id);
    if (!number || *number == 0) {
        return no_such_job(request.parameter);
    }
    return spool::JobId{static_cast<std::int64_t>(*number)};
}

Problem job_problem(const Failure& failure, spool::JobId id, Services& services) {
    if (failure.kind == FailureKind::usage) {
        const auto job = services.operations.job(id);
        if (job && !*job) {
            return no_such_job(std::to_string(static_cast<std::int64_t>(id)));
        }
    }
    return to_problem(failure);
}

Problem printer_problem(const Failure& failure, std::string_view printer, Services& services) {
    if (failure.kind == FailureKind::usage && !services.operations.printer(printer)) {
        return no_such_printer(printer, services);
    }
    return to_problem(failure);
}

Problem no_such_job(std::string_view id) {
    return {ProblemType::not_found, "there is no job \"" + std::string{id} + '"',
            "GET /api/v1/jobs lists those that there are"};
}

Problem no_such_printer(std::string_view name, Services& services) {
    std::string names;
    for (const daemon::PrinterView& printer : services.operations.printers()) {
        names += (names.empty() ? "" : ", ") + printer.name;
    }
    return {ProblemType::not_found, "there is no printer \"" + std::string{name} + '"',
            names.empty() ? "none is configured" : "there is: " + names};
}

} // namespace linefeed::api
