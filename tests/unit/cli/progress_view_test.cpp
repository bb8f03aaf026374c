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
