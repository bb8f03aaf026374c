// Credit by numbers (design, section 1): which records may go to the printer now. What can be in the printer is at most
// last sent − last printed; a stale report only makes the credit smaller. Besides the FIFO's room, two things limit a
// refill: the records at hand in memory, and the ledger's durable intents.
#pragma once

#include "base/record_number.hpp"

#include <optional>

namespace linefeed::feeder {

/// So many records are enough to start with, however deep the FIFO: the pages at hand in memory and the intents of the
/// grant cover them for sure.
inline constexpr RecordCount first_fill_at_most{256};

/// The numbers of one run. Flow: begin(), then supplied(), durable() and printed() as the facts come, take() after
/// each. Invariant: first − 1 ≤ printed_through ≤ sent_through ≤ min(durable, supplied, last), and sent − printed ≤
/// depth.
class Refill {
public:
    /// Precondition: the range is not empty and does not begin with 0; depth > 0.
    void begin(RecordRange range, RecordCount depth);

    /// As begin(), for a run that is under way: the printer holds records up to `sent_through` and has printed, or is
    /// printing, `printed_through`. Precondition: first − 1 ≤ printed_through ≤ sent_through ≤ durable_through.
    void resume(RecordRange range, RecordCount depth, RecordNumber durable_through, RecordNumber sent_through,
                RecordNumber printed_through);

    /// The run ends with `last`, before the end of its range. Precondition: nothing behind it was supplied.
    void end_at(RecordNumber last);

    /// Another job follows: the run goes on through `last`. Precondition: behind its end.
    void extend(RecordNumber last);

    /// Records up to `through` are in memory.
    void supplied(RecordNumber through);
    /// Intents up to `through` are durable.
    void durable(RecordNumber through);
    /// The printer has printed, or is printing, `through`. False, and nothing changes, if that cannot be: it was never
    /// sent, or the report goes back.
    [[nodiscard]] bool printed(RecordNumber through);

    /// The records to send now, at most the credit and at most so many; the caller sends them. Empty if nothing may go.
    [[nodiscard]] RecordRange take(RecordCount most = RecordCount{UINT32_MAX});
    /// How many records take() would give.
    [[nodiscard]] RecordCount ready() const;
    /// The whole FIFO (at most first_fill_at_most), or the whole rest of the run, is at hand and durable.
    [[nodiscard]] bool first_fill_ready() const;
    /// The next stretch of intents to ask for, if it is time: well before the durable ones are used up.
    [[nodiscard]] std::optional<RecordNumber> next_intent();

    [[nodiscard]] RecordRange range() const { return range_; }
    [[nodiscard]] RecordCount depth() const { return depth_; }
    [[nodiscard]] RecordNumber sent_through() const { return sent_through_; }
    [[nodiscard]] RecordNumber durable_through() const { return durable_through_; }
    [[nodiscard]] RecordNumber printed_through() const { return printed_through_; }
    /// At most so many records are in the printer.
    [[nodiscard]] RecordCount level() const { return sent_through_ - printed_through_; }
    [[nodiscard]] bool all_sent() const { return sent_through_ == range_.last(); }
    /// All that is at hand and durable was sent, and it was not all.
    [[nodiscard]] bool starved() const;

private:
    void check() const;
    /// No record behind this one may go out.
    [[nodiscard]] RecordNumber bound() const;

    RecordRange range_;
    RecordCount depth_;
    RecordNumber sent_through_;
    RecordNumber printed_through_;
    RecordNumber supplied_through_;
    RecordNumber durable_through_;
    RecordNumber intent_asked_;
};

} // namespace linefeed::feeder
