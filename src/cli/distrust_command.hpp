// `linefeed distrust`: what a spool that comes from a backup does not know as printed is put in doubt.
#pragma once

#include "cli/exit_code.hpp"

#include <filesystem>
#include <string>

namespace linefeed::cli {

struct DistrustOptions {
    std::filesystem::path spool;
    std::string reason; ///< stands in the ledger; not empty
    bool json = false;
};

[[nodiscard]] ExitCode run_distrust(const DistrustOptions& options);

} // namespace linefeed::cli
