// Looks on while a job is printed, until it stands.
#pragma once

#include "client/command.hpp"

#include <chrono>
#include <cstdint>
#include <string_view>

namespace linefeed::client {

/// How long the service may be away while somebody waits: it may be started again.
inline constexpr std::chrono::seconds service_patience{30};

/// Whether a job in this phase moves without anybody's doing.
[[nodiscard]] bool moves(std::string_view phase);

/// The exit code for a job that stands.
[[nodiscard]] ExitCode exit_code_of_phase(std::string_view phase);

struct WaitEnd {
    Json job; ///< as it was seen last
    bool interrupted = false;
    bool lost = false; ///< the service was away meanwhile
};

/// Waits until the job stands, or Ctrl-C, which ends the looking on and nothing else. Progress on stderr unless
/// `quiet`. FailureKind::unreachable if the service is away for longer than service_patience.
[[nodiscard]] Result<WaitEnd> wait_for_job(const Service& service, std::int64_t job, bool quiet);

} // namespace linefeed::client
