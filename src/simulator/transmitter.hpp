// How the printer puts frames on the wire (protocol, sections 1 and 6): length prefix, fixed blocks and line end belong
// to the printer, not to a connection, so they outlive the client that switched them on.
#pragma once

#include "simulator/printer_settings.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace linefeed::simulator {

/// The framing modes, and the bytes they make of a frame.
class Transmitter {
public:
    explicit Transmitter(LineEnd line_end)
        : line_end_(line_end) {}

    void set_length(bool on) { length_on_ = on; }
    void set_echo(bool on) { echo_on_ = on; }
    /// 1…2048 as in `=FL`, or 0 for off.
    void set_block_length(std::uint32_t bytes) { block_length_ = bytes; }
    [[nodiscard]] bool echo_on() const { return echo_on_; }

    /// Appends `frame`, complete from `^` to CR and without a length, as the printer sends it; `secured` puts the
    /// printer's own `=NR` before it.
    void append(std::string& out, std::string_view frame, bool secured) const;

private:
    void append_one(std::string& out, std::string_view frame) const;
    [[nodiscard]] std::string with_length(std::string_view frame) const;

    LineEnd line_end_;
    bool length_on_ = false;
    bool echo_on_ = false;
    std::uint32_t block_length_ = 0;
};

} // namespace linefeed::simulator
