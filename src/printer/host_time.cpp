#include "printer/host_time.hpp"

#include <array>
#include <charconv>
#include <ctime>
#include <optional>
#include <string>

namespace linefeed::printer {

using protocol::ClockTime;
using protocol::PrinterTime;

namespace {

/// `####-##-## ##:##:##`
std::optional<PrinterTime> read_digits(std::string_view text) {
    constexpr std::string_view form = "####-##-## ##:##:##";
    if (text.size() != form.size()) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < form.size(); ++i) {
        const bool digit = text[i] >= '0' && text[i] <= '9';
        const bool right = form[i] == '#' ? digit : text[i] == form[i] || (form[i] == ' ' && text[i] == 'T');
        if (!right) {
            return std::nullopt;
        }
    }
    const auto number = [text](std::size_t place, std::size_t digits) {
        std::uint32_t value = 0;
        std::from_chars(text.data() + place, text.data() + place + digits, value);
        return value;
    };
    return PrinterTime{number(0, 4), number(5, 2), number(8, 2), number(11, 2), number(14, 2), number(17, 2)};
}

} // namespace

ClockTime host_clock() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm local{};
    ::localtime_r(&now, &local);
    const auto plain = [](int value) { return static_cast<std::uint32_t>(value); };
    return {{plain(local.tm_year + 1900), plain(local.tm_mon + 1), plain(local.tm_mday), plain(local.tm_hour),
             plain(local.tm_min), std::min(plain(local.tm_sec), 59U)},
            plain(local.tm_wday)};
}

Result<ClockTime> read_clock(std::string_view text) {
    if (text.empty() || text == "now") {
        return host_clock();
    }
    const auto time = read_digits(text);
    const auto moment = time ? to_sys_seconds(*time) : std::nullopt;
    if (!moment || time->year < 1601) {
        return Failure{FailureKind::usage,
                       "\"" + std::string{text} + "\" is no moment: write it as \"2026-11-26 10:00:00\", or say now"};
    }
    return ClockTime{*time, protocol::weekday_of(*moment)};
}

std::chrono::seconds ahead_of(const ClockTime& clock, const ClockTime& other) {
    const auto a = to_sys_seconds(clock.time);
    const auto b = to_sys_seconds(other.time);
    return a && b ? *a - *b : std::chrono::seconds{0};
}

Json clock_json(const ClockTime& clock) {
    constexpr std::array<const char*, 7> names{"Sunday",   "Monday", "Tuesday", "Wednesday",
                                               "Thursday", "Friday", "Saturday"};
    return {{"time", to_string(clock.time)},
            {"weekday", names[clock.weekday % names.size()]},
            {"weekday_code", clock.weekday},
            {"ahead_of_this_computer_s", ahead_of(clock, host_clock()).count()}};
}

} // namespace linefeed::printer
