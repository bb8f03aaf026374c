// The measured rate, the beat of `?SM`, and the size of a block.
#include "feeder/pacing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

namespace linefeed::feeder {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Instant start{seconds{100}};

/// Reports every `interval` for `time`, at `rate` prints per second.
Instant run(Pacing& pacing, double rate, Duration time, Duration interval, Instant from = start, double before = 0) {
    Instant now = from;
    while (now < from + time) {
        now += interval;
        const double printed = before + rate * std::chrono::duration<double>(now - from).count();
        pacing.printed(RecordCount{static_cast<std::uint64_t>(printed)}, now);
    }
    return now;
}

TEST(Pacing, shouldKnowNoRateBeforeItHasMeasured) {
    Pacing pacing{PacingSettings{}};
    EXPECT_EQ(pacing.rate(), 0.0);
    pacing.restart(start);
    EXPECT_EQ(pacing.rate(), 0.0);
    pacing.printed(RecordCount{10}, start);
    EXPECT_EQ(pacing.rate(), 0.0) << "no time has passed";
}

TEST(Pacing, shouldMeasureTheRateAtAnyPollingInterval) {
    for (const double rate : {1.0, 50.0, 500.0, 5000.0}) {
        for (const Duration interval :
             {Duration{milliseconds{1}}, Duration{milliseconds{20}}, Duration{milliseconds{250}}}) {
            Pacing pacing{PacingSettings{}};
            pacing.restart(start);
            run(pacing, rate, seconds{5}, interval);
            EXPECT_NEAR(pacing.rate(), rate, rate * 0.05 + 1.1) << interval.count();
        }
    }
}

TEST(Pacing, shouldFollowAChangeWithinTheWindow) {
    Pacing pacing{PacingSettings{}};
    pacing.restart(start);
    const Instant changed = run(pacing, 1000, seconds{3}, milliseconds{10});
    const Instant later = run(pacing, 100, milliseconds{1300}, milliseconds{10}, changed, 3000);
    EXPECT_NEAR(pacing.rate(), 100.0, 10.0);
    run(pacing, 0, milliseconds{1300}, milliseconds{10}, later, 3130);
    EXPECT_EQ(pacing.rate(), 0.0) << "the line stands";
}

TEST(Pacing, shouldForgetTheRateOnRestart) {
    Pacing pacing{PacingSettings{}};
    pacing.restart(start);
    run(pacing, 1000, seconds{3}, milliseconds{10});
    pacing.restart(start + seconds{10});
    EXPECT_EQ(pacing.rate(), 0.0);
    pacing.printed(RecordCount{5}, start + seconds{11});
    EXPECT_NEAR(pacing.rate(), 5.0, 0.001);
}

TEST(Pacing, shouldPollSeveralTimesInTheTimeToEmpty) {
    const Pacing pacing{PacingSettings{.burst_rate = 1000.0, .polls_per_buffer = 8.0}};
    // 200 records at 1000 a second last 200 ms.
    EXPECT_EQ(pacing.poll_interval(RecordCount{203}), milliseconds{25}) << "the last 3 ms are lost";
    EXPECT_EQ(pacing.poll_interval(RecordCount{19}), milliseconds{2});
}

TEST(Pacing, shouldKeepTheIntervalBetweenItsBounds) {
    const Pacing pacing{PacingSettings{}};
    for (const std::uint64_t level : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{7}, std::uint64_t{256},
                                      std::uint64_t{4000}, std::uint64_t{4294967295}}) {
        EXPECT_GE(pacing.poll_interval(RecordCount{level}), milliseconds{1}) << level;
        EXPECT_LE(pacing.poll_interval(RecordCount{level}), milliseconds{250}) << level;
    }
    EXPECT_EQ(pacing.poll_interval(RecordCount{0}), milliseconds{1});
    EXPECT_EQ(pacing.poll_interval(RecordCount{4294967295}), milliseconds{250});
}

TEST(Pacing, shouldBoundTheIntervalOfALineThatHardlyMoves) {
    const Pacing pacing{PacingSettings{.burst_rate = 1e-12}};
    EXPECT_EQ(pacing.poll_interval(RecordCount{256}), milliseconds{250});
}

/// So many answers in a row, each with as many inquiries under way as may be.
void answer(Pacing& pacing, int answers, Duration round_trip) {
    for (int i = 0; i < answers; ++i) {
        pacing.answered_after(round_trip, pacing.inquiries_at_most());
    }
}

/// A line that has run at `rate` for a while, at a printer whose answers take `round_trip`.
Pacing steady(double rate, Duration round_trip) {
    Pacing pacing{PacingSettings{}};
    answer(pacing, 100, round_trip);
    pacing.restart(start);
    run(pacing, rate, seconds{2}, milliseconds{5});
    return pacing;
}

double interval_ms(const Pacing& pacing, std::uint64_t level) {
    return std::chrono::duration<double, std::milli>(pacing.poll_interval(RecordCount{level})).count();
}

TEST(Pacing, shouldPollASixtyFourthOfTheBufferWhenAnswersAreQuick) {
    EXPECT_NEAR(interval_ms(steady(1000, milliseconds{1}), 256), 4.0, 0.1);
    EXPECT_NEAR(interval_ms(steady(500, milliseconds{5}), 256), 8.0, 0.1);
    EXPECT_NEAR(interval_ms(steady(2000, milliseconds{1}), 256), 2.0, 0.1);
    EXPECT_NEAR(interval_ms(steady(1000, milliseconds{1}), 128), 2.0, 0.1) << "what is left in the buffer counts";
}

TEST(Pacing, shouldPollWhatTheAnswersLeaveOfTheSixteenthThatMayBeMissing) {
    EXPECT_NEAR(interval_ms(steady(1000, milliseconds{13}), 256), 3.0, 0.1);
    EXPECT_NEAR(interval_ms(steady(1000, milliseconds{20}), 256), 1.0, 0.1) << "no more than a 256th";
    EXPECT_NEAR(interval_ms(steady(500, milliseconds{8}), 64), 2.0, 0.1) << "nor more than once a print";
}

TEST(Pacing, shouldNotBurdenThePrinterForALineThatHardlyMoves) {
    EXPECT_NEAR(interval_ms(steady(1, milliseconds{1}), 256), (128.0 - 3 - 1) / 8, 0.1)
        << "it could start again at its burst rate";
}

TEST(Pacing, shouldNoticeAStartAfterAStandstillAtOnce) {
    Pacing pacing = steady(0, milliseconds{1});
    EXPECT_GT(interval_ms(pacing, 256), 15.0);
    const Instant moves = start + seconds{2};
    run(pacing, 2000, milliseconds{16}, milliseconds{8}, moves);
    EXPECT_LT(pacing.rate(), 100.0) << "over the last second";
    EXPECT_LT(interval_ms(pacing, 256), 4.0);
}

TEST(Pacing, shouldPollAFastLineMoreOftenThanItsBurstRate) {
    EXPECT_NEAR(interval_ms(steady(8000, Duration{0}), 256), 1.0, 0.01) << "every 8 prints: a 32nd";
    EXPECT_NEAR(interval_ms(steady(16000, Duration{0}), 256), 0.5, 0.01);
    EXPECT_NEAR(interval_ms(steady(40000, Duration{0}), 256), 0.4, 0.01);
}

TEST(Pacing, shouldPollMoreOftenWhenAnswersAreSlow) {
    Pacing pacing{PacingSettings{.burst_rate = 1000.0}};
    EXPECT_EQ(pacing.poll_interval(RecordCount{103}), microseconds{12500});
    answer(pacing, 1, milliseconds{20});
    EXPECT_EQ(pacing.poll_interval(RecordCount{103}), milliseconds{10});
    answer(pacing, 1, milliseconds{1});
    EXPECT_LT(pacing.poll_interval(RecordCount{103}), microseconds{10200}) << "a slow answer is remembered for a while";
    answer(pacing, 200, milliseconds{1});
    EXPECT_EQ(pacing.poll_interval(RecordCount{104}), microseconds{12500});
}

TEST(Pacing, shouldSpreadTheInquiriesOverTheTimeOfAnAnswer) {
    Pacing pacing{PacingSettings{}};
    answer(pacing, 100, milliseconds{640});
    ASSERT_EQ(pacing.inquiries_at_most(), 32);
    EXPECT_EQ(pacing.poll_interval(RecordCount{103}), milliseconds{20}) << "no time is left";
}

/// An answer that this machine was late for says nothing of the printer: pausing behind it would make it worse.
TEST(Pacing, shouldNotPauseBehindAStall) {
    Pacing pacing = steady(1000, milliseconds{20});
    answer(pacing, 7, milliseconds{300});
    EXPECT_LE(interval_ms(pacing, 256), 1.0);
    answer(pacing, 16, milliseconds{300});
    EXPECT_GT(interval_ms(pacing, 256), 20.0) << "that is no stall any more";
}

TEST(Pacing, shouldHaveManyInquiriesUnderWayWhenItIsTheWayThatTakesTheTime) {
    Pacing pacing{PacingSettings{}};
    EXPECT_EQ(pacing.inquiries_at_most(), 16) << "nothing is known of the printer yet";
    answer(pacing, 100, milliseconds{20});
    EXPECT_EQ(pacing.inquiries_at_most(), max_inquiries);
}

TEST(Pacing, shouldNotAllowMoreInquiriesThanAreOfUse) {
    Pacing pacing{PacingSettings{}};
    for (int answers = 0; answers < 100; ++answers) {
        pacing.answered_after(milliseconds{20}, 3); // it is not known whether the printer would take more
    }
    EXPECT_EQ(pacing.inquiries_at_most(), 16);
}

TEST(Pacing, shouldBeginCarefullyWhenTheSecondOfAPairHadToWait) {
    const auto allowed = [](Duration first, Duration second) {
        Pacing pacing{PacingSettings{}};
        pacing.pair_answered_after(first, second);
        return pacing.inquiries_at_most();
    };
    EXPECT_EQ(allowed(milliseconds{20}, milliseconds{20}), 16);
    EXPECT_EQ(allowed(milliseconds{20}, milliseconds{30}), 16);
    EXPECT_EQ(allowed(milliseconds{20}, milliseconds{40}), 2);
    EXPECT_EQ(allowed(milliseconds{1}, milliseconds{3}), 16) << "too short to tell";
    EXPECT_EQ(allowed(milliseconds{3}, milliseconds{6}), 2);
}

/// Whatever is under way waits until the printer has answered what came before.
TEST(Pacing, shouldNotLetInquiriesQueueInAPrinterThatTakesOneAfterTheOther) {
    Pacing pacing{PacingSettings{}};
    constexpr Duration each = milliseconds{20};
    answer(pacing, 1, each);       // the first is asked alone
    answer(pacing, 23, each * 10); // until it is clear what kind of printer this is
    int most = 0;
    for (int answers = 0; answers < 500; ++answers) {
        most = std::max(most, pacing.inquiries_at_most());
        answer(pacing, 1, each * pacing.inquiries_at_most());
        pacing.restart(start);
        EXPECT_GE(pacing.poll_interval(RecordCount{256}) * 2, each) << "no faster than twice what it answers";
    }
    EXPECT_LE(most, 5);
    EXPECT_LE(pacing.inquiries_at_most(), 3);
}

TEST(Pacing, shouldForgiveAFewLateAnswers) {
    Pacing pacing = steady(1000, milliseconds{5});
    answer(pacing, 7, milliseconds{100}); // this machine stood still
    EXPECT_EQ(pacing.inquiries_at_most(), max_inquiries);
    answer(pacing, 1, milliseconds{5});
    answer(pacing, 16, milliseconds{100});
    EXPECT_LT(pacing.inquiries_at_most(), max_inquiries) << "that is more than chance";
}

TEST(Pacing, shouldPollFastWhileNothingIsKnownOfTheRate) {
    Pacing pacing{PacingSettings{}};
    pacing.restart(start);
    EXPECT_EQ(pacing.poll_interval(RecordCount{256}), microseconds{400});
    pacing.printed(RecordCount{1}, start + milliseconds{249});
    EXPECT_EQ(pacing.poll_interval(RecordCount{256}), microseconds{400});
    pacing.printed(RecordCount{1}, start + milliseconds{250});
    EXPECT_GT(pacing.poll_interval(RecordCount{256}), milliseconds{10});
}

TEST(Pacing, shouldPollBelowItsLeastIntervalOnlyWhenTheRateDemandsIt) {
    Pacing pacing{PacingSettings{}};
    pacing.restart(start);
    run(pacing, 10000, seconds{2}, milliseconds{5});
    EXPECT_EQ(pacing.poll_interval(RecordCount{256}), microseconds{800}) << "every 8 prints";
    EXPECT_EQ(pacing.poll_interval(RecordCount{30}), microseconds{400}) << "every print, but no more often";
    pacing.restart(start + seconds{10});
    pacing.printed(RecordCount{100000}, start + seconds{11});
    EXPECT_EQ(pacing.poll_interval(RecordCount{30}), microseconds{400});
    pacing.restart(start + seconds{20});
    pacing.printed(RecordCount{10}, start + seconds{21});
    EXPECT_EQ(pacing.poll_interval(RecordCount{3}), milliseconds{1}) << "a slow line with a small FIFO";
}

TEST(Pacing, shouldCollectBlocksOnlyWhenTheBufferIsComfortable) {
    const auto worth = [](std::uint64_t credit, std::uint64_t level, std::uint64_t depth) {
        return Pacing::worth_sending(RecordCount{credit}, RecordCount{level}, RecordCount{depth});
    };
    EXPECT_FALSE(worth(0, 0, 256)) << "nothing to send";
    EXPECT_FALSE(worth(1, 255, 256));
    EXPECT_TRUE(worth(2, 254, 256)) << "a 128th of the depth";
    EXPECT_FALSE(worth(7, 1017, 1024));
    EXPECT_TRUE(worth(8, 1016, 1024));
    EXPECT_FALSE(worth(1, 128, 256)) << "half full is comfortable";
    EXPECT_TRUE(worth(1, 127, 256)) << "at once below";
    EXPECT_TRUE(worth(1, 0, 1));
    EXPECT_TRUE(worth(1, 2, 3)) << "a small FIFO has blocks of one";
}

using PacingDeathTest = testing::Test;

TEST(PacingDeathTest, shouldRefuseSettingsWithoutABeat) {
    EXPECT_DEATH(Pacing(PacingSettings{.poll_min = Duration{0}}), "poll_min");
    EXPECT_DEATH(Pacing(PacingSettings{.poll_min = seconds{1}}), "poll_max");
    EXPECT_DEATH(Pacing(PacingSettings{.burst_rate = 0}), "burst_rate");
    EXPECT_DEATH(Pacing(PacingSettings{.polls_per_buffer = 0}), "polls_per_buffer");
}

TEST(Pacing, shouldNoticeALeap) {
    const auto at = [](int ms) { return Instant{std::chrono::milliseconds{ms}}; };
    Pacing pacing{PacingSettings{}};
    pacing.restart(at(0));
    EXPECT_FALSE(pacing.leaps(RecordCount{48}, at(10))) << "a standing line may start at any rate";
    EXPECT_TRUE(pacing.leaps(RecordCount{49}, at(10)));
    pacing.printed(RecordCount{3000}, at(1000));
    EXPECT_FALSE(pacing.leaps(RecordCount{3608}, at(1100))) << "twice as fast for a while";
    EXPECT_TRUE(pacing.leaps(RecordCount{3609}, at(1100)));
}

} // namespace
} // namespace linefeed::feeder
