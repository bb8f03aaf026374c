// How frames are transmitted: `=FC =FL =NR` (protocol, sections 1, 4 and 6).
#pragma once

#include "protocol/commands.hpp"
#include "protocol/limits.hpp"

#include <cstdint>

namespace linefeed::protocol {

/// `=NR`, both ways: the CRC-32 of the next frame, from its `^` up to and without the CR (crc32.hpp).
struct NextCrc {
    static constexpr Parameter parameter = Parameter::NR;
    std::uint32_t crc = 0;

    static void describe(auto& visitor, auto& self) { visitor.number("crc", "a CRC", self.crc); }
    friend bool operator==(const NextCrc&, const NextCrc&) = default;
};

/// `=FC`, printer to host: the CRC-32 that the printer calculated, when it differed from the one announced.
struct CrcFailed {
    static constexpr Parameter parameter = Parameter::FC;
    std::uint32_t crc = 0;

    static void describe(auto& visitor, auto& self) { visitor.number("crc", "a CRC", self.crc); }
    friend bool operator==(const CrcFailed&, const CrcFailed&) = default;
};

/// `=FL`, host to printer: everything that the printer sends is filled with blanks to blocks of so many bytes, until
/// its next power on.
struct BlockLength {
    static constexpr Parameter parameter = Parameter::FL;
    std::uint32_t bytes = 1; ///< 1…2048

    static void describe(auto& visitor, auto& self) {
        visitor.number("bytes", "a block length", self.bytes, Limits{1, 2048});
    }
    friend bool operator==(const BlockLength&, const BlockLength&) = default;
};

} // namespace linefeed::protocol
