// The printer's calendar clock (`?DL`, `=DL`) and its lists of errors and events (`?EL`, `?EV`), reckoned from the
// instants of the driver: the model reads no clock of its own.
#pragma once

#include "base/time.hpp"
#include "protocol/list_messages.hpp"

#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

namespace linefeed::simulator {

/// The wall clock of the printer.
class PrinterClock {
public:
    /// `at_zero`: what the clock shows at Instant{}.
    explicit PrinterClock(std::chrono::sys_seconds at_zero)
        : at_zero_(at_zero) {}

    [[nodiscard]] std::chrono::sys_seconds read(Instant now) const {
        return at_zero_ + std::chrono::floor<std::chrono::seconds>(now.time_since_epoch());
    }
    void set(std::chrono::sys_seconds wall, Instant now) {
        at_zero_ = wall - std::chrono::floor<std::chrono::seconds>(now.time_since_epoch());
    }

private:
    std::chrono::sys_seconds at_zero_;
};

/// What happened last, oldest first.
template <typename Entry>
class Log {
public:
    static constexpr std::size_t max_entries = 64;

    /// Adds an entry; the oldest gives way when the list is full.
    void add(Entry entry) {
        if (entries_.size() == max_entries) {
            entries_.erase(entries_.begin());
        }
        entries_.push_back(std::move(entry));
    }
    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

private:
    std::vector<Entry> entries_;
};

} // namespace linefeed::simulator
