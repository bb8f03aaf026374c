// Text that is shown: what is left alone and what is disarmed.
#include "protocol/printable.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

TEST(Printable, shouldLeaveTextAlone) {
    EXPECT_EQ(printable(""), "");
    EXPECT_EQ(printable("Müller & Söhne, 5 €"), "Müller & Söhne, 5 €");
}

TEST(Printable, shouldDisarmControlCharacters) {
    EXPECT_EQ(printable("a\tb\r\nc"), "a\\x09b\\x0D\\x0Ac");
    EXPECT_EQ(printable("\x1b[2Jgone"), "\\x1B[2Jgone");
    EXPECT_EQ(printable(std::string{"\0\x7f", 2}), "\\x00\\x7F");
}

TEST(Printable, shouldDisarmWhatIsNotText) {
    EXPECT_EQ(printable("a\xFF\xC3"), "a\\xFF\\xC3");
    EXPECT_EQ(printable("\u009B2J"), "\\xC2\\x9B2J") << "a control sequence in one character";
    EXPECT_EQ(printable("vsc.\u202Efdp"), "vsc.\\xE2\\x80\\xAEfdp") << "written from right to left";
}

} // namespace
} // namespace linefeed::protocol
