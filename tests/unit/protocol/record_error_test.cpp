// The reasons why a record cannot be sent, in words.
#include "protocol/mail_record.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

std::string reason(RecordErrc code, std::uint32_t character = 0, char32_t code_point = 0, std::uint64_t length = 0) {
    return describe({code, RecordNumber{22118}, 2, character, code_point, length});
}

TEST(RecordError, shouldNameTheInvalidByte) {
    EXPECT_EQ(reason(RecordErrc::invalid_utf8, 3, 0xE4), "character 3 is not valid UTF-8: byte 0xE4");
}

TEST(RecordError, shouldNameControlCharacters) {
    const auto named = [](char32_t code_point) { return reason(RecordErrc::control_character, 3, code_point); };
    EXPECT_EQ(named(0x00), "character 3 is U+0000 (NUL), a control character");
    EXPECT_EQ(named(0x09), "character 3 is U+0009 (TAB), a control character");
    EXPECT_EQ(named(0x0A), "character 3 is U+000A (LF), a control character");
    EXPECT_EQ(named(0x0D), "character 3 is U+000D (CR), a control character");
    EXPECT_EQ(named(0x1A), "character 3 is U+001A (SUB), a control character");
    EXPECT_EQ(named(0x1B), "character 3 is U+001B (ESC), a control character");
    EXPECT_EQ(named(0x7F), "character 3 is U+007F (DEL), a control character");
    EXPECT_EQ(named(0x9F), "character 3 is U+009F, a control character");
}

TEST(RecordError, shouldShowTheCharacterThatTheCharsetDoesNotHave) {
    const auto named = [](char32_t code_point) {
        const std::string text = reason(RecordErrc::not_in_charset, 1, code_point);
        return text.substr(0, text.find(", which"));
    };
    EXPECT_EQ(reason(RecordErrc::not_in_charset, 3, U'€'),
              "character 3 is U+20AC (€), which the charset of the field does not have: replace it or choose another "
              "charset");
    EXPECT_EQ(named(U'Ω'), "character 1 is U+03A9 (Ω)");
    EXPECT_EQ(named(U'漢'), "character 1 is U+6F22 (漢)");
    EXPECT_EQ(named(U'😀'), "character 1 is U+1F600 (😀)");
}

TEST(RecordError, shouldNotShowCharactersThatCannotBeSeenOrTurnTheText) {
    for (const char32_t code_point :
         {0x2000U, 0x200FU, 0x2028U, 0x202EU, 0x205FU, 0x2066U, 0xE000U, 0xFEFFU, 0x10FFFFU}) {
        EXPECT_EQ(reason(RecordErrc::not_in_charset, 1, code_point).find('('), std::string::npos)
            << static_cast<unsigned>(code_point);
    }
    EXPECT_TRUE(reason(RecordErrc::not_in_charset, 1, 0x10FFFF).starts_with("character 1 is U+10FFFF, which"));
    EXPECT_NE(reason(RecordErrc::not_in_charset, 1, U'‐').find('('), std::string::npos);
    EXPECT_NE(reason(RecordErrc::not_in_charset, 1, U'‰').find('('), std::string::npos);
    EXPECT_NE(reason(RecordErrc::not_in_charset, 1, 0x2070).find('('), std::string::npos);
}

TEST(RecordError, shouldSayWhatThePrinterTakes) {
    EXPECT_EQ(reason(RecordErrc::outside_bmp, 2, U'😀'),
              "character 2 is U+1F600 (😀): the printer takes characters up to U+FFFF only");
    EXPECT_EQ(reason(RecordErrc::too_many_fields, 0, 0, 256), "256 fields, the printer takes 255");
    EXPECT_EQ(reason(RecordErrc::too_long, 0, 0, 3000), "the record takes 3000 bytes, the printer takes 2048");
    EXPECT_EQ(reason(RecordErrc::no_fields), "the record has no field");
}

TEST(RecordError, shouldSayWhatToDoWhereTheFirmwareKnowsNoEscapes) {
    EXPECT_EQ(reason(RecordErrc::not_escapable, 1, U'^'),
              "character 1 is ^, which cannot be sent to firmware without escapes (profile jet3): remove it or choose "
              "another --profile");
    EXPECT_TRUE(reason(RecordErrc::not_escapable, 4, U'\\').starts_with("character 4 is \\, which"));
}

TEST(RecordError, shouldExplainPropertyBlocksAndRepetitions) {
    EXPECT_EQ(reason(RecordErrc::looks_like_properties),
              "the last field reads as a property block {…}: the printer would obey it instead of printing it");
    EXPECT_EQ(reason(RecordErrc::repetitions_numbered), "repetitions (rN) are only allowed for records with number 0");
}

TEST(RecordErrorDeathTest, shouldAbortOnACodeThatDoesNotExist) {
    EXPECT_DEATH(reason(static_cast<RecordErrc>(99)), "RecordErrc");
}

} // namespace
} // namespace linefeed::protocol
