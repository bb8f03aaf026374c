// The printer's calendar clock (`?DL`, `=DL`) and its list of errors (`?EL`), both reckoned from the instants of the
// driver: the model reads no clock of its own.
#pragma once

#include "base/time.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>

namespace linefeed::simulator {

/// The wall clock of the printer.
class PrinterClock {
public:
    /// `at_zero`: what the clock shows at Instant{}.
    explicit PrinterClock(std::chrono::sys_seconds at_zero)
        : at_zero_(at_zero) {}

    [[nodiscard]] std::chrono::sys_seconds read(Instant now) const;
    void set(std::chrono::sys_seconds wall, Instant now);

private:
    std::chrono::sys_seconds at_zero_;
};

/// The seven values of `=DL`: year, month, weekday (0 = Sunday), day, hour, minute, second, separated by TAB.
[[nodiscard]] std::string to_clock_values(std::chrono::sys_seconds wall);
/// Reads them; the weekday follows from the date. std::nullopt unless all seven are there and are a date.
[[nodiscard]] std::optional<std::chrono::sys_seconds>
from_clock_values(std::span<const std::optional<std::uint32_t>> values);

/// `date of last service` of `=SH`: bits 31-26 year−2000, 25-22 month, 21-17 day, 16-12 hour, 11-6 minute, 5-0 second.
[[nodiscard]] std::uint32_t pack_date(std::chrono::sys_seconds wall);

/// The errors raised so far, oldest first.
class ErrorList {
public:
    static constexpr std::size_t max_entries = 64;
    static constexpr std::size_t entries_per_block = 32;

    /// Adds an error; the oldest gives way when the list is full.
    void add(std::chrono::sys_seconds wall, std::uint32_t code);
    /// The payloads of the `=EL` blocks: first, total, entries in the block, `yy-mm-dd hh:mm:ss/errornumber` each. At
    /// least one block.
    [[nodiscard]] std::deque<std::string> blocks() const;

private:
    std::deque<std::string> entries_;
};

} // namespace linefeed::simulator
