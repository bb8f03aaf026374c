// What a serial line carries, and that a printer is asked and fed no faster.
#include "session/line_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace linefeed::session {
namespace {

constexpr double at_9600 = 960;
constexpr double at_115200 = 11520;

TEST(LineFit, shouldTellWhatALineCarries) {
    EXPECT_TRUE(std::isinf(records_per_second({}, 40)));
    EXPECT_NEAR(records_per_second({.bytes_per_second = at_9600}, 40), 24, 0.01);
    EXPECT_NEAR(records_per_second({.bytes_per_second = at_115200}, 40), 288, 0.1);
    const double secured = records_per_second({.bytes_per_second = at_115200, .crc = true}, 40);
    EXPECT_GT(secured, 100);
    EXPECT_LT(secured, 288.0 * 40 / 63) << "announcement and answer take their part";
}

TEST(LineFit, shouldLeaveANetworkAlone) {
    SessionSettings settings;
    fit_to_line(settings, 40);
    EXPECT_EQ(settings.feeder.pacing.poll_min, feeder::PacingSettings{}.poll_min);
    EXPECT_EQ(settings.feeder.verify_timeout, feeder::FeederSettings{}.verify_timeout);
    EXPECT_EQ(settings.feeder.fill_at_most, feeder::FeederSettings{}.fill_at_most);
}

TEST(LineFit, shouldWaitForRepeatsOfASecuredLineOfAnySpeed) {
    SessionSettings settings;
    settings.line.crc = true;
    fit_to_line(settings, 40);
    EXPECT_GT(settings.feeder.flush_timeout,
              feeder::FeederSettings{}.flush_timeout + protocol::SecuredLine::repeats_take());
    EXPECT_EQ(settings.feeder.pacing.most_inquiries, 1);
}

TEST(LineFit, shouldSendNoMoreAtOnceThanASlowLineCarries) {
    SessionSettings settings;
    settings.line = {.bytes_per_second = at_9600};
    fit_to_line(settings, 40);
    EXPECT_EQ(settings.feeder.fill_at_most, RecordCount{48}) << "two seconds";
    EXPECT_EQ(settings.feeder.refill_at_most, RecordCount{6}) << "a quarter of a second";
    settings.line.crc = true;
    fit_to_line(settings, 2048);
    EXPECT_EQ(settings.feeder.refill_at_most, RecordCount{2}) << "one alone may be taken out ahead";
}

TEST(LineFit, shouldAskNoFasterThanTheAnswersCome) {
    for (const double speed : {at_9600, at_115200}) {
        for (const bool crc : {false, true}) {
            SessionSettings settings;
            settings.line = {.bytes_per_second = speed, .crc = crc};
            fit_to_line(settings, 40);
            const feeder::PacingSettings& pacing = settings.feeder.pacing;
            const Duration answer = settings.line.time_of(6 + 36 + (crc ? 40 : 0));
            EXPECT_GE(pacing.poll_min, 4 * answer);
            EXPECT_LE(pacing.poll_least, pacing.poll_min);
            EXPECT_LE(pacing.poll_min, pacing.poll_max);
            EXPECT_EQ(pacing.most_inquiries, 1);
            EXPECT_GT(settings.feeder.flush_timeout, feeder::FeederSettings{}.flush_timeout + 4 * answer);
        }
    }
}

} // namespace
} // namespace linefeed::session
