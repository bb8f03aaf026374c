// The three ways in which the printer writes a date, see printer_time.hpp.
#include "protocol/printer_time.hpp"

#include "protocol/decimal.hpp"

#include <array>
#include <cstddef>

namespace linefeed::protocol {

namespace {

constexpr std::uint32_t century = 2000;

/// A part of the packed date: how many bits, from the lowest up.
struct Part {
    std::uint32_t PrinterTime::*member;
    unsigned bits;
};
constexpr std::array<Part, 5> packed_parts{{
    {&PrinterTime::second, 6},
    {&PrinterTime::minute, 6},
    {&PrinterTime::hour, 5},
    {&PrinterTime::day, 5},
    {&PrinterTime::month, 4},
}};
constexpr unsigned year_shift = 26;
constexpr std::uint32_t year_mask = 0x3F;

/// A part of the short date and what must stand before it.
struct ShortPart {
    std::uint32_t PrinterTime::*member;
    char before;
};
constexpr std::array<ShortPart, 6> short_parts{{
    {&PrinterTime::year, '\0'},
    {&PrinterTime::month, '-'},
    {&PrinterTime::day, '-'},
    {&PrinterTime::hour, ' '},
    {&PrinterTime::minute, ':'},
    {&PrinterTime::second, ':'},
}};
constexpr std::size_t part_digits = 2;

void append_two_digits(std::string& out, std::uint32_t value) {
    out.push_back(static_cast<char>('0' + value / 10 % 10));
    out.push_back(static_cast<char>('0' + value % 10));
}

} // namespace

std::optional<std::chrono::sys_seconds> to_sys_seconds(const PrinterTime& time) {
    constexpr std::uint32_t last_year = 32767; // of std::chrono::year
    if (time.year > last_year || time.month > 12 || time.day > 31 || time.hour > 23 || time.minute > 59 ||
        time.second > 59) {
        return std::nullopt;
    }
    const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(time.year)},
                                           std::chrono::month{time.month}, std::chrono::day{time.day}};
    if (!date.ok()) {
        return std::nullopt;
    }
    return std::chrono::sys_days{date} + std::chrono::hours{time.hour} + std::chrono::minutes{time.minute} +
           std::chrono::seconds{time.second};
}

PrinterTime to_printer_time(std::chrono::sys_seconds moment) {
    const auto days = std::chrono::floor<std::chrono::days>(moment);
    const std::chrono::year_month_day date{days};
    const std::chrono::hh_mm_ss<std::chrono::seconds> time{moment - days};
    return {static_cast<std::uint32_t>(static_cast<int>(date.year())),
            static_cast<unsigned>(date.month()),
            static_cast<unsigned>(date.day()),
            static_cast<std::uint32_t>(time.hours().count()),
            static_cast<std::uint32_t>(time.minutes().count()),
            static_cast<std::uint32_t>(time.seconds().count())};
}

std::uint32_t weekday_of(std::chrono::sys_seconds moment) {
    return std::chrono::weekday{std::chrono::floor<std::chrono::days>(moment)}.c_encoding();
}

PrinterTime unpack_date(std::uint32_t packed) {
    PrinterTime time;
    for (const Part& part : packed_parts) {
        time.*part.member = packed & ((1U << part.bits) - 1U);
        packed >>= part.bits;
    }
    time.year = century + packed;
    return time;
}

std::uint32_t pack_date(const PrinterTime& time) {
    std::uint32_t packed = ((time.year - century) & year_mask) << year_shift;
    unsigned shift = 0;
    for (const Part& part : packed_parts) {
        packed |= (time.*part.member & ((1U << part.bits) - 1U)) << shift;
        shift += part.bits;
    }
    return packed;
}

void append_short_date(std::string& out, const PrinterTime& time) {
    for (const ShortPart& part : short_parts) {
        if (part.before != '\0') {
            out.push_back(part.before);
        }
        append_two_digits(out, time.*part.member);
    }
}

std::optional<PrinterTime> read_short_date(std::string_view text) {
    PrinterTime time;
    for (const ShortPart& part : short_parts) {
        if (part.before != '\0') {
            if (text.empty() || text.front() != part.before) {
                return std::nullopt;
            }
            text.remove_prefix(1);
        }
        if (part.member == &PrinterTime::second && text.starts_with(':')) {
            text.remove_prefix(1);
        }
        const auto value = read_decimal<std::uint32_t>(text.substr(0, part_digits));
        if (text.size() < part_digits || !value) {
            return std::nullopt;
        }
        time.*part.member = *value;
        text.remove_prefix(part_digits);
    }
    if (!text.empty()) {
        return std::nullopt;
    }
    time.year += century;
    return time;
}

std::string to_string(const PrinterTime& time) {
    std::string out;
    append_decimal(out, time.year / 100);
    append_short_date(out, time);
    return out;
}

} // namespace linefeed::protocol
