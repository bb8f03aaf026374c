#include "cli/progress_view.hpp"

#include <gtest/gtest.h>

namespace linefeed::cli {
namespace {

TEST(FormatDuration, shouldUseTheUnitsThatFit) {
    EXPECT_EQ(format_duration(0), "0 s");
    EXPECT_EQ(format_duration(7), "7 s");
    EXPECT_EQ(format_duration(59), "59 s");
    EXPECT_EQ(format_duration(60), "1:00");
    EXPECT_EQ(format_duration(123), "2:03");
    EXPECT_EQ(format_duration(3599), "59:59");
    EXPECT_EQ(format_duration(3600), "1:00:00");
    EXPECT_EQ(format_duration(3723), "1:02:03");
    EXPECT_EQ(format_duration(360000), "100:00:00");
}

TEST(FormatDuration, shouldRoundUpAndNeverBeNegative) {
    EXPECT_EQ(format_duration(0.1), "1 s");
    EXPECT_EQ(format_duration(59.5), "1:00");
    EXPECT_EQ(format_duration(-3), "0 s");
}

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

TEST(ProgressView, shouldSayMessagesOnLinesOfTheirOwn) {
    ProgressView view{false};
    testing::internal::CaptureStderr();
    view.message("printing");
    view.finish();
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "linefeed: printing\n");
}

TEST(ProgressView, shouldStaySilentForShortWorkOffATerminal) {
    ProgressView view{false};
    testing::internal::CaptureStderr();
    view.update({"printing", 0.5, "record 50 of 100", 10, 5.0});
    view.update({"printing", 0.6, "record 60 of 100", 10, 4.0});
    view.finish();
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

} // namespace
} // namespace linefeed::cli
