// What a printer's line has done since the service started, as the metrics show it: written on the feed thread without
// locks or allocation, read by any thread.
#pragma once

#include "daemon/operations.hpp"
#include "store/shared_count.hpp"

#include <string>

namespace linefeed::daemon {

/// Those of HistogramView: 1, 2, 3 and 5 of each decade from 1 µs to 100 s.
[[nodiscard]] HistogramView view(const store::SharedHistogram& histogram);

/// Of one printer. Lives longer than every run on it; one run at a time writes.
struct LineMeters {
    store::SharedCount records_sent;     ///< handed to the kernel
    store::SharedCount records_printed;  ///< for certain
    store::SharedCount records_in_doubt; ///< that came to be in doubt
    store::SharedCount records_unused;   ///< granted to a run, and surely not printed by it
    store::SharedCount underruns;        ///< the FIFO ran empty while the job had records
    store::SharedCount refills;          ///< writes with records
    store::SharedCount links_lost;
    store::SharedCount frames_unexpected;
    store::SharedCount bytes_damaged;
    /// Per record reported printed: from its being handed to the kernel to the report. The print itself was earlier, at
    /// most by the distance of the polls and the way of the answer; and the record reached the printer later.
    store::SharedHistogram lead_time;
    /// Per refill: from reading the answer that gave credit (or from the records' being at hand, where those were
    /// waited for) until the kernel had it whole.
    store::SharedHistogram refill;
};

[[nodiscard]] PrinterMetrics metrics_of(const std::string& printer, const LineMeters& meters);

} // namespace linefeed::daemon
