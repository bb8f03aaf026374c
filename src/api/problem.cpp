#include "api/problem.hpp"

#include "api/json_text.hpp"
#include "base/assert.hpp"

#include <array>
#include <stdexcept>

namespace linefeed::api {

namespace {

struct Description {
    ProblemType type;
    int status;
    FailureKind kind;
    std::string_view name;
    std::string_view title;
};

using enum FailureKind;

constexpr std::array descriptions{
    Description{ProblemType::malformed, 400, usage, "malformed", "The request cannot be read"},
    Description{ProblemType::token_missing, 401, usage, "token-missing", "A token is needed"},
    Description{ProblemType::token_unknown, 401, usage, "token-unknown", "The token is not known"},
    Description{ProblemType::not_permitted, 403, usage, "not-permitted", "You may not do that"},
    Description{ProblemType::origin_not_allowed, 403, usage, "origin-not-allowed", "Pages of this origin may not call"},
    Description{ProblemType::not_found, 404, usage, "not-found", "There is no such thing"},
    Description{ProblemType::method_not_allowed, 405, usage, "method-not-allowed", "Not with this method"},
    Description{ProblemType::not_acceptable, 406, usage, "not-acceptable", "There is no such representation"},
    Description{ProblemType::request_timeout, 408, usage, "request-timeout", "The request took too long to come"},
    Description{ProblemType::conflict, 409, stopped, "conflict", "It conflicts with what goes on"},
    Description{ProblemType::in_doubt, 409, FailureKind::in_doubt, "in-doubt", "Records are in doubt"},
    Description{ProblemType::key_in_use, 409, stopped, "key-in-use", "The same request is being carried out"},
    Description{ProblemType::key_interrupted, 409, stopped, "key-interrupted", "The request was interrupted"},
    Description{ProblemType::length_required, 411, usage, "length-required", "The length of the body is needed"},
    Description{ProblemType::too_large, 413, usage, "too-large", "The body is too large"},
    Description{ProblemType::unsupported_type, 415, usage, "unsupported-type", "Not with a body of this type"},
    Description{ProblemType::expectation, 417, usage, "expectation", "The expectation cannot be met"},
    Description{ProblemType::host_not_allowed, 421, usage, "host-not-allowed", "The service has no such name"},
    Description{ProblemType::not_valid, 422, usage, "not-valid", "It cannot be done like this"},
    Description{ProblemType::input_rejected, 422, input, "input-rejected", "The file is rejected"},
    Description{ProblemType::key_reused, 422, usage, "key-reused", "The key belongs to another request"},
    Description{ProblemType::too_many, 429, unreachable, "too-many", "Too many at once from this client"},
    Description{ProblemType::header_too_large, 431, usage, "header-too-large", "The header is too large"},
    Description{ProblemType::internal, 500, FailureKind::internal, "internal", "Something went wrong inside"},
    Description{ProblemType::printer_unreachable, 502, unreachable, "printer-unreachable",
                "The printer is not reached"},
    Description{ProblemType::storage, 503, FailureKind::storage, "storage", "The spool cannot be read or written"},
    Description{ProblemType::busy, 503, unreachable, "busy", "Too much is going on"},
    Description{ProblemType::stopping, 503, unreachable, "stopping", "The service is ending"},
    Description{ProblemType::disk_full, 507, FailureKind::storage, "disk-full", "There is no room for the file"},
};

const Description& description(ProblemType type) {
    const auto index = static_cast<std::size_t>(type);
    LINEFEED_ASSERT(index < descriptions.size() && descriptions[index].type == type);
    return descriptions[index];
}

ProblemType type_of(FailureKind kind) {
    switch (kind) {
    case FailureKind::usage:
        return ProblemType::not_valid;
    case FailureKind::unreachable:
        return ProblemType::printer_unreachable;
    case FailureKind::stopped:
        return ProblemType::conflict;
    case FailureKind::input:
        return ProblemType::input_rejected;
    case FailureKind::in_doubt:
        return ProblemType::in_doubt;
    case FailureKind::storage:
        return ProblemType::storage;
    case FailureKind::internal:
        return ProblemType::internal;
    }
    assertion_failed("FailureKind", __FILE__, __LINE__);
}

} // namespace

int status_of(ProblemType type) {
    return description(type).status;
}

std::string urn(ProblemType type) {
    return "urn:linefeed:problem:" + std::string{description(type).name};
}

std::string_view title(ProblemType type) {
    return description(type).title;
}

FailureKind kind_of(ProblemType type) {
    return description(type).kind;
}

Problem to_problem(const Failure& failure) {
    return {type_of(failure.kind), failure.message};
}

std::string to_json(const Problem& problem) {
    Json json{{"type", urn(problem.type)},
              {"title", title(problem.type)},
              {"status", status_of(problem.type)},
              {"detail", visible(problem.detail)},
              {"kind", to_string(kind_of(problem.type))}};
    if (!problem.advice.empty()) {
        json["advice"] = visible(problem.advice);
    }
    if (!problem.report.empty()) {
        json["report"] = parsed_object(problem.report);
    }
    return dump(json);
}

void throw_exception_from_error(const Problem& problem, const boost::source_location&) {
    throw std::runtime_error(problem.detail);
}

} // namespace linefeed::api
