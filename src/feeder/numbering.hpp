// Which number each record of a run goes out with. As a rule the numbers of the job. Where a second job follows the
// first without a stop, its first record goes out with number 0, which begins a new sequence (protocol, section 5, the
// numbering law), and the same number may belong to a record of either job. So the feeder and the ledger count in
// *places*: those of the first job are its numbers, and the records of the job behind it lie at the places behind them.
#pragma once

#include "base/record_number.hpp"

#include <array>
#include <cstddef>

namespace linefeed::feeder {

/// Flow: append() when a job follows, forget_before() when none of the job before it can be reported any more.
class Numbering {
public:
    /// The places are the numbers.
    Numbering() = default;
    /// The same, but the record at `first` went out with number 0: its job followed another.
    [[nodiscard]] static Numbering begun_with_zero(RecordNumber first);

    /// From the place `first` on lies a job whose first record has the number `number`, and goes out with 0.
    /// Precondition: behind what lies there already; forget_before() has left room.
    void append(RecordNumber first, RecordNumber number);
    /// From now on only records at `place` and behind it are asked for and reported.
    void forget_before(RecordNumber place);

    /// The places are the numbers, and none goes out with 0.
    [[nodiscard]] bool is_plain() const { return count_ == 1 && !parts_[0].begins_with_zero; }
    /// The record's number in its job; a place before all that is known is taken for a number.
    [[nodiscard]] RecordNumber number_of(RecordNumber place) const;
    /// The number that it goes out with.
    [[nodiscard]] RecordNumber on_wire(RecordNumber place) const;
    /// Where the record lies that the printer calls `said`, if it is one from `from` to `through`. Any other number
    /// becomes a place outside of these, and 0 stays 0.
    [[nodiscard]] RecordNumber place_of(RecordNumber said, RecordNumber from, RecordNumber through) const;
    /// A record that goes out with number 0 lies at one of these places.
    [[nodiscard]] bool has_zero(RecordNumber from, RecordNumber through) const;
    /// As long as no record behind this one is sent, each number that the printer may report means one record only.
    /// It has printed, or is printing, `printed_through`.
    [[nodiscard]] RecordNumber distinct_through(RecordNumber printed_through) const;

private:
    /// The records of one job, up to the next part.
    struct Part {
        RecordNumber first;  ///< place
        RecordNumber number; ///< of the record there
        bool begins_with_zero = false;
    };
    static constexpr std::size_t max_parts = 2; ///< a third job waits until the first is printed
    [[nodiscard]] const Part& part_of(RecordNumber place) const;

    std::array<Part, max_parts> parts_{};
    std::size_t count_ = 1;
};

} // namespace linefeed::feeder
