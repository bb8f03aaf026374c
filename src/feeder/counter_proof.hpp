// Does the total print counter bear out the record numbers that the printer reports? A stop at the panel throws the
// FIFO away, and a refill under way lets the printer go on behind the gap: its number then claims prints that never
// were. Where no stop point shows the stop, only the counter (protocol, section 4, CC) tells. It is not read in the
// same moment as the number, so the order of the answers decides what it proves.
#pragma once

#include "base/time.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace linefeed::feeder {

/// Flow: wants_count() → `?CC`, `?SM`, `?SM` → counted() → reported() for each `=SM` behind it. Prints are counted from
/// the begin of the run.
class CounterProof {
public:
    /// How long the counter may lag behind the reported number.
    static constexpr Duration patience = std::chrono::milliseconds{100};
    /// Least time between two counts.
    static constexpr Duration interval = std::chrono::milliseconds{40};

    /// Of the first `through` records some may be missing in the printer: the numbers count only if the counter bears
    /// them out, until it has done so for all of these.
    void doubt(std::uint64_t through) {
        doubted_ = true;
        doubted_through_ = std::max(doubted_through_, through);
    }
    [[nodiscard]] bool doubted() const { return doubted_; }

    [[nodiscard]] bool wants_count(Instant now) const { return doubted_ && !prints_ && now >= next_; }

    enum class Result {
        consistent,
        no_counter, ///< it is not reported, or does not move: the numbers have to be believed
        behind,     ///< for longer than patience: records are missing
    };
    /// `?CC` was answered with `prints`; `claimed` prints were reported in answers before, and the printer got no more
    /// than `sent` records: a count above that proves nothing, since it is another's or damaged. `stop_would_show`: the
    /// stop point stands, so a later stop will be seen.
    [[nodiscard]] Result counted(std::optional<std::uint32_t> prints, std::uint64_t claimed, std::uint64_t sent,
                                 bool stop_would_show, Instant now);

    /// `=SM` claims this many prints, the one in progress included. True if all of them were surely made: the second
    /// answer behind the count is surely newer than it, and claims no more.
    [[nodiscard]] bool reported(std::uint64_t claimed);

private:
    bool doubted_ = false;
    std::uint64_t doubted_through_ = 0; ///< records
    bool stop_would_show_ = false;
    std::optional<std::uint32_t> prints_; ///< the last count, until an answer behind it is compared
    int reports_ = 0;                     ///< `=SM` answers since
    Instant next_{};
    std::optional<Instant> behind_since_;
};

} // namespace linefeed::feeder
