// Print parameters, extern texts, WYSIWYG lines, scripts, transmission.
#include "parsing.hpp"

#include <string>

namespace linefeed::protocol {
namespace {

TEST(PrintParameter, shouldKeepTheHeightInItsRange) {
    EXPECT_EQ(parsed_as<PrintParameter>("^0=PR4\t30\r").value, 30U);
    EXPECT_EQ(reason("^0=PR4\t29\r"), "=PR: parameter 2 is not a value in its range: \"29\"");
    EXPECT_EQ(reason("^0=PR4\t101\r"), "=PR: parameter 2 is not a value in its range: \"101\"");
    EXPECT_EQ(parsed_as<PrintParameter>("^0=PR3\t4294967295\r").value, UINT32_MAX);
    EXPECT_EQ(reason("^0=PR6\t1\r"), "=PR: parameter 1 is not a print parameter: \"6\"");
    EXPECT_EQ(reason("^0=PR0\t1\r"), "=PR: parameter 1 is not a print parameter: \"0\"");
    EXPECT_EQ(reason("^0=PR1\r"), "=PR: parameter 2 is missing: a value in its range");
}

TEST(PrintParameter, shouldHaveWords) {
    EXPECT_EQ(to_string(PrintParameterType::print_go_delay), "PrintGo delay in µm");
    EXPECT_EQ(to_string(PrintParameterType::print_go_distance), "PrintGo distance in µm");
    EXPECT_EQ(to_string(PrintParameterType::stroke_distance), "stroke distance in µm");
    EXPECT_EQ(to_string(PrintParameterType::printing_height), "printing height");
    EXPECT_EQ(to_string(PrintParameterType::encoder_speed), "speed of the internal encoder");
    EXPECT_EQ(to_string(PrintParameterType{6}), "unknown");
}

TEST(ExternText, shouldKeepTabsAndShowNulAsABlank) {
    EXPECT_EQ(parsed_as<ExternText>(std::string_view{"^0=ETa\tb\0c\r", 11}).text, "a\tb c");
    EXPECT_EQ(parsed_as<ExternText>("^0=ET\r").text, "");
    EXPECT_EQ(parsed_as<ExternText>("^0=ET" + std::string(3000, 'x') + "\r").text.size(), max_extern_text);
    EXPECT_EQ(encoded(ExternText{"a\\^"}, EscapeMode::none), "^0=ETa\\^\r");
}

TEST(WysiwygLine, shouldHaveUpTo60Nibbles) {
    EXPECT_EQ(parsed_as<WysiwygLine>("^0=GWAPPA  \r").bytes, "\x0F\xF0");
    EXPECT_EQ(parsed_as<WysiwygLine>("^0=GW\r").bytes, "");
    EXPECT_EQ(parsed_as<WysiwygLine>("^0=GW" + std::string(60, 'P') + "\r").bytes.size(), max_wysiwyg_line);
    EXPECT_EQ(reason("^0=GW" + std::string(62, 'P') + "\r").substr(0, 41), "=GW: parameter 1 is not up to 60 nibbles:");
    EXPECT_EQ(reason("^0=GWAQ\r"), "=GW: parameter 1 is not up to 60 nibbles: \"AQ\"");
}

TEST(ScriptLine, shouldKnowItsEndsWithParametersBehindThem) {
    EXPECT_TRUE(ScriptLine{"BEGINLJSCRIPT [()]"}.is_begin());
    EXPECT_TRUE(ScriptLine{"BEGINLJSCRIPT[()]"}.is_begin());
    EXPECT_FALSE(ScriptLine{"BEGINLJSCRIPTS"}.is_begin());
    EXPECT_FALSE(ScriptLine{"BEGINJOB"}.is_begin());
    EXPECT_TRUE(ScriptLine{"ENDLJSCRIPT []"}.is_end());
    EXPECT_FALSE(ScriptLine{" ENDLJSCRIPT"}.is_end());
    EXPECT_EQ(parsed_as<ScriptLine>("^0*a\\^b\tc\r").text, "a^b\tc");
    EXPECT_EQ(parsed_as<ScriptLine>("^0*\r").text, "");
}

TEST(Transmission, shouldKeepTheBlockLengthInItsRange) {
    EXPECT_EQ(parsed_as<BlockLength>("^0=FL1\r").bytes, 1U);
    EXPECT_EQ(reason("^0=FL0\r"), "=FL: parameter 1 is not a block length: \"0\"");
    EXPECT_EQ(reason("^0=FL2049\r"), "=FL: parameter 1 is not a block length: \"2049\"");
    EXPECT_EQ(reason("^0=NR-1\r"), "=NR: parameter 1 is not a CRC: \"-1\"");
}

TEST(Inquiry, shouldCarryItsArgument) {
    EXPECT_EQ(encoded(InquiryMessage{Parameter::PR, "3"}), "^0?PR3\r");
    EXPECT_EQ(encoded(InquiryMessage{Parameter::JB, ""}), "^0?JB\r");
    EXPECT_EQ(encoded(ActionMessage{Action::display_off}), "^0!W0\r");
}

TEST(MessageEncoderDeathTest, shouldAbortOnTextThatWouldEndTheFrame) {
    EXPECT_DEATH(encoded(ExternText{"a\rb"}), "find");
    EXPECT_DEATH(encoded(ScriptLine{"a\rb"}), "find");
    EXPECT_DEATH(encoded(InquiryMessage{Parameter::PR, "\r"}), "find");
    EXPECT_DEATH(encoded(MailRecord{RecordNumber{1}, {"a\tb"}, {}}), "find_first_of");
    EXPECT_DEATH(encoded(DirectoryBlock{true, {{"a\tb", false}}}), "find_first_of");
    EXPECT_DEATH(encoded(DirectoryBlock{true, std::vector<DirectoryEntry>(33)}), "max_entries");
    EXPECT_DEATH(encoded(WysiwygLine{std::string(31, 'x')}), "max_wysiwyg_line");
    EXPECT_DEATH(encoded(FileBlock{1, 0, std::string(2049, 'x')}), "max_bytes");
}

} // namespace
} // namespace linefeed::protocol
