// `linefeed printer P monitor|record FILE|replay FILE`: the conversation with a printer, in words, as it goes or from a
// file. Of a printer of the service its session is shown; of an address an own one, which asks for its state.
#pragma once

#include "client/printer_commands.hpp"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace linefeed::client {

struct MonitorOptions {
    PrinterOptions printer;
    std::chrono::milliseconds interval{1000};            ///< of an address: between two inquiries
    std::optional<std::chrono::milliseconds> duration{}; ///< absent = until Ctrl-C
    std::filesystem::path file{};                        ///< to record into; empty = show it
    bool replace = false;                                ///< the file that is there
};

struct ReplayOptions {
    PrinterOptions printer;
    std::filesystem::path file;
    bool fast = false;   ///< without the pauses
    std::string against; ///< address to which the host's side is sent again; empty = show it
    bool yes = false;    ///< nobody is asked
};

[[nodiscard]] ExitCode run_monitor(const MonitorOptions& options);
/// ExitCode::other if the printer answers differently.
[[nodiscard]] ExitCode run_replay(const ReplayOptions& options);

} // namespace linefeed::client
