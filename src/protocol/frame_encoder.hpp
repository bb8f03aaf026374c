// Writes frames (protocol, section 1). Payloads are complete: escaping is the business of whoever knows what is data.
#pragma once

#include "protocol/commands.hpp"
#include "protocol/frame.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// Appends `^0<group><payload>CR`. Precondition: the payload holds no CR.
void append_frame(std::string& out, Group group, std::string_view payload);

/// Appends `^0!XX CR`.
void append_action(std::string& out, Action action);

/// Appends `^0?XX CR`.
void append_inquiry(std::string& out, Parameter parameter);

/// Appends `^0<length><group><payload>CR` with the 5-digit length that a printer sends after `!LN`: the bytes from the
/// group character to the CR inclusive. Precondition: the payload holds no CR and at most 99 997 bytes.
void append_frame_with_length(std::string& out, Group group, std::string_view payload);

} // namespace linefeed::protocol
