// Calendar and error list, see printer_clock.hpp.
#include "simulator/printer_clock.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace linefeed::simulator {
namespace {

/// A moment taken apart.
struct Calendar {
    std::chrono::year_month_day date;
    std::chrono::hh_mm_ss<std::chrono::seconds> time;
    unsigned weekday = 0; ///< 0 = Sunday

    explicit Calendar(std::chrono::sys_seconds wall)
        : date(std::chrono::floor<std::chrono::days>(wall))
        , time(wall - std::chrono::floor<std::chrono::days>(wall))
        , weekday(std::chrono::weekday{std::chrono::floor<std::chrono::days>(wall)}.c_encoding()) {}

    [[nodiscard]] int year() const { return static_cast<int>(date.year()); }
    [[nodiscard]] unsigned month() const { return static_cast<unsigned>(date.month()); }
    [[nodiscard]] unsigned day() const { return static_cast<unsigned>(date.day()); }
    [[nodiscard]] unsigned hour() const { return static_cast<unsigned>(time.hours().count()); }
    [[nodiscard]] unsigned minute() const { return static_cast<unsigned>(time.minutes().count()); }
    [[nodiscard]] unsigned second() const { return static_cast<unsigned>(time.seconds().count()); }
};

} // namespace

std::chrono::sys_seconds PrinterClock::read(Instant now) const {
    return at_zero_ + std::chrono::floor<std::chrono::seconds>(now.time_since_epoch());
}

void PrinterClock::set(std::chrono::sys_seconds wall, Instant now) {
    at_zero_ = wall - std::chrono::floor<std::chrono::seconds>(now.time_since_epoch());
}

std::string to_clock_values(std::chrono::sys_seconds wall) {
    const Calendar at{wall};
    std::array<char, 80> text{};
    const int size = std::snprintf(text.data(), text.size(), "%d\t%u\t%u\t%u\t%u\t%u\t%u", at.year(), at.month(),
                                   at.weekday, at.day(), at.hour(), at.minute(), at.second());
    return {text.data(), static_cast<std::size_t>(size)};
}

std::optional<std::chrono::sys_seconds> from_clock_values(std::span<const std::optional<std::uint32_t>> values) {
    constexpr std::size_t count = 7;
    if (values.size() < count || std::any_of(values.begin(), values.begin() + count, [](auto v) { return !v; })) {
        return std::nullopt;
    }
    if (*values[0] > 9999 || *values[1] > 12 || *values[2] > 6 || *values[3] > 31) {
        return std::nullopt;
    }
    const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(*values[0])},
                                           std::chrono::month{*values[1]}, std::chrono::day{*values[3]}};
    if (!date.ok() || *values[4] > 23 || *values[5] > 59 || *values[6] > 59) {
        return std::nullopt;
    }
    return std::chrono::sys_days{date} + std::chrono::hours{*values[4]} + std::chrono::minutes{*values[5]} +
           std::chrono::seconds{*values[6]};
}

std::uint32_t pack_date(std::chrono::sys_seconds wall) {
    const Calendar at{wall};
    const auto years = static_cast<std::uint32_t>(at.year() - 2000) & 0x3FU;
    return (years << 26U) | (at.month() << 22U) | (at.day() << 17U) | (at.hour() << 12U) | (at.minute() << 6U) |
           at.second();
}

void ErrorList::add(std::chrono::sys_seconds wall, std::uint32_t code) {
    const Calendar at{wall};
    std::array<char, 80> text{};
    const int size = std::snprintf(text.data(), text.size(), "%02u-%02u-%02u %02u:%02u:%02u/%08u",
                                   static_cast<unsigned>(at.year()) % 100U, at.month(), at.day(), at.hour(),
                                   at.minute(), at.second(), code);
    if (entries_.size() == max_entries) {
        entries_.pop_front();
    }
    entries_.emplace_back(text.data(), static_cast<std::size_t>(size));
}

std::deque<std::string> ErrorList::blocks() const {
    std::deque<std::string> out;
    std::size_t first = 0;
    do {
        const std::size_t count = std::min(entries_per_block, entries_.size() - first);
        std::string block =
            "EL" + std::to_string(first + 1) + '\t' + std::to_string(entries_.size()) + '\t' + std::to_string(count);
        for (std::size_t i = first; i < first + count; ++i) {
            block += '\t' + entries_[i];
        }
        out.push_back(std::move(block));
        first += count;
    } while (first < entries_.size());
    return out;
}

} // namespace linefeed::simulator
