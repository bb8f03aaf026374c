// Dates as the printer writes them: parameters of `=DL`, packed into 32 bits in `=SH`, as text in the error list and
// the event list (protocol, section 4). No time zone: the printer shows what it was set to.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// A moment of the printer's calendar. Need not be a date that exists: see to_sys_seconds().
struct PrinterTime {
    std::uint32_t year = 0;
    std::uint32_t month = 0; ///< 1…12
    std::uint32_t day = 0;   ///< 1…31
    std::uint32_t hour = 0;
    std::uint32_t minute = 0;
    std::uint32_t second = 0;
    friend bool operator==(const PrinterTime&, const PrinterTime&) = default;
};

/// The moment as the standard library counts, or std::nullopt if there is no such date or time of day.
[[nodiscard]] std::optional<std::chrono::sys_seconds> to_sys_seconds(const PrinterTime& time);
/// Precondition: a year from 0 on.
[[nodiscard]] PrinterTime to_printer_time(std::chrono::sys_seconds moment);
/// 0 = Sunday … 6 = Saturday.
[[nodiscard]] std::uint32_t weekday_of(std::chrono::sys_seconds moment);

/// `date of last service` of `=SH`: bits 31-26 year−2000, 25-22 month, 21-17 day, 16-12 hour, 11-6 minute, 5-0 second.
[[nodiscard]] PrinterTime unpack_date(std::uint32_t packed);
/// Each part takes the bits that it has room for: the year 2000…2063.
[[nodiscard]] std::uint32_t pack_date(const PrinterTime& time);

/// Appends `yy-mm-dd hh:mm:ss`.
void append_short_date(std::string& out, const PrinterTime& time);
/// Reads `yy-mm-dd hh:mm:ss`, the year in 2000…2099; also `hh:mm::ss`, as the manual has it for the event list. The
/// date need not exist: a clock that was never set shows 00-00-00.
[[nodiscard]] std::optional<PrinterTime> read_short_date(std::string_view text);

/// E.g. "2024-05-06 07:08:09".
[[nodiscard]] std::string to_string(const PrinterTime& time);

} // namespace linefeed::protocol
