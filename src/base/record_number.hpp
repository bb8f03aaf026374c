// Record numbers, counts and ranges. A number is not a count: record 22118 is one record, and 22118 records are
// something else, so the two are different types and only the arithmetic that makes sense compiles.
#pragma once

#include "base/assert.hpp"

#include <compare>
#include <cstdint>
#include <limits>
#include <ostream>

namespace linefeed {

/// How many records.
class RecordCount {
public:
    constexpr RecordCount() = default;
    constexpr explicit RecordCount(std::uint64_t value)
        : value_(value) {}

    [[nodiscard]] constexpr std::uint64_t value() const { return value_; }

    friend constexpr auto operator<=>(RecordCount, RecordCount) = default;
    friend constexpr RecordCount operator+(RecordCount a, RecordCount b) { return RecordCount{a.value_ + b.value_}; }
    /// Precondition: a ≥ b.
    friend constexpr RecordCount operator-(RecordCount a, RecordCount b) {
        LINEFEED_ASSERT(a.value_ >= b.value_);
        return RecordCount{a.value_ - b.value_};
    }
    constexpr RecordCount& operator+=(RecordCount other) { return *this = *this + other; }
    friend std::ostream& operator<<(std::ostream& out, RecordCount count) { return out << count.value_; }

private:
    std::uint64_t value_ = 0;
};

/// The number of a mail record, first parameter of `=MR` (protocol, section 5): unsigned 32-bit. Number 0 is special to
/// the printer: it is never checked for order. As a position ("last printed"), 0 means "none yet".
class RecordNumber {
public:
    constexpr RecordNumber() = default;
    constexpr explicit RecordNumber(std::uint32_t value)
        : value_(value) {}

    [[nodiscard]] static constexpr RecordNumber max() {
        return RecordNumber{std::numeric_limits<std::uint32_t>::max()};
    }
    [[nodiscard]] constexpr std::uint32_t value() const { return value_; }
    /// The number that the numbering law demands after this one. Precondition: not max().
    [[nodiscard]] constexpr RecordNumber next() const {
        LINEFEED_ASSERT(value_ < max().value_);
        return RecordNumber{value_ + 1};
    }
    /// Precondition: not 0.
    [[nodiscard]] constexpr RecordNumber previous() const {
        LINEFEED_ASSERT(value_ > 0);
        return RecordNumber{value_ - 1};
    }

    friend constexpr auto operator<=>(RecordNumber, RecordNumber) = default;
    /// Precondition: the sum is at most max().
    friend constexpr RecordNumber operator+(RecordNumber number, RecordCount count) {
        LINEFEED_ASSERT(count.value() <= max().value_ - number.value_);
        return RecordNumber{static_cast<std::uint32_t>(number.value_ + count.value())};
    }
    /// How far `a` lies behind `b`. Precondition: a ≥ b.
    friend constexpr RecordCount operator-(RecordNumber a, RecordNumber b) {
        LINEFEED_ASSERT(a >= b);
        return RecordCount{a.value_ - b.value_};
    }
    friend std::ostream& operator<<(std::ostream& out, RecordNumber number) { return out << number.value_; }

private:
    std::uint32_t value_ = 0;
};

/// Consecutive record numbers, first and last included. May be empty.
class RecordRange {
public:
    constexpr RecordRange() = default;
    /// Precondition: the last number, first + count − 1, fits in 32 bits.
    constexpr RecordRange(RecordNumber first, RecordCount count)
        : first_(first)
        , count_(count) {
        LINEFEED_ASSERT(count.value() <= std::uint64_t{RecordNumber::max().value()} - first.value() + 1);
    }
    /// All numbers from `first` to `last`; empty if last < first.
    [[nodiscard]] static constexpr RecordRange closed(RecordNumber first, RecordNumber last) {
        return last < first ? RecordRange{first, RecordCount{0}} : RecordRange{first, last - first + RecordCount{1}};
    }

    [[nodiscard]] constexpr bool empty() const { return count_ == RecordCount{0}; }
    [[nodiscard]] constexpr RecordCount count() const { return count_; }
    [[nodiscard]] constexpr RecordNumber first() const { return first_; }
    /// Precondition: not empty.
    [[nodiscard]] constexpr RecordNumber last() const {
        LINEFEED_ASSERT(!empty());
        return RecordNumber{static_cast<std::uint32_t>(first_.value() + (count_.value() - 1))};
    }
    [[nodiscard]] constexpr bool contains(RecordNumber number) const {
        return !empty() && first_ <= number && number <= last();
    }

    friend constexpr bool operator==(const RecordRange& a, const RecordRange& b) {
        return a.count_ == b.count_ && (a.empty() || a.first_ == b.first_);
    }
    friend std::ostream& operator<<(std::ostream& out, const RecordRange& range) {
        return range.empty() ? out << "none" : out << range.first() << '-' << range.last();
    }

private:
    RecordNumber first_;
    RecordCount count_;
};

} // namespace linefeed
