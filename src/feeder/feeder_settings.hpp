// What the feeder is given before it begins: what the operator allows, the beat, and what an earlier run has left open.
#pragma once

#include "base/bounded_list.hpp"
#include "base/record_number.hpp"
#include "base/time.hpp"
#include "feeder/numbering.hpp"
#include "feeder/pacing.hpp"
#include "feeder/reconcile.hpp"
#include "protocol/printer_error.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace linefeed::feeder {

/// Which error numbers of the printer stop the line, whatever window it shows them in.
struct StoppingErrors {
    std::vector<std::uint32_t> numbers{}; ///< bits 24…0 of the error, ascending
    bool all_others = false;              ///< not these, but all others

    [[nodiscard]] bool contain(const protocol::PrinterError& error) const;
};

/// What the operator allows, and the beat.
struct FeederSettings {
    PacingSettings pacing;
    /// `!NO` when the nozzle is closed, instead of refusing.
    bool open_nozzle = false;
    /// Error codes that may be acknowledged: while it prints, and before a start besides those of mailing, whose truth
    /// the ledger knows by then.
    BoundedList<std::uint32_t, 16> acknowledge;
    StoppingErrors stop_on;                                    ///< besides those that the printer shows as errors
    Duration status_interval = std::chrono::milliseconds{500}; ///< `?RS` while printing
    /// The same where no stop point would show a stop: if it comes in mid-print, and the line is started again before
    /// the next look, nothing tells that the product carries only a part.
    Duration unguarded_status_interval = std::chrono::milliseconds{100};
    Duration retry_interval = std::chrono::milliseconds{20}; ///< between inquiries while waiting for a state
    /// From the first fill to `!GO`: the first product may come at once, and its record must lie in the FIFO 3 ms
    /// before (protocol, section 5).
    Duration fill_lead = std::chrono::milliseconds{4};
    Duration flush_timeout = std::chrono::seconds{2};
    Duration verify_timeout = std::chrono::seconds{5};
    Duration start_timeout = std::chrono::seconds{15};
    Duration stop_timeout = std::chrono::seconds{10};
    Duration stop_repeat = std::chrono::milliseconds{500}; ///< `!ST` again while it prints on: one may be lost
    Duration go_repeat = std::chrono::seconds{1};          ///< `!GO` again while it stands with the whole fill
    Duration finish_timeout = std::chrono::seconds{2};     ///< for the print in progress, and for `!EQ` to be seen
    Duration nozzle_timeout = std::chrono::seconds{120};
    /// Records of the first fill, and of one refill, at most: what a slow line carries in a moment.
    RecordCount fill_at_most = RecordCount{UINT32_MAX};
    RecordCount refill_at_most = RecordCount{UINT32_MAX};
    /// Records in the printer at most, however deep its FIFO: what a stop throws away has to be sent again.
    RecordCount level_at_most = RecordCount{UINT32_MAX};
};

/// What is known before the printer is asked.
struct FeederPlan {
    /// Records issued earlier whose fate the printer may know.
    std::optional<OpenRun> open;
    /// Of the open run.
    Numbering numbering{};
    /// If some of those stay in doubt, nothing is printed before an operator has decided.
    bool doubt_blocks = true;
    /// The open run may be gone on with if it is found printing.
    bool take_over = false;
};

} // namespace linefeed::feeder
