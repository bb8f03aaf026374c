// The ledger seen record by record: what is known of each, since when, in which run, and on what evidence it rests.
#pragma once

#include "spool/ledger.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace linefeed::spool {

/// Consecutive records with the same fate and the same evidence.
struct HistoryStretch {
    RecordRange range;
    RecordState state = RecordState::fresh;
    RunId run{};
    std::int64_t from_ns = 0; ///< the fate came about not before …
    std::int64_t to_ns = 0;   ///< … and not after this; wall time, ns since the Unix epoch
    std::string evidence;     ///< JSON of the row that says so

    friend bool operator==(const HistoryStretch&, const HistoryStretch&) = default;
};

/// Flow: add() every row of a job in order, then stretches(). A record printed between two reports was printed between
/// their times.
class LedgerHistory {
public:
    void add(const LedgerRow& row);
    /// Ascending and disjoint; records that were never issued do not appear.
    [[nodiscard]] std::vector<HistoryStretch> stretches() const;

private:
    void cut_out(RecordRange range);
    [[nodiscard]] std::vector<HistoryStretch> in_doubt_within(RecordRange range) const;

    std::map<RecordNumber, HistoryStretch> by_first_;
    std::map<RunId, std::int64_t> last_report_ns_; ///< time of the run's begin, or of the last printed row
};

} // namespace linefeed::spool
