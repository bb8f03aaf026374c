// The printer's error numbers in words, with what to do, and what linefeed does: an editable file of the plant
// (config/errors.yaml), since the vendor's own table differs between machines (field notes, "Error numbers").
#pragma once

#include "protocol/printer_error.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace linefeed::config {

/// What linefeed does when the printer reports an error number. There is no blind `!EQ`: only numbers that say so are
/// acknowledged.
enum class ErrorPolicy {
    report,      ///< show it; the printer decides whether it goes on
    acknowledge, ///< show it and send `!EQ`, also before a start
    stop,        ///< stop the line, and take the truth down
};

/// One number.
struct ErrorEntry {
    std::uint32_t number = 0; ///< 1…33554431, bits 24…0 of what the printer sends
    std::string meaning{};    ///< in words
    std::string advice{};     ///< what the operator should do; may be empty
    ErrorPolicy policy = ErrorPolicy::report;

    friend bool operator==(const ErrorEntry&, const ErrorEntry&) = default;
};

struct ErrorTable {
    /// For numbers that are not listed; never acknowledge.
    ErrorPolicy unlisted = ErrorPolicy::report;
    std::vector<ErrorEntry> entries{}; ///< in the order of the file, each number once

    /// The entry for what the printer reported, also where the firmware sets bit 24 besides; nullptr = not listed.
    [[nodiscard]] const ErrorEntry* find(const protocol::PrinterError& error) const;
    friend bool operator==(const ErrorTable&, const ErrorTable&) = default;
};

} // namespace linefeed::config
