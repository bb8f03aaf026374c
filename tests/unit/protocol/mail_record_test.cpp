// Mail records as bytes, and every reason to refuse one.
#include "protocol/mail_record.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace linefeed::protocol {
namespace {

using namespace std::string_view_literals;
using Fields = std::vector<std::string_view>;

struct EncoderSetup {
    Charset charset = Charset::latin1;
    EscapeMode escapes = EscapeMode::backslash;
    RecordProperties properties{};
};

/// The frame without what was in the output before it, or the reason why there is none.
std::string encoded(std::uint32_t number, const Fields& fields, const EncoderSetup& setup = {}) {
    const MailRecordEncoder encoder{{setup.charset}, setup.escapes, setup.properties};
    std::string out = "before";
    const auto result = encoder.append(out, RecordNumber{number}, fields);
    if (result.has_error()) {
        EXPECT_EQ(out, "before") << "an error leaves the output alone";
        return describe(result.error());
    }
    EXPECT_TRUE(out.starts_with("before"));
    return out.substr(6);
}

RecordError refused(std::uint32_t number, const Fields& fields, const EncoderSetup& setup = {}) {
    const MailRecordEncoder encoder{{setup.charset}, setup.escapes, setup.properties};
    std::string out = "before";
    const auto result = encoder.append(out, RecordNumber{number}, fields);
    EXPECT_EQ(out, "before");
    EXPECT_TRUE(result.has_error());
    return result.has_error() ? result.error() : RecordError{};
}

RecordError error(RecordErrc code, std::uint32_t number, std::uint32_t field = 0, std::uint32_t character = 0,
                  char32_t code_point = 0, std::uint64_t length = 0) {
    return {code, RecordNumber{number}, field, character, code_point, length};
}

TEST(MailRecordEncoder, shouldWriteTheExamplesOfTheManual) {
    EXPECT_EQ(encoded(17, {"Miss", "Jane", "Miller"},
                      {.properties = {.mirrored = true, .orientation = Orientation::degrees_180}}),
              "^0=MR17\tMiss\tJane\tMiller\t{ho2}\r");
    EXPECT_EQ(encoded(0, {"111", "(8 3 FF81FF)"}), "^0=MR0\t111\t(8 3 FF81FF)\r");
    EXPECT_EQ(encoded(0, {"text1"}, {.properties = {true, Orientation::degrees_180, 3}}), "^0=MR0\ttext1\t{ho2r3}\r");
    EXPECT_EQ(encoded(0, {"text2", "text3"}, {.properties = {.repetitions = 21}}), "^0=MR0\ttext2\ttext3\t{r21}\r");
    EXPECT_EQ(encoded(22119, {"Mailänder"}), "^0=MR22119\tMail\xE4nder\r");
    EXPECT_EQ(encoded(22118, {"Hello World"}, {.charset = Charset::unicode_hex}),
              "^0=MR22118\t00480065006C006C006F00200057006F0072006C0064\r");
}

TEST(MailRecordEncoder, shouldWriteNumbersWithoutLeadingZeros) {
    EXPECT_EQ(encoded(0, {"a"}), "^0=MR0\ta\r");
    EXPECT_EQ(encoded(4294967295U, {"a"}), "^0=MR4294967295\ta\r");
}

TEST(MailRecordEncoder, shouldKeepEmptyFieldsAndBlanksAndZeros) {
    EXPECT_EQ(encoded(1, {""}), "^0=MR1\t\r");
    EXPECT_EQ(encoded(1, {"", " 007 ", ""}), "^0=MR1\t\t 007 \t\r");
}

TEST(MailRecordEncoder, shouldAppendRecordAfterRecord) {
    const MailRecordEncoder encoder{{Charset::latin1}, EscapeMode::backslash};
    std::string out;
    for (std::uint32_t number = 1; number <= 3; ++number) {
        const Fields fields{"x"};
        ASSERT_TRUE(encoder.append(out, RecordNumber{number}, fields).has_value());
    }
    EXPECT_EQ(out, "^0=MR1\tx\r^0=MR2\tx\r^0=MR3\tx\r");
}

TEST(MailRecordEncoder, shouldEncodeEachFieldInItsCharset) {
    const MailRecordEncoder encoder{{Charset::latin1, Charset::windows_1252, Charset::unicode_hex},
                                    EscapeMode::backslash};
    std::string out;
    const Fields fields{"ß", "€", "€"};
    ASSERT_TRUE(encoder.append(out, RecordNumber{1}, fields).has_value());
    EXPECT_EQ(out, "^0=MR1\t\xDF\t\x80\t20AC\r");
}

TEST(MailRecordEncoder, shouldEscapeForFirmwareThatKnowsEscapes) {
    EXPECT_EQ(encoded(1, {"a^b\\c"}), "^0=MR1\ta\\^b\\\\c\r");
}

TEST(MailRecordEncoder, shouldRefuseCaretAndBackslashForFirmwareWithoutEscapes) {
    const EncoderSetup jet3{.escapes = EscapeMode::none};
    EXPECT_EQ(refused(7, {"ok", "ä^"}, jet3), error(RecordErrc::not_escapable, 7, 2, 2, U'^'));
    EXPECT_EQ(refused(7, {"\\"}, jet3), error(RecordErrc::not_escapable, 7, 1, 1, U'\\'));
}

TEST(MailRecordEncoder, shouldSendCaretAndBackslashAsHexToAnyFirmware) {
    EXPECT_EQ(encoded(1, {"^\\"}, {.charset = Charset::unicode_hex, .escapes = EscapeMode::none}),
              "^0=MR1\t005E005C\r");
}

TEST(MailRecordEncoder, shouldWriteUpperCaseHexOfTheWholeBasicPlane) {
    const EncoderSetup unicode{.charset = Charset::unicode_hex};
    EXPECT_EQ(encoded(1, {"aä€漢"}, unicode), "^0=MR1\t006100E420AC6F22\r");
    EXPECT_EQ(encoded(1, {"\xEF\xBF\xBE\xEF\xBF\xBF"}, unicode), "^0=MR1\tFFFEFFFF\r");
}

TEST(MailRecordEncoder, shouldRefuseCharactersOutsideTheBasicPlane) {
    EXPECT_EQ(refused(9, {"a😀"}, {.charset = Charset::unicode_hex}), error(RecordErrc::outside_bmp, 9, 1, 2, 0x1F600));
}

TEST(MailRecordEncoder, shouldRefuseCharactersThatTheCharsetDoesNotHave) {
    EXPECT_EQ(refused(9, {"5 €"}), error(RecordErrc::not_in_charset, 9, 1, 3, U'€'));
    EXPECT_EQ(refused(9, {"Ω"}, {.charset = Charset::windows_1252}), error(RecordErrc::not_in_charset, 9, 1, 1, U'Ω'));
    EXPECT_EQ(refused(9, {"😀"}), error(RecordErrc::not_in_charset, 9, 1, 1, 0x1F600));
}

TEST(MailRecordEncoder, shouldRefuseEveryControlCharacterInEveryCharset) {
    for (const Charset charset : {Charset::latin1, Charset::windows_1252, Charset::unicode_hex}) {
        for (char32_t code_point = 0; code_point <= 0xA0; ++code_point) {
            std::string text = "ab";
            if (code_point >= 0x80) {
                text.push_back('\xC2');
            }
            text.push_back(static_cast<char>(static_cast<unsigned char>(code_point)));
            const MailRecordEncoder encoder{{charset}, EscapeMode::backslash};
            std::string out;
            const Fields fields{text};
            const auto result = encoder.append(out, RecordNumber{3}, fields);
            const bool control = code_point < 0x20 || (code_point >= 0x7F && code_point < 0xA0);
            ASSERT_EQ(result.has_error(), control) << static_cast<unsigned>(code_point);
            if (control) {
                EXPECT_EQ(result.error(), error(RecordErrc::control_character, 3, 1, 3, code_point));
            }
        }
    }
}

TEST(MailRecordEncoder, shouldRefuseInvalidUtf8WithItsByteAndPlace) {
    EXPECT_EQ(refused(5, {"ok", "\xC3\xA4\xE4pfel"}), error(RecordErrc::invalid_utf8, 5, 2, 2, 0xE4));
    EXPECT_EQ(refused(5, {"abc\xC3"}, {.charset = Charset::unicode_hex}),
              error(RecordErrc::invalid_utf8, 5, 1, 4, 0xC3));
}

TEST(MailRecordEncoder, shouldRefuseALastFieldThatThePrinterWouldObey) {
    EXPECT_EQ(refused(4, {"x", "{h}"}), error(RecordErrc::looks_like_properties, 4, 2));
    EXPECT_EQ(refused(4, {"{}"}), error(RecordErrc::looks_like_properties, 4, 1));
    EXPECT_EQ(refused(4, {"{r2o1}"}, {.charset = Charset::windows_1252, .escapes = EscapeMode::none}),
              error(RecordErrc::looks_like_properties, 4, 1));
}

TEST(MailRecordEncoder, shouldSendTextThatOnlyResemblesAPropertyBlock) {
    EXPECT_EQ(encoded(4, {"{h}", "x"}), "^0=MR4\t{h}\tx\r");
    EXPECT_EQ(encoded(4, {"{hello}"}), "^0=MR4\t{hello}\r");
    EXPECT_EQ(encoded(4, {"{o4}"}), "^0=MR4\t{o4}\r");
    EXPECT_EQ(encoded(4, {"{h}"}, {.properties = {.mirrored = true}}), "^0=MR4\t{h}\t{h}\r");
    EXPECT_EQ(encoded(4, {"{h}"}, {.charset = Charset::unicode_hex}), "^0=MR4\t007B0068007D\r");
}

TEST(MailRecordEncoder, shouldTakeFrom1To255Fields) {
    EXPECT_EQ(refused(1, {}), error(RecordErrc::no_fields, 1));
    const Fields most(255, "x");
    EXPECT_EQ(encoded(1, most).size(), "^0=MR1\r"sv.size() + 2 * 255);
    EXPECT_EQ(refused(1, Fields(256, "x")), error(RecordErrc::too_many_fields, 1, 0, 0, 0, 256));
}

TEST(MailRecordEncoder, shouldTakeExactly2048Bytes) {
    const std::string fits(2048 - 2, 'x'); // beside the number and a TAB
    EXPECT_EQ(encoded(1, {fits}), "^0=MR1\t" + fits + "\r");
    EXPECT_EQ(refused(1, {fits + "x"}), error(RecordErrc::too_long, 1, 0, 0, 0, 2049));
    EXPECT_EQ(refused(10, {fits}), error(RecordErrc::too_long, 10, 0, 0, 0, 2049)) << "the number counts";
    EXPECT_EQ(refused(1, {fits.substr(1) + "^"}), error(RecordErrc::too_long, 1, 0, 0, 0, 2049)) << "escapes count";
    EXPECT_EQ(refused(1, {fits}, {.properties = {.mirrored = true}}), error(RecordErrc::too_long, 1, 0, 0, 0, 2052))
        << "the property block counts";
    EXPECT_EQ(refused(1, {std::string(512, 'x')}, {.charset = Charset::unicode_hex}),
              error(RecordErrc::too_long, 1, 0, 0, 0, 2050))
        << "hex counts fourfold";
    EXPECT_EQ(encoded(1, {std::string(1023, 'x') + "äääääääääääää"}).size(), "^0=MR1\t\r"sv.size() + 1036)
        << "bytes as sent, not as read";
}

TEST(MailRecordEncoder, shouldAllowRepetitionsWithNumber0Only) {
    const EncoderSetup repeated{.properties = {.repetitions = 2}};
    EXPECT_EQ(encoded(0, {"x"}, repeated), "^0=MR0\tx\t{r2}\r");
    EXPECT_EQ(refused(1, {"x"}, repeated), error(RecordErrc::repetitions_numbered, 1));
}

TEST(MailRecordEncoder, shouldThrowTheReasonWhereAValueIsDemanded) {
    const MailRecordEncoder encoder{{Charset::latin1}, EscapeMode::backslash};
    std::string out;
    const Fields fields{"a\tb"};
    try {
        encoder.append(out, RecordNumber{1}, fields).value();
        FAIL() << "no exception";
    } catch (const std::runtime_error& reason) {
        EXPECT_STREQ(reason.what(), "character 2 is U+0009 (TAB), a control character");
    }
}

TEST(MailRecordEncoderDeathTest, shouldDemandACharsetForEachField) {
    EXPECT_DEATH(MailRecordEncoder({}, EscapeMode::none), "charsets_.empty");
    const MailRecordEncoder encoder{{Charset::latin1, Charset::latin1}, EscapeMode::none};
    std::string out;
    const Fields three{"a", "b", "c"};
    EXPECT_DEATH(static_cast<void>(encoder.append(out, RecordNumber{1}, three)), "charsets_.size");
}

} // namespace
} // namespace linefeed::protocol
