// Escapes of `^` and `\` in data (protocol, sections 1 and 9). Old firmware knows none: there both characters must not
// occur at all, so what the printer understands is a mode chosen by its firmware profile.
#pragma once

#include <string>
#include <string_view>

namespace linefeed::protocol {

/// What the printer's firmware makes of `\`.
enum class EscapeMode {
    none,      ///< no escapes: `^` and `\` must not be sent in data
    backslash, ///< `^` is sent as `\^` and `\` as `\\`
};

/// Appends `text` with `^` and `\` escaped (mode backslash), or as it is (mode none; the caller has checked that
/// neither occurs).
void append_escaped(std::string& out, std::string_view text, EscapeMode mode);

/// Undoes escapes leniently: `\\` becomes `\`, `\^` becomes `^`, a `\` before anything else stays (section 9). In mode
/// none the text comes back as it is.
[[nodiscard]] std::string unescape(std::string_view text, EscapeMode mode);

} // namespace linefeed::protocol
