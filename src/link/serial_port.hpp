// A serial line to a printer: raw, 8N1, for one program at a time.
#pragma once

#include "base/failure.hpp"
#include "link/printer_address.hpp"

#include <cstdint>
#include <span>

namespace linefeed::link {

/// The speeds a serial line can have, in baud, ascending.
[[nodiscard]] std::span<const std::uint32_t> serial_speeds();

/// Bytes per second, each way: a byte takes ten bits, with start and stop bit.
[[nodiscard]] double bytes_per_second(const SerialAddress& address);

/// Opens the device as the address says: exclusive, closed on exec, without delay where the driver can, and without
/// what had come in before. The descriptor does not block. FailureKind::unreachable if it cannot be opened or is not a
/// serial line; the message says what to do, and does not name the device.
[[nodiscard]] Result<int> open_serial(const SerialAddress& address);

/// How many bytes wait to go out; 0 where the driver does not tell.
[[nodiscard]] int bytes_waiting(int descriptor);

/// Throws away what waits to go out: closing would wait for it, for a printer that is switched off up to half a minute.
void discard_waiting(int descriptor);

} // namespace linefeed::link
