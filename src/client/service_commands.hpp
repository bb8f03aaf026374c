// `linefeed status`, `folders`, `audit` and `reload`: the service itself.
#pragma once

#include "client/command.hpp"

#include <cstddef>

namespace linefeed::client {

struct AuditOptions {
    CommonOptions common;
    std::size_t limit = 50; ///< the newest
};

[[nodiscard]] ExitCode run_status(const CommonOptions& options);
[[nodiscard]] ExitCode run_folders(const CommonOptions& options);
[[nodiscard]] ExitCode run_audit(const AuditOptions& options);
[[nodiscard]] ExitCode run_reload(const CommonOptions& options);

} // namespace linefeed::client
