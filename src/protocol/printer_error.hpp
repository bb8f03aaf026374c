// The error number of `=RS` taken apart (protocol, section 4, RS).
#pragma once

#include <cstdint>
#include <string>

namespace linefeed::protocol {

/// Bits 26/25: which processor reports.
enum class ErrorSource { fep /*user interface*/, rip /*print processing, hydraulics*/, sdc /*dots, head*/, unknown };
/// Bits 31/30: the window on the printer's panel, and so how serious it is.
enum class ErrorDisplay { error, warning, message, unknown };
/// Bits 29/28.
enum class ErrorTone { permanent, once, none, unknown };

/// Error codes that mailing raises (field notes, "Error numbers").
namespace error_code {
inline constexpr std::uint32_t buffer_full = 1015;
inline constexpr std::uint32_t number_wrong = 1018;
inline constexpr std::uint32_t number_not_consecutive = 1019;
inline constexpr std::uint32_t last_record_printed = 1223;
inline constexpr std::uint32_t buffer_empty = 5043;
} // namespace error_code

/// A pending error as the printer reports it.
struct PrinterError {
    /// The 32-bit value as transferred, a signed decimal; 0 = no error.
    std::int32_t raw = 0;

    [[nodiscard]] bool none() const { return raw == 0; }
    /// Bits 24…0: which error.
    [[nodiscard]] std::uint32_t code() const;
    /// Bits 23…0: some firmware sets bit 24 as well (field notes, "Firmware habits").
    [[nodiscard]] std::uint32_t code_without_bit_24() const;
    [[nodiscard]] ErrorSource source() const;
    [[nodiscard]] ErrorDisplay display() const;
    [[nodiscard]] ErrorTone tone() const;
    /// Bit 27 clear: the machine switches itself off after 30 minutes unless the error is acknowledged.
    [[nodiscard]] bool switches_off() const;

    friend bool operator==(const PrinterError&, const PrinterError&) = default;
};

/// One line in words, e.g. "1223 (last data base entry printed), message from RIP"; shows both readings of the number
/// when bit 24 is set.
[[nodiscard]] std::string describe(const PrinterError& error);

} // namespace linefeed::protocol
