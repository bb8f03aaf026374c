// What the ledger tells about records in doubt, and what an operator's word about them can be worth. Records are
// printed in order, so the record on the last product says that all before it are printed: unless the printer was
// stopped and started at its panel while records were on their way to it. A stop throws the FIFO away; what arrives
// behind it lands in the empty FIFO and is printed next, and the records between are on no product.
#pragma once

#include "base/failure.hpp"
#include "spool/spool.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::daemon {

/// The records of a job that wait for an operator, with what the printer said about them.
struct DoubtEvidence {
    std::vector<spool::LedgerSegment> segments; ///< in doubt, ascending; empty = nothing is in doubt
    std::vector<RecordRange> ranges;            ///< the same, neighbours joined
    /// Why the record on the last product does not say which of them are printed; empty = it does, within
    /// `most_printed`.
    std::string hole;
    /// The total print counter has seen no more prints than up to this record; absent = it does not tell.
    std::optional<RecordNumber> most_printed;

    [[nodiscard]] bool may_have_hole() const { return !hole.empty(); }
};

/// Reads it from the ledger rows of the run that left the records in doubt.
[[nodiscard]] Result<DoubtEvidence> doubt_evidence(spool::Spool& spool, const spool::Job& job);

} // namespace linefeed::daemon
