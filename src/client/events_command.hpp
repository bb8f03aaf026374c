// `linefeed events`: what has happened, and with --follow what happens, each event once.
#pragma once

#include "client/command.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace linefeed::client {

struct EventsOptions {
    CommonOptions common;
    bool follow = false;
    std::optional<std::uint64_t> after; ///< all behind this one; absent = the newest `limit`
    std::size_t limit = 50;
    std::string printer;             ///< only of this one; empty = all
    std::optional<std::int64_t> job; ///< only of this one
};

/// With follow until Ctrl-C; a service that is away is waited for.
[[nodiscard]] ExitCode run_events(const EventsOptions& options);

} // namespace linefeed::client
