// What is remembered of a printer while it is switched off.
#pragma once

#include <cstdint>
#include <string>

namespace linefeed::spool {

struct PrinterMemory {
    // As `?VS` has said.
    std::string serial_number{};
    std::string type{};
    std::string firmware{};
    /// What the last probe of this machine with this firmware found, JSON; empty = none.
    std::string probe{};
    std::int64_t probed_ns = 0; ///< wall time; 0 = not probed

    friend bool operator==(const PrinterMemory&, const PrinterMemory&) = default;
};

} // namespace linefeed::spool
