// A ledger small enough to be believed at a glance: the fate of each record, and what may go out.
#pragma once

#include "feeder/actions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace linefeed::feeder {

/// What the ledger knows of a record.
enum class Fate { fresh, open, printed, unused, in_doubt, skipped };

/// The ledger of one job with the records 1…records.
class LedgerDouble {
public:
    explicit LedgerDouble(std::uint32_t records)
        : fates_(records + 1, Fate::fresh) {}

    [[nodiscard]] Fate& fate(std::uint32_t number) { return fates_[number]; }
    [[nodiscard]] RecordRange granted() const { return granted_; }
    [[nodiscard]] RecordNumber issued() const { return issued_; }

    /// Every record is printed, or was decided by the operator.
    [[nodiscard]] bool done() const {
        return std::all_of(fates_.begin() + 1, fates_.end(),
                           [](Fate fate) { return fate == Fate::printed || fate == Fate::skipped; });
    }

    [[nodiscard]] std::optional<OpenRun> open_run() const {
        const auto first = std::find(fates_.begin(), fates_.end(), Fate::open);
        if (first == fates_.end()) {
            return std::nullopt;
        }
        OpenRun run = started_;
        const auto behind = std::find_if(first, fates_.end(), [](Fate fate) { return fate != Fate::open; });
        run.printed_through = RecordNumber{number_of(first) - 1};
        run.issued_through = RecordNumber{number_of(behind) - 1};
        return run;
    }

    /// The first record that may be printed; absent = there is none.
    [[nodiscard]] std::optional<std::uint32_t> next_printable() const {
        for (std::uint32_t number = 1; number < fates_.size(); ++number) {
            if (fates_[number] == Fate::fresh || fates_[number] == Fate::unused) {
                return number;
            }
        }
        return std::nullopt;
    }

    /// Begins a run over the first stretch that may be printed; false if there is none. Only `imported` records are
    /// there so far.
    [[nodiscard]] bool grant(const BeginRun& begin, std::uint32_t imported) {
        const auto printable = [](Fate fate) { return fate == Fate::fresh || fate == Fate::unused; };
        const auto first = std::find_if(fates_.begin() + 1, fates_.end(), printable);
        const auto behind = std::find_if_not(first, fates_.end(), printable);
        if (first == fates_.end()) {
            return false;
        }
        granted_ = RecordRange::closed(RecordNumber{number_of(first)}, RecordNumber{number_of(behind) - 1});
        started_ = {granted_.first(), {}, {}, "S1", begin.printer.total_prints, begin.last_printed_before,
                    granted_.last()};
        issued_ = granted_.first().previous();
        issue(std::min({granted_.last().value(), granted_.first().value() + 11, imported}));
        return true;
    }

    void confirm(std::uint32_t through) {
        for (std::uint32_t number = granted_.first().value(); number <= through; ++number) {
            fates_[number] = Fate::printed;
        }
    }

    void issue(std::uint32_t through) {
        for (std::uint32_t number = issued_.value() + 1; number <= through; ++number) {
            fates_[number] = Fate::open;
        }
        issued_ = RecordNumber{std::max(issued_.value(), through)};
    }

    void settle(const Settle& settle) {
        set(settle.verdict.printed, Fate::printed);
        set(settle.verdict.in_doubt, Fate::in_doubt);
        if (!settle.provisional) {
            forget_open(); // issued, but never sent
        }
    }

    /// The end of a run that has sent nothing.
    void forget_open() { std::replace(fates_.begin(), fates_.end(), Fate::open, Fate::unused); }

private:
    using Place = std::vector<Fate>::const_iterator;

    [[nodiscard]] std::uint32_t number_of(Place place) const {
        return static_cast<std::uint32_t>(place - fates_.begin());
    }
    void set(const RecordRange& range, Fate fate) {
        for (std::uint64_t i = 0; i < range.count().value(); ++i) {
            ASSERT_EQ(fates_[range.first().value() + i], Fate::open);
            fates_[range.first().value() + i] = fate;
        }
    }

    std::vector<Fate> fates_;
    RecordRange granted_;
    RecordNumber issued_;
    OpenRun started_;
};

} // namespace linefeed::feeder
