// Which pending errors come from mailing itself. Their cause is in the printed numbers, and so in the ledger by the
// time the feeder acknowledges them.
#pragma once

#include "protocol/printer_error.hpp"

#include <cstdint>

namespace linefeed::feeder {

/// Whether `error` is `code`. Some firmware sets bit 24 besides (field notes, "Firmware habits").
[[nodiscard]] inline bool is_error(const protocol::PrinterError& error, std::uint32_t code) {
    return error.code() == code || error.code_without_bit_24() == code;
}

/// 1018 or 1019: a record was lost on its way, or somebody else has sent one.
[[nodiscard]] inline bool breaks_numbers(const protocol::PrinterError& error) {
    namespace codes = protocol::error_code;
    return is_error(error, codes::number_wrong) || is_error(error, codes::number_not_consecutive);
}

/// 1015, 1018, 1019, 1223 or 5043.
[[nodiscard]] inline bool is_mailing_error(const protocol::PrinterError& error) {
    namespace codes = protocol::error_code;
    return breaks_numbers(error) || is_error(error, codes::buffer_full) ||
           is_error(error, codes::last_record_printed) || is_error(error, codes::buffer_empty);
}

} // namespace linefeed::feeder
