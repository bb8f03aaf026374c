// Bytes as nibbles: `A` = 0 … `P` = 15, the high nibble first (protocol, sections 4 GW and 8 FT).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// Appends two characters for each byte.
void append_nibbles(std::string& out, std::string_view bytes);

/// The bytes, or std::nullopt for an odd length or a character beyond A…P.
[[nodiscard]] std::optional<std::string> read_nibbles(std::string_view nibbles);

} // namespace linefeed::protocol
