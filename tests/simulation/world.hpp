// One simulated world: runs one seed to its end. First safety under faults; then the faults end, and the job must
// finish.
#pragma once

#include "context.hpp"

#include <optional>
#include <string>

namespace linefeed::simulation {

struct RunResult {
    std::optional<std::string> violation;
    std::uint64_t trace_hash = 0;
    Counts counts;
};

[[nodiscard]] RunResult run_seed(const Scenario& scenario, bool verbose);

} // namespace linefeed::simulation
