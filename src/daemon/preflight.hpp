// The look at a printer before a start, and for whoever asks: facts are gathered in one short conversation that changes
// nothing at the printer, and judged in words, each with what to do. What cannot be known without changing anything
// (does it take records, does it keep the stop point) the run itself proves: it reads both back before the line moves.
#pragma once

#include "config/settings.hpp"
#include "daemon/operations.hpp"
#include "printer/printer_client.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::daemon {

/// What the printer said. Absent = it did not answer, or was not asked, as in standby.
struct PreflightFacts {
    std::string unreachable; ///< why there was no connection; empty = there was one
    bool broke_off = false;  ///< it closed the connection in the middle
    std::optional<protocol::MachineStatus> machine;
    std::optional<protocol::VersionInfo> version;
    std::optional<protocol::JobName> job;
    std::optional<protocol::MailStatus> mail; ///< the second of two answers
    std::optional<protocol::Counters> counters;
    printer::ConversationOddities oddities;
    std::optional<bool> second_connection; ///< whether another one at the same time was answered
};

/// Blocks: at most a connection time-out for each endpoint and some reply time-outs.
[[nodiscard]] PreflightFacts gather_facts(const printer::ClientSettings& settings);

/// What the job that is to start has for records.
struct RecordFacts {
    /// Any was written with an escape. Asked only where it matters, as it may take time; empty = there is no job yet.
    std::function<bool()> have_escapes{};
    bool have_properties = false; ///< they are mirrored or turned
    std::size_t bytes = 0;        ///< of one on average, see record_bytes(); 0 = there is no job yet
};

/// What is expected of the printer.
struct PreflightRules {
    const config::Settings& settings;
    const config::PrinterSettings& printer;
    std::string known_serial_number{}; ///< of the last time; empty = unknown
    /// A run of ours may be under way on it, which the start would stop or go on with.
    bool may_be_printing = false;
    RecordFacts records{};
    /// Other printers of the settings behind which the same machine was found.
    std::vector<std::string> same_machine{};
    /// Whether its firmware keeps a stop point, by the last probe; absent = not probed.
    std::optional<bool> keeps_stop_at{};
};

/// Which machine it is, for a printer that has told it.
[[nodiscard]] Finding judge_identity(const protocol::VersionInfo& version, const PreflightRules& rules);

/// In this order: reachable, identity, profile, ready, nozzle, cover, errors, job_file, fifo, stop_point, counter,
/// modes, line, connections. What could not be looked at is left out.
[[nodiscard]] std::vector<Finding> judge(const PreflightFacts& facts, const PreflightRules& rules);

/// None of them is a problem.
[[nodiscard]] bool may_start(const std::vector<Finding>& findings);

/// Whether the printer's path and the configured one mean the same job file: the case, doubled and leading `\` do not
/// matter, and a mere file name fits any directory.
[[nodiscard]] bool same_job_file(std::string_view reported, std::string_view configured);

} // namespace linefeed::daemon
