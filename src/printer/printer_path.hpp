// Paths of files in the printer (protocol, section 8): `FFSDISK\Jobs\Name.job`. People write them in UTF-8, the printer
// wants bytes of Windows-1252, and what a printer lists must come back to it byte for byte.
#pragma once

#include "base/failure.hpp"
#include "protocol/escapes.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::printer {

/// The bytes that the printer wants for a path as people write it; `/` is taken for `\`, a `\` in front or behind is
/// dropped. FailureKind::usage: empty, no UTF-8, a character that Windows-1252 does not have or that commands, a part
/// that is `.` or `..`, `^` for firmware without escapes, more than 260 bytes.
[[nodiscard]] Result<std::string> printer_path(std::string_view text, protocol::EscapeMode escapes);
/// The same, and it names one file: no jokers.
[[nodiscard]] Result<std::string> printer_file(std::string_view text, protocol::EscapeMode escapes);
/// A job: a name alone is one in the flash.
[[nodiscard]] Result<std::string> printer_job(std::string_view text, protocol::EscapeMode escapes);

/// Names as people write them, in UTF-8.
[[nodiscard]] std::string path_text(std::string_view bytes);
/// The bytes behind path_text(); std::nullopt = no UTF-8, or a character that Windows-1252 does not have.
[[nodiscard]] std::optional<std::string> path_bytes(std::string_view text);

/// Whether two paths name the same file: capitals make no difference, nor does a `\` in front.
[[nodiscard]] bool same_path(std::string_view a, std::string_view b);

/// The default directories of all devices that the manual names; which of them a printer has, it tells: the SD card is
/// that of a JET3, on a stick each family has its own folder.
inline constexpr std::array<std::string_view, 12> default_directories{
    "FFSDISK\\Jobs",
    "FFSDISK\\Fonts",
    "FFSDISK\\Graphics",
    "Storage Card\\LJ3\\Jobs",
    "Storage Card\\LJ3\\Fonts",
    "Storage Card\\LJ3\\Graphics",
    "USB-Stick\\LJ3\\Jobs",
    "USB-Stick\\LJ3\\Fonts",
    "USB-Stick\\LJ3\\Graphics",
    "USB-Stick\\LJet2neo\\Jobs",
    "USB-Stick\\LJet2neo\\Fonts",
    "USB-Stick\\LJet2neo\\Graphics",
};
/// It lies in one of them.
[[nodiscard]] bool in_default_directory(std::string_view path);

} // namespace linefeed::printer
