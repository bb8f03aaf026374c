// The bits of an error number and the few texts that are known, see printer_error.hpp.
#include "protocol/printer_error.hpp"

#include "base/assert.hpp"

#include <array>
#include <string_view>

namespace linefeed::protocol {

namespace {

constexpr std::uint32_t code_mask = 0x01FF'FFFF;
constexpr std::uint32_t code_mask_without_bit_24 = 0x00FF'FFFF;

struct KnownError {
    std::uint32_t code;
    std::string_view text;
};

/// Field notes, "Error numbers"; the vendor's own table is handed out on request.
constexpr std::array<KnownError, 8> known_errors{{
    {error_code::buffer_full, "mailing buffer full"},
    {error_code::number_wrong, "record number wrong or missing"},
    {error_code::number_not_consecutive, "record number not consecutive"},
    {error_code::last_record_printed, "last data base entry printed"},
    {error_code::buffer_empty, "mailing buffer empty"},
    {10202, "battery low"},
    {51001, "camera double trigger"},
    {51009, "camera double trigger"},
}};

/// The `count` bits of the transferred value from `lowest` up.
std::uint32_t bits(std::int32_t raw, unsigned lowest, unsigned count) {
    return (static_cast<std::uint32_t>(raw) >> lowest) & ((1U << count) - 1U);
}

void append_number(std::string& out, std::uint32_t number) {
    out += std::to_string(number);
    for (const KnownError& known : known_errors) {
        if (known.code == number) {
            out.append(" (").append(known.text).append(")");
        }
    }
}

std::string_view words(ErrorDisplay display) {
    switch (display) {
    case ErrorDisplay::error:
        return "error";
    case ErrorDisplay::warning:
        return "warning";
    case ErrorDisplay::message:
        return "message";
    case ErrorDisplay::unknown:
        return "notice";
    }
    assertion_failed("ErrorDisplay", __FILE__, __LINE__);
}

std::string_view words(ErrorSource source) {
    switch (source) {
    case ErrorSource::fep:
        return "FEP";
    case ErrorSource::rip:
        return "RIP";
    case ErrorSource::sdc:
        return "SDC";
    case ErrorSource::unknown:
        return "an unknown processor";
    }
    assertion_failed("ErrorSource", __FILE__, __LINE__);
}

} // namespace

std::uint32_t PrinterError::code() const {
    return static_cast<std::uint32_t>(raw) & code_mask;
}

std::uint32_t PrinterError::code_without_bit_24() const {
    return static_cast<std::uint32_t>(raw) & code_mask_without_bit_24;
}

ErrorSource PrinterError::source() const {
    constexpr std::array values{ErrorSource::fep, ErrorSource::rip, ErrorSource::sdc, ErrorSource::unknown};
    return values[bits(raw, 25, 2)];
}

bool PrinterError::switches_off() const {
    return bits(raw, 27, 1) == 0;
}

ErrorTone PrinterError::tone() const {
    constexpr std::array values{ErrorTone::permanent, ErrorTone::once, ErrorTone::none, ErrorTone::unknown};
    return values[bits(raw, 28, 2)];
}

ErrorDisplay PrinterError::display() const {
    constexpr std::array values{ErrorDisplay::error, ErrorDisplay::warning, ErrorDisplay::message,
                                ErrorDisplay::unknown};
    return values[bits(raw, 30, 2)];
}

std::string describe(const PrinterError& error) {
    if (error.none()) {
        return "no error";
    }
    std::string out;
    append_number(out, error.code());
    if (error.code() != error.code_without_bit_24()) {
        out += " or, without bit 24, ";
        append_number(out, error.code_without_bit_24());
    }
    return out.append(", ").append(words(error.display())).append(" from ").append(words(error.source()));
}

} // namespace linefeed::protocol
