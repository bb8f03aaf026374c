// A glance at a printer that nobody feeds: what state it is in, which machine it is, how much it has printed.
#pragma once

#include "printer/printer_client.hpp"

#include <optional>
#include <string>

namespace linefeed::printer {

/// What the printer said. Absent = it did not answer, or was not asked, as in standby.
struct Look {
    std::string unreachable{}; ///< why nobody is there; empty = the connection was taken
    /// The connection was taken, and nothing came: in standby, or another program holds the printer.
    bool silent = false;
    std::optional<protocol::MachineStatus> machine{};
    std::optional<protocol::VersionInfo> version{};
    std::optional<protocol::Counters> counters{};
};

/// `?RS`, `?VS` and `?CC` on a connection of its own, which is closed again: a printer that serves one at a time stays
/// free for others. Blocks: at most a connection time-out for each endpoint and five reply time-outs.
[[nodiscard]] Look look_at(const ClientSettings& settings);

/// `?RS`, and once more if no answer comes: one may get lost, and what is silent twice is held to be in standby.
[[nodiscard]] std::optional<protocol::MachineStatus> ask_status(PrinterClient& printer);
/// `?VS` in the same way: who does not tell twice does not tell.
[[nodiscard]] std::optional<protocol::VersionInfo> ask_version(PrinterClient& printer);

} // namespace linefeed::printer
