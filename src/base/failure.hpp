// What can go wrong in operation is a value. A Failure says in one line what happened and what to do, and its kind
// decides the exit code of the command line.
#pragma once

#include <boost/system/result.hpp>

#include <string>
#include <string_view>
#include <utility>

namespace linefeed {

/// Kinds of failure that a caller treats differently. The command line maps them to its exit codes.
enum class FailureKind {
    usage,       ///< the request itself is wrong: options, names, ranges
    unreachable, ///< the printer or the service cannot be reached
    stopped,     ///< printing ended before the end of the job and can be resumed
    input,       ///< the source data is rejected
    in_doubt,    ///< nobody knows whether some records were printed: an operator must decide
    storage,     ///< the spool cannot be read or written
    internal,    ///< anything else
};

/// One failure: its kind and one line for the operator.
struct Failure {
    FailureKind kind = FailureKind::internal;
    std::string message;

    friend bool operator==(const Failure&, const Failure&) = default;
};

/// Called by `Result::value()` on a failed result: throws std::runtime_error with the message.
[[noreturn]] void throw_exception_from_error(const Failure& failure, const boost::source_location& place);

/// A value, or the failure that prevented it.
template <typename T>
using Result = boost::system::result<T, Failure>;

/// The name of a kind for logs and JSON, e.g. "in_doubt".
[[nodiscard]] std::string_view to_string(FailureKind kind);

} // namespace linefeed
