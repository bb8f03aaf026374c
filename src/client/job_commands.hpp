// `linefeed job`, `queue`, `cancel` and `reprint`: single jobs of the service.
#pragma once

#include "client/command.hpp"

#include <cstdint>
#include <string>

namespace linefeed::client {

struct JobOptions {
    CommonOptions common;
    std::int64_t job = 0;
};

struct QueueOptions {
    CommonOptions common;
    std::int64_t job = 0;
    std::string printer;
};

struct CancelOptions {
    CommonOptions common;
    std::int64_t job = 0;
    bool yes = false; ///< do not ask
};

struct ReprintOptions {
    CommonOptions common;
    std::int64_t job = 0;
    std::string records; ///< "N-M,N"
    std::string reason;
    bool yes = false; ///< do not ask
};

[[nodiscard]] ExitCode run_job(const JobOptions& options);
[[nodiscard]] ExitCode run_queue(const QueueOptions& options);
[[nodiscard]] ExitCode run_cancel(const CancelOptions& options);
[[nodiscard]] ExitCode run_reprint(const ReprintOptions& options);

} // namespace linefeed::client
