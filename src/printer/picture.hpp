// What the product will look like: `?GW` with `=SW` scrolling (protocol, section 4), as a PNG and for a terminal, dot
// by dot.
#pragma once

#include "base/failure.hpp"
#include "printer/printer_client.hpp"
#include "protocol/wysiwyg.hpp"

#include <cstdint>
#include <string>

namespace linefeed::printer {

/// A whole picture.
struct Picture {
    std::uint32_t width = 0;  ///< strokes
    std::uint32_t height = 0; ///< dots
    std::uint32_t job_id = 0;
    std::string strokes{}; ///< as in protocol::WysiwygImage, all of them

    /// Whether the dot is on; x from 0 (first stroke), y from 0 (dot Y.1, drawn on top). Precondition: within.
    [[nodiscard]] bool dot(std::uint32_t x, std::uint32_t y) const;
    friend bool operator==(const Picture&, const Picture&) = default;
};

/// Asks for details until the picture is whole; where the printer gives none, with its display switched on (`!W1`, and
/// `!W0` behind it). Leaves the start of the picture at 0. FailureKind::unreachable: no answer; ::input: what comes is
/// not plausible, or changes all the time.
[[nodiscard]] Result<Picture> ask_picture(PrinterClient& printer);

/// A PNG of two colours, black dots on white, each dot `scale` × `scale` pixels. Precondition: a picture with dots,
/// scale 1…32.
[[nodiscard]] Result<std::string> to_png(const Picture& picture, std::uint32_t scale);

enum class Drawing {
    unicode, ///< half blocks; where that is too wide braille, four dots high and two wide
    ascii,   ///< a character for each dot
};
/// Lines for a terminal so many columns wide: a picture that is wider goes on below. Precondition: columns ≥ 1.
[[nodiscard]] std::string to_text(const Picture& picture, std::uint32_t columns, Drawing drawing);

} // namespace linefeed::printer
