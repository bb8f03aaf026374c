// From UTF-8 to what the printer's font wants: Latin-1, Windows-1252, or Unicode as hex digits (protocol, section 5).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace linefeed::protocol {

/// How a field's text is encoded for the printer.
enum class Charset {
    latin1,       ///< ISO 8859-1, one byte a character
    windows_1252, ///< one byte a character, with the euro sign and typographic quotes
    unicode_hex,  ///< 4 upper-case hex digits a character (UTF-16BE units), for jobs with Unicode fonts
};

/// Reads "latin1" (also "latin-1", "iso-8859-1"), "windows-1252" ("cp1252"), "unicode-hex" ("unicode", "hex"), whatever
/// the case.
[[nodiscard]] std::optional<Charset> charset_from_name(std::string_view name);
/// The first of the names above.
[[nodiscard]] std::string_view to_string(Charset charset);

/// A character decoded from UTF-8.
struct Utf8Character {
    char32_t code_point = 0;
    std::uint32_t bytes = 0; ///< how many bytes it takes, 1…4
};

/// The first character of `text` (not empty), strictly: no overlong forms, no surrogates, nothing beyond U+10FFFF.
/// std::nullopt if the text does not begin with valid UTF-8.
[[nodiscard]] std::optional<Utf8Character> decode_utf8(std::string_view text);

/// The byte for a character in latin1 or windows_1252, or std::nullopt if the charset does not have it.
[[nodiscard]] std::optional<unsigned char> to_single_byte(char32_t code_point, Charset charset);

/// The character behind a byte in latin1 or windows_1252 (undefined bytes of windows_1252 give U+FFFD): for showing
/// what was printed.
[[nodiscard]] char32_t from_single_byte(unsigned char byte, Charset charset);

} // namespace linefeed::protocol
