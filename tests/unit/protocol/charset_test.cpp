// Strict UTF-8 in, the bytes of the printer's fonts out.
#include "protocol/charset.hpp"

#include <gtest/gtest.h>

#include <map>

namespace linefeed::protocol {
namespace {

using namespace std::string_view_literals;

void expect_character(std::string_view text, char32_t code_point, std::uint32_t bytes) {
    const auto character = decode_utf8(text);
    ASSERT_TRUE(character) << text;
    EXPECT_EQ(character->code_point, code_point);
    EXPECT_EQ(character->bytes, bytes);
}

TEST(Charset, shouldBeReadByNameWhateverTheCase) {
    for (const char* const name : {"latin1", "LATIN-1", "ISO-8859-1"}) {
        EXPECT_EQ(charset_from_name(name), Charset::latin1) << name;
    }
    for (const char* const name : {"windows-1252", "Windows-1252", "CP1252"}) {
        EXPECT_EQ(charset_from_name(name), Charset::windows_1252) << name;
    }
    for (const char* const name : {"unicode-hex", "Unicode", "HEX"}) {
        EXPECT_EQ(charset_from_name(name), Charset::unicode_hex) << name;
    }
    for (const char* const name : {"", "latin", "latin11", "utf-8", "[atin1"}) {
        EXPECT_EQ(charset_from_name(name), std::nullopt) << name;
    }
}

TEST(Charset, shouldShowANameThatReadsBack) {
    for (const Charset charset : {Charset::latin1, Charset::windows_1252, Charset::unicode_hex}) {
        EXPECT_EQ(charset_from_name(to_string(charset)), charset);
    }
    EXPECT_EQ(to_string(Charset::windows_1252), "windows-1252");
    EXPECT_DEATH(static_cast<void>(to_string(static_cast<Charset>(9))), "Charset");
}

TEST(Utf8, shouldDecodeCharactersOfEveryLength) {
    expect_character("Az", U'A', 1);
    expect_character("\0x"sv, U'\0', 1);
    expect_character("\x7F", 0x7F, 1);
    expect_character("\xC2\x80", 0x80, 2);
    expect_character("äz", U'ä', 2);
    expect_character("\xDF\xBF", 0x7FF, 2);
    expect_character("\xE0\xA0\x80", 0x800, 3);
    expect_character("€", U'€', 3);
    expect_character("\xED\x9F\xBF", 0xD7FF, 3);
    expect_character("\xEE\x80\x80", 0xE000, 3);
    expect_character("\xEF\xBF\xBF", 0xFFFF, 3);
    expect_character("\xF0\x90\x80\x80", 0x10000, 4);
    expect_character("😀!", U'😀', 4);
    expect_character("\xF4\x8F\xBF\xBF", 0x10FFFF, 4);
}

TEST(Utf8, shouldRefuseWhatIsNotStrictlyValid) {
    for (const std::string_view text : {
             "\x80"sv,
             "\xBF"sv, // a continuation alone
             "\xC3"sv,
             "\xE2\x82"sv,
             "\xF0\x9F\x98"sv, // cut short
             "\xC3z"sv,
             "\xE2z\x82"sv,
             "\xE2\x82z"sv,
             "\xF0\x9F\x98z"sv, // no continuation
             "\xC3\xC3"sv,      // a start where a continuation is due
             "\xC0\x80"sv,
             "\xC1\xBF"sv,
             "\xE0\x9F\xBF"sv,
             "\xF0\x8F\xBF\xBF"sv, // overlong
             "\xED\xA0\x80"sv,
             "\xED\xBF\xBF"sv, // surrogates
             "\xF4\x90\x80\x80"sv,
             "\xF7\xBF\xBF\xBF"sv, // beyond U+10FFFF
             "\xF8\x88\x80\x80\x80"sv,
             "\xFF"sv,
             "\xE4pfel"sv, // no start; Latin-1
         }) {
        EXPECT_EQ(decode_utf8(text).has_value(), false) << testing::PrintToString(text);
    }
}

TEST(Utf8DeathTest, shouldDemandText) {
    EXPECT_DEATH(static_cast<void>(decode_utf8("")), "empty");
}

TEST(SingleByte, shouldBeTheCodePointInLatin1) {
    for (char32_t code_point = 0; code_point <= 0xFF; ++code_point) {
        const auto byte = static_cast<unsigned char>(code_point);
        EXPECT_EQ(to_single_byte(code_point, Charset::latin1), byte);
        EXPECT_EQ(from_single_byte(byte, Charset::latin1), code_point);
    }
    EXPECT_EQ(to_single_byte(0x100, Charset::latin1), std::nullopt);
    EXPECT_EQ(to_single_byte(U'€', Charset::latin1), std::nullopt);
}

TEST(SingleByte, shouldAgreeWithTheTableOfWindows1252) {
    const std::map<unsigned char, char32_t> special{
        {0x80, U'€'}, {0x82, U'‚'}, {0x83, U'ƒ'}, {0x84, U'„'}, {0x85, U'…'}, {0x86, U'†'}, {0x87, U'‡'},
        {0x88, U'ˆ'}, {0x89, U'‰'}, {0x8A, U'Š'}, {0x8B, U'‹'}, {0x8C, U'Œ'}, {0x8E, U'Ž'}, {0x91, U'‘'},
        {0x92, U'’'}, {0x93, U'“'}, {0x94, U'”'}, {0x95, U'•'}, {0x96, U'–'}, {0x97, U'—'}, {0x98, U'˜'},
        {0x99, U'™'}, {0x9A, U'š'}, {0x9B, U'›'}, {0x9C, U'œ'}, {0x9E, U'ž'}, {0x9F, U'Ÿ'}};
    for (unsigned value = 0; value <= 0xFF; ++value) {
        const auto byte = static_cast<unsigned char>(value);
        if (byte < 0x80 || byte > 0x9F) {
            EXPECT_EQ(to_single_byte(byte, Charset::windows_1252), byte);
            EXPECT_EQ(from_single_byte(byte, Charset::windows_1252), byte);
            continue;
        }
        EXPECT_EQ(to_single_byte(byte, Charset::windows_1252), std::nullopt) << "a control character of Latin-1";
        const auto found = special.find(byte);
        if (found == special.end()) {
            EXPECT_EQ(from_single_byte(byte, Charset::windows_1252), 0xFFFDU) << "undefined";
        } else {
            EXPECT_EQ(to_single_byte(found->second, Charset::windows_1252), byte);
            EXPECT_EQ(from_single_byte(byte, Charset::windows_1252), found->second);
        }
    }
    EXPECT_EQ(to_single_byte(U'Ω', Charset::windows_1252), std::nullopt);
    EXPECT_EQ(to_single_byte(0x1F600, Charset::windows_1252), std::nullopt);
}

TEST(SingleByteDeathTest, shouldNotBeAskedForUnicode) {
    EXPECT_DEATH(static_cast<void>(to_single_byte(U'a', Charset::unicode_hex)), "unicode_hex");
    EXPECT_DEATH(static_cast<void>(from_single_byte('a', Charset::unicode_hex)), "unicode_hex");
}

} // namespace
} // namespace linefeed::protocol
