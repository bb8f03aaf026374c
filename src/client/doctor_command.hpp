// `linefeed doctor`: everything that can be checked from here, and what the service finds about itself.
#pragma once

#include "client/command.hpp"

#include <filesystem>
#include <string>

namespace linefeed::client {

struct DoctorOptions {
    CommonOptions common;
    std::filesystem::path config; ///< of the service; empty = where the package has it
    std::string version;          ///< of this program
};

/// ExitCode::done if there is no problem (warnings may be), ::unreachable if the service is not there, ::other else.
[[nodiscard]] ExitCode run_doctor(const DoctorOptions& options);

} // namespace linefeed::client
