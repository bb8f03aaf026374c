// One frame of the interface protocol: `^` address group payload CR (protocol, section 1).
#pragma once

#include <cstddef>
#include <string_view>

namespace linefeed::protocol {

/// The five command groups (protocol, section 1).
enum class Group : char {
    script = '*',    ///< a line of an LJ script
    action = '!',    ///< an action without parameters
    inquiry = '?',   ///< asks for a parameter transfer
    parameter = '=', ///< transfers parameters
    file = '$',      ///< file transfer and directories
};

/// The address of the printer; 1…9 and A…F are reserved.
inline constexpr char printer_address = '0';

/// Largest string behind `=MR` that the printer takes; it truncates longer ones silently (protocol, section 5).
inline constexpr std::size_t max_record_bytes = 2048;

/// Frames up to this size from `^` to the last byte before CR are decoded whole. The largest legal frame is a file
/// block of 2048 bytes as nibbles (4096) or a mail record of 2048 escaped bytes, each with a short head.
inline constexpr std::size_t max_frame_bytes = 8192;

/// A decoded frame. The views are valid until the decoder is used again.
struct Frame {
    char address = printer_address;
    Group group = Group::action;
    /// Everything behind the group character, escapes not undone, without a LF directly before the CR.
    std::string_view payload;
    /// The bytes from `^` up to and without CR, as received: what the CRC-32 of section 6 covers.
    std::string_view raw;
    /// The frame carried the 5-digit length of `!LN`.
    bool has_length = false;
    /// The frame was longer than max_frame_bytes: `payload` holds its beginning, the rest is dropped.
    bool truncated = false;
};

} // namespace linefeed::protocol
