// What is answered instead of what was asked (RFC 9457): a stable type, what happened, and what to do about it.
#pragma once

#include "base/failure.hpp"

#include <boost/system/result.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace linefeed::api {

/// Each has its status and title in problem.cpp; the names stand in openapi.yaml and do not change.
enum class ProblemType {
    malformed,           ///< 400: no HTTP, no JSON, a parameter that cannot be read
    token_missing,       ///< 401
    token_unknown,       ///< 401
    not_permitted,       ///< 403: the role may not
    origin_not_allowed,  ///< 403: a page of another origin
    not_found,           ///< 404
    method_not_allowed,  ///< 405
    not_acceptable,      ///< 406
    request_timeout,     ///< 408
    conflict,            ///< 409: with what goes on
    in_doubt,            ///< 409: an operator must decide about records first
    key_in_use,          ///< 409: the same request is being carried out
    key_interrupted,     ///< 409: it was being carried out when the service ended
    length_required,     ///< 411
    too_large,           ///< 413
    unsupported_type,    ///< 415
    expectation,         ///< 417
    host_not_allowed,    ///< 421
    not_valid,           ///< 422: readable, but it cannot be done
    input_rejected,      ///< 422: the file
    key_reused,          ///< 422: the key belongs to another request
    too_many,            ///< 429: connections or streams of this client
    header_too_large,    ///< 431
    internal,            ///< 500
    printer_unreachable, ///< 502
    storage,             ///< 503
    busy,                ///< 503: too much is going on
    stopping,            ///< 503: the service is
    disk_full,           ///< 507: no room for an upload
};

[[nodiscard]] int status_of(ProblemType type);
/// "urn:linefeed:problem:not-found"
[[nodiscard]] std::string urn(ProblemType type);
/// The reason in words, the same for every problem of the type.
[[nodiscard]] std::string_view title(ProblemType type);

struct Problem {
    ProblemType type = ProblemType::internal;
    std::string detail;                 ///< any bytes
    std::string advice{};               ///< empty = it stands in detail
    std::string report{};               ///< JSON of an import's report; empty = none
    std::string allow{};                ///< of method_not_allowed
    std::optional<int> retry_after_s{}; ///< when it may go better

    friend bool operator==(const Problem&, const Problem&) = default;
};

/// How the command line takes it.
[[nodiscard]] FailureKind kind_of(ProblemType type);
/// From what the service's core says. ::usage becomes not_valid: whether something does not exist the caller knows.
[[nodiscard]] Problem to_problem(const Failure& failure);
/// The body of application/problem+json.
[[nodiscard]] std::string to_json(const Problem& problem);

/// Called by result::value() on an error: throws std::runtime_error with the detail.
[[noreturn]] void throw_exception_from_error(const Problem& problem, const boost::source_location& place);

/// A value, or the problem that prevented it.
template <typename T>
using Checked = boost::system::result<T, Problem>;

} // namespace linefeed::api
