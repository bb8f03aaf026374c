// Measures one run on the feed thread: what its session says becomes figures of the line. Pure: numbers and instants
// in, counts out; no allocation.
#pragma once

#include "base/record_number.hpp"
#include "base/time.hpp"
#include "daemon/line_meters.hpp"
#include "feeder/actions.hpp"
#include "session/session.hpp"

#include <array>
#include <cstddef>

namespace linefeed::daemon {

/// Flow: on_effect() for every effect of the session, on_fact() behind every fact it was told. What a run of an earlier
/// process has written has no lead time here.
class RunMeasure {
public:
    /// `open_printed_through` = the last record of an open earlier run that was confirmed; 0 = none.
    RunMeasure(LineMeters& meters, RecordNumber open_printed_through)
        : meters_(meters)
        , open_printed_through_(open_printed_through) {}

    void on_effect(const session::Effect& effect, const feeder::Feeder& feeder);
    /// `at` = when the session was told.
    void on_fact(const session::Session& session, Instant at);

    /// More writes than these are under way in a FIFO only if each carries few records; then the newest two count as
    /// one that was written when the second was, so that a lead time is never shown longer than it was.
    static constexpr std::size_t writes_kept = 512;

private:
    void written(const session::RecordsWritten& write);
    void adopted(RecordNumber printed_through);
    void confirmed(RecordNumber through, RecordNumber before_run);
    void settled(const feeder::Settle& settle);
    void reported(RecordNumber through, Instant at);
    void look_for_underrun(const feeder::Feeder& feeder);
    void ended(const feeder::Outcome& outcome);
    void count_oddities(const session::SessionStatistics& statistics);

    struct WrittenThrough {
        RecordNumber first;
        RecordNumber through;
        Instant at{};
    };

    LineMeters& meters_;
    RecordNumber open_printed_through_;
    std::array<WrittenThrough, writes_kept> writes_{}; ///< ring: not yet reported printed, oldest first
    std::size_t oldest_ = 0;
    std::size_t size_ = 0;
    RecordNumber confirmed_through_; ///< counted as printed; 0 = none of this run
    RecordNumber settled_through_;   ///< of this run, by a verdict
    bool ran_empty_ = false;         ///< and has been counted
    session::SessionStatistics counted_;
};

} // namespace linefeed::daemon
