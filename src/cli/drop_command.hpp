// `linefeed drop`: a drop folder in the foreground. What is dropped becomes jobs; printing them is another command.
#pragma once

#include "cli/exit_code.hpp"
#include "intake/drop_folder.hpp"

#include <filesystem>

namespace linefeed::cli {

struct DropOptions {
    intake::DropSettings settings;
    std::filesystem::path spool;
    bool once = false; ///< end when nothing is left that will be taken just by waiting
    bool json = false; ///< a line for each file on stdout
};

/// Runs until Ctrl-C, or until all is imported with `once`.
[[nodiscard]] ExitCode run_drop(const DropOptions& options);

} // namespace linefeed::cli
