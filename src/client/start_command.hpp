// `linefeed start`, `resume` and `settle`: a job is set going, and records in doubt are settled before.
#pragma once

#include "client/command.hpp"
#include "daemon/operator_word.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace linefeed::client {

struct StartOptions {
    CommonOptions common;
    std::optional<std::int64_t> job; ///< absent: the first of the printer's queue that can be started or resumed
    std::string printer;             ///< empty = the job's own
    bool wait = false;
};

struct ResumeOptions {
    CommonOptions common;
    std::int64_t job = 0;
    daemon::OperatorWord word; ///< settles records in doubt before
    bool wait = false;
};

struct SettleOptions {
    CommonOptions common;
    std::int64_t job = 0;
    daemon::OperatorWord word; ///< not given: the records in doubt are shown, and on a terminal it is asked for
};

/// The SettleRequest of openapi.yaml. Precondition: word.given().
[[nodiscard]] Json settle_request(const daemon::OperatorWord& word);

[[nodiscard]] ExitCode run_start(const StartOptions& options);
[[nodiscard]] ExitCode run_resume(const ResumeOptions& options);
[[nodiscard]] ExitCode run_settle(const SettleOptions& options);

} // namespace linefeed::client
