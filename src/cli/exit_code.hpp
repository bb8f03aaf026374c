// The exit codes that scripts rely on (design, section 7).
#pragma once

#include "base/failure.hpp"
#include "feeder/outcome.hpp"

namespace linefeed::cli {

enum class ExitCode : int {
    done = 0,
    other = 1,
    usage = 2,
    unreachable = 3, ///< printer or service not reachable
    stopped = 4,     ///< stopped before the end, can be resumed
    input_rejected = 5,
    in_doubt = 6, ///< records in doubt: an operator must decide
};

[[nodiscard]] ExitCode exit_code(FailureKind kind);
/// Of a run that left no record in doubt.
[[nodiscard]] ExitCode exit_code(const feeder::Outcome& outcome);

} // namespace linefeed::cli
