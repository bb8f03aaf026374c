// The print ledger: what was allowed to go out, what the printer reported, and on whose word each range rests.
// Append-only and hash-chained (SHA-256 over the previous row), so that a change shows. For every job at every moment:
// issued = printed + in doubt + unused + open.
#pragma once

#include "base/record_number.hpp"
#include "spool/job.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::spool {

/// What one row of the ledger says about its range.
enum class LedgerKind {
    run_started, ///< a run begins; the range is what it means to print; evidence: printer, identity, counters
    intent,      ///< these records may go out from now on: durable before the first of them is sent
    printed,     ///< the printer (or an operator) says that they were printed
    unused,      ///< they were issued and surely not printed: they may be issued again
    in_doubt,    ///< nobody knows
    skipped,     ///< in doubt, and an operator decided not to print them again
    released,    ///< in doubt, and an operator decided to print them again
    reprint,     ///< printed or skipped, and an operator wants them printed once more
    run_ended,   ///< the run is over; the range is empty; evidence: why
};

/// What is known about a record, the result of all rows about it.
enum class RecordState {
    fresh, ///< never issued
    open,  ///< issued, its fate not yet known
    printed,
    unused,   ///< issued, surely not printed; may be issued again
    in_doubt, ///< waits for an operator
    skipped,  ///< in doubt for good, not printed again
    released, ///< may be issued again by the word of an operator
};

[[nodiscard]] std::string_view to_string(LedgerKind kind);
[[nodiscard]] std::string_view to_string(RecordState state);

/// One row to append.
struct LedgerEntry {
    LedgerKind kind = LedgerKind::intent;
    RunId run{};
    RecordRange range;
    std::string evidence; ///< JSON object, one line; may be empty

    friend bool operator==(const LedgerEntry&, const LedgerEntry&) = default;
};

/// Rows to append to the ledger of one job.
struct JobRows {
    JobId job{};
    std::vector<LedgerEntry> entries;
};

/// One row as stored.
struct LedgerRow {
    std::int64_t sequence = 0; ///< 1, 2, 3 … over the whole spool
    JobId job{};
    LedgerEntry entry;
    std::int64_t time_ns = 0;  ///< wall time, ns since the Unix epoch
    std::string previous_hash; ///< hex; 64 zeros for the first row
    std::string hash;          ///< hex: SHA-256 over previous_hash and every other field
};

/// A stretch of records with one state.
struct LedgerSegment {
    RecordRange range;
    RecordState state = RecordState::fresh;
    RunId run{}; ///< the run of the row that gave it this state

    friend bool operator==(const LedgerSegment&, const LedgerSegment&) = default;
};

/// The state of every record of one job, folded from ledger rows. Records that no row names are fresh.
/// Segments are ascending, disjoint, not empty; neighbours with the same state and run are one.
class LedgerState {
public:
    LedgerState() = default;
    explicit LedgerState(std::vector<LedgerSegment> segments)
        : segments_(std::move(segments)) {}

    /// Takes one row into account. Returns false, and changes nothing, if the row contradicts the state: an intent over
    /// records that are printed, open, in doubt or skipped; a result (printed, unused, in_doubt) for records that are
    /// not open (printed, unused: or in doubt); skipped or released for records that are not in doubt; reprint for
    /// records that are neither printed nor skipped.
    [[nodiscard]] bool apply(const LedgerEntry& entry);

    [[nodiscard]] const std::vector<LedgerSegment>& segments() const { return segments_; }
    [[nodiscard]] RecordState state_of(RecordNumber number) const;
    /// How many records are in `state` (fresh excluded: the ledger does not know how many there are).
    [[nodiscard]] RecordCount count(RecordState state) const;
    /// All stretches in `state`, neighbours joined whatever their run.
    [[nodiscard]] std::vector<RecordRange> ranges(RecordState state) const;
    /// The next records of `wanted` to print: the first stretch whose records are all fresh, unused or released. Empty
    /// if there is none. A stretch ends before the first record that must not be issued.
    [[nodiscard]] RecordRange next_printable(RecordRange wanted) const;

    friend bool operator==(const LedgerState&, const LedgerState&) = default;

private:
    std::vector<LedgerSegment> segments_;
};

/// SHA-256 of a row, chained to `previous_hash`; hex, lower case.
[[nodiscard]] std::string ledger_hash(std::string_view previous_hash, std::int64_t sequence, JobId job,
                                      const LedgerEntry& entry, std::int64_t time_ns);

} // namespace linefeed::spool
