// `linefeed watch`: all printers, drawn again and again on a terminal, as lines when something changes otherwise.
#pragma once

#include "client/command.hpp"

#include <chrono>

namespace linefeed::client {

struct WatchOptions {
    CommonOptions common;
    std::chrono::milliseconds interval{1000}; ///< 100 … 60 000
};

/// Until Ctrl-C; a service that is away is waited for, once it was there.
[[nodiscard]] ExitCode run_watch(const WatchOptions& options);

} // namespace linefeed::client
