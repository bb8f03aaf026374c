// What `linefeed print` was asked to do.
#pragma once

#include "daemon/operator_word.hpp"
#include "daemon/real_time.hpp"
#include "intake/layout.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::cli {

struct PrintOptions {
    std::filesystem::path file;
    std::string printer; ///< tcp://HOST:PORT; may be empty with dry_run
    std::filesystem::path spool;

    intake::Layout layout;

    // The run
    std::optional<std::uint32_t> from;
    std::optional<std::uint32_t> to;
    bool dry_run = false;
    bool new_job = false;
    bool while_importing = false;
    bool open_nozzle = false;
    std::optional<std::uint32_t> expected_rate; ///< products a second that the conveyor is to bring
    std::vector<std::uint32_t> acknowledge;
    daemon::RealTimeSettings real_time;
    std::uint32_t connect_timeout_ms = 3000;
    std::uint32_t reply_timeout_ms = 2000;

    /// Settles records in doubt before anything is printed.
    daemon::OperatorWord operator_word;

    bool json = false;
};

} // namespace linefeed::cli
