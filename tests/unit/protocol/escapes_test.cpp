// `^` is sent as `\^` and `\` as `\\`, nothing else; read leniently.
#include "protocol/escapes.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

std::string escaped(std::string_view text, EscapeMode mode) {
    std::string out = ">";
    append_escaped(out, text, mode);
    return out;
}

TEST(Escapes, shouldEscapeCaretAndBackslashOnly) {
    EXPECT_EQ(escaped("a^b", EscapeMode::backslash), ">a\\^b");
    EXPECT_EQ(escaped("a\\b", EscapeMode::backslash), ">a\\\\b");
    EXPECT_EQ(escaped("^\\^", EscapeMode::backslash), ">\\^\\\\\\^");
    EXPECT_EQ(escaped("{h}\t~\"'", EscapeMode::backslash), ">{h}\t~\"'");
    EXPECT_EQ(escaped("", EscapeMode::backslash), ">");
}

TEST(Escapes, shouldEscapeNothingInModeNone) {
    EXPECT_EQ(escaped("a\\b", EscapeMode::none), ">a\\b");
}

TEST(Escapes, shouldUndoEscapes) {
    EXPECT_EQ(unescape("a\\^b", EscapeMode::backslash), "a^b");
    EXPECT_EQ(unescape("a\\\\b", EscapeMode::backslash), "a\\b");
    EXPECT_EQ(unescape("\\\\\\^", EscapeMode::backslash), "\\^");
    EXPECT_EQ(unescape("plain", EscapeMode::backslash), "plain");
    EXPECT_EQ(unescape("", EscapeMode::backslash), "");
}

TEST(Escapes, shouldLeaveABackslashBeforeAnythingElse) {
    EXPECT_EQ(unescape("\\FFSDISK\\JOBS\\Testprint.job", EscapeMode::backslash), "\\FFSDISK\\JOBS\\Testprint.job");
    EXPECT_EQ(unescape("JOBS\\", EscapeMode::backslash), "JOBS\\");
}

TEST(Escapes, shouldUndoNothingInModeNone) {
    EXPECT_EQ(unescape("a\\\\b\\^", EscapeMode::none), "a\\\\b\\^");
}

} // namespace
} // namespace linefeed::protocol
