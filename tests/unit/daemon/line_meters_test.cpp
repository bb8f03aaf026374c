// The figures of a line as the metrics show them.
#include "daemon/line_meters.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <thread>

namespace linefeed::daemon {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

std::uint64_t total(const HistogramView& histogram) {
    return std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::uint64_t{0});
}

std::size_t bound(const HistogramView& histogram, double seconds) {
    const auto found = std::ranges::find_if(histogram.bounds_s, [&](double one) { return one > seconds * 0.999; });
    return static_cast<std::size_t>(found - histogram.bounds_s.begin());
}

TEST(LineMeters, shouldShowFourBoundsOfEachDecade) {
    const HistogramView histogram = view(store::SharedHistogram{});
    EXPECT_EQ(histogram.bounds_s.size(), 33U);
    EXPECT_EQ(histogram.counts.size(), 34U);
    EXPECT_DOUBLE_EQ(histogram.bounds_s.front(), 1e-6);
    EXPECT_DOUBLE_EQ(histogram.bounds_s.back(), 100.0);
    EXPECT_TRUE(std::ranges::is_sorted(histogram.bounds_s));
    EXPECT_DOUBLE_EQ(histogram.bounds_s[bound(histogram, 0.003)], 0.003);
}

TEST(LineMeters, shouldLoseNoneBetweenTheBounds) {
    store::SharedHistogram histogram;
    for (const Duration border : histogram_borders) {
        histogram.record(border);
    }
    histogram.record(milliseconds{4}, 10);
    histogram.record(std::chrono::hours{2});
    const HistogramView shown = view(histogram);
    EXPECT_EQ(total(shown), histogram_borders.size() + 11);
    EXPECT_EQ(shown.counts[bound(shown, 0.005)], 2U + 10U) << "3 and 4 ms, and ten more of 4 ms";
    EXPECT_EQ(shown.counts.back(), 2U) << "100 s and 2 h";
}

TEST(LineMeters, shouldShowTheSum) {
    store::SharedHistogram histogram;
    histogram.record(microseconds{1500}, 2);
    EXPECT_DOUBLE_EQ(view(histogram).sum_s, 0.003);
}

TEST(LineMeters, shouldBeReadWhileTheyAreWritten) {
    LineMeters meters;
    constexpr std::uint64_t records = 100000;
    std::thread feed{[&] {
        for (std::uint64_t i = 0; i < records; ++i) {
            meters.records_sent += 1;
            meters.lead_time.record(microseconds{i % 1000});
        }
    }};
    std::uint64_t before = 0;
    while (before < records) {
        const PrinterMetrics seen = metrics_of("line1", meters);
        EXPECT_GE(seen.records_sent, before);
        before = seen.records_sent;
    }
    feed.join();
    EXPECT_EQ(total(metrics_of("line1", meters).lead_time), records);
}

TEST(LineMeters, shouldGiveEachFigureItsPlace) {
    LineMeters meters;
    meters.records_sent += 1;
    meters.records_printed += 2;
    meters.records_in_doubt += 3;
    meters.records_unused += 4;
    meters.underruns += 5;
    meters.refills += 6;
    meters.links_lost += 7;
    meters.frames_unexpected += 8;
    meters.bytes_damaged += 9;
    meters.refill.record(microseconds{20});
    const PrinterMetrics shown = metrics_of("line1", meters);
    EXPECT_EQ(shown.printer, "line1");
    EXPECT_EQ(shown.records_sent, 1U);
    EXPECT_EQ(shown.records_printed, 2U);
    EXPECT_EQ(shown.records_in_doubt, 3U);
    EXPECT_EQ(shown.records_unused, 4U);
    EXPECT_EQ(shown.underruns, 5U);
    EXPECT_EQ(shown.refills, 6U);
    EXPECT_EQ(shown.links_lost, 7U);
    EXPECT_EQ(shown.frames_unexpected, 8U);
    EXPECT_EQ(shown.bytes_damaged, 9U);
    EXPECT_EQ(total(shown.refill), 1U);
    EXPECT_EQ(total(shown.lead_time), 0U);
}

} // namespace
} // namespace linefeed::daemon
