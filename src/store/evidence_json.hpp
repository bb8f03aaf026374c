// The evidence of ledger rows as JSON: what the printer said, in the order of the protocol's tables, and whose word it
// is.
#pragma once

#include "feeder/actions.hpp"
#include "feeder/reconcile.hpp"
#include "spool/job.hpp"

#include <optional>
#include <string>

namespace linefeed::store {

/// The run that another follows without a stop.
struct FollowedRun {
    spool::JobId job{};
    spool::RunId run{};

    friend bool operator==(const FollowedRun&, const FollowedRun&) = default;
};

/// What a run_started row remembers of the printer: enough to reconcile after a crash.
struct RunStart {
    std::string printer; ///< address
    std::string serial_number;
    std::optional<std::uint32_t> total_before;
    RecordNumber last_printed_before;
    std::optional<FollowedRun> follows{}; ///< then the first record has gone out with number 0

    friend bool operator==(const RunStart&, const RunStart&) = default;
};

/// What a run_ended row remembers of Outcome, for the records that the run has left open.
struct RunEnd {
    RecordNumber broken_off;
    bool unclear = false;

    friend bool operator==(const RunEnd&, const RunEnd&) = default;
};

[[nodiscard]] std::string run_start_json(const std::string& printer, const feeder::BeginRun& begin,
                                         const std::optional<FollowedRun>& follows = {});
/// std::nullopt if the text is not what run_start_json() wrote.
[[nodiscard]] std::optional<RunStart> parse_run_start(const std::string& json);
/// {"sm":[depth,entries,last,stop,finished]}
[[nodiscard]] std::string mail_json(const protocol::MailStatus& mail);
[[nodiscard]] std::string settle_json(const feeder::Settle& settle);
[[nodiscard]] std::string outcome_json(const feeder::Outcome& outcome);
/// std::nullopt if the text is no JSON.
[[nodiscard]] std::optional<RunEnd> parse_run_end(const std::string& json);

} // namespace linefeed::store
