// What a printer's line has done since the service started, as the metrics show it: written on the feed thread without
// locks or allocation, read by any thread.
#pragma once

#include "base/histogram.hpp"
#include "daemon/operations.hpp"

#include <atomic>
#include <cstdint>
#include <string>

namespace linefeed::daemon {

/// A count that one thread raises and any thread reads.
class SharedCount {
public:
    SharedCount& operator+=(std::uint64_t more) noexcept {
        value_.store(value_.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
        return *this;
    }
    operator std::uint64_t() const noexcept { return value_.load(std::memory_order_relaxed); }

private:
    std::atomic<std::uint64_t> value_{0};
};

using SharedHistogram = Histogram<SharedCount>;

/// Those of HistogramView: 1, 2, 3 and 5 of each decade from 1 µs to 100 s.
[[nodiscard]] HistogramView view(const SharedHistogram& histogram);

/// Of one printer. Lives longer than every run on it; one run at a time writes.
struct LineMeters {
    SharedCount records_sent;     ///< handed to the kernel
    SharedCount records_printed;  ///< for certain
    SharedCount records_in_doubt; ///< that came to be in doubt
    SharedCount records_unused;   ///< granted to a run, and surely not printed by it
    SharedCount underruns;        ///< the FIFO ran empty while the job had records
    SharedCount refills;          ///< writes with records
    SharedCount links_lost;
    SharedCount frames_unexpected;
    SharedCount bytes_damaged;
    /// Per record reported printed: from its being handed to the kernel to the report. The print itself was earlier, at
    /// most by the distance of the polls and the way of the answer; and the record reached the printer later.
    SharedHistogram lead_time;
    /// Per refill: from reading the answer that gave credit (or from the records' being at hand, where those were
    /// waited for) until the kernel had it whole.
    SharedHistogram refill;
};

[[nodiscard]] PrinterMetrics metrics_of(const std::string& printer, const LineMeters& meters);

} // namespace linefeed::daemon
