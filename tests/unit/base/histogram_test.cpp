// Buckets of durations: where the borders lie, and into which bucket they belong.
#include "base/histogram.hpp"

#include <gtest/gtest.h>

namespace linefeed {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Histogram, shouldHaveBordersOfOneSignificantDigit) {
    EXPECT_EQ(histogram_borders[0], Duration::zero());
    EXPECT_EQ(histogram_borders[1], microseconds{1});
    EXPECT_EQ(histogram_borders[9], microseconds{9});
    EXPECT_EQ(histogram_borders[10], microseconds{10});
    EXPECT_EQ(histogram_borders[11], microseconds{20});
    EXPECT_EQ(histogram_borders.back(), seconds{100});
    EXPECT_TRUE(std::is_sorted(histogram_borders.begin(), histogram_borders.end()));
}

TEST(Histogram, shouldPutABorderIntoTheUpperBucket) {
    for (std::size_t bucket = 1; bucket < histogram_borders.size(); ++bucket) {
        EXPECT_EQ(histogram_bucket(histogram_borders[bucket]), bucket);
        EXPECT_EQ(histogram_bucket(histogram_borders[bucket] - Duration{1}), bucket - 1);
    }
}

TEST(Histogram, shouldCountWhatIsBelowTheFirstAndAboveTheLastBorder) {
    Histogram<> histogram;
    histogram.record(Duration::zero());
    histogram.record(std::chrono::hours{1}, 3);
    EXPECT_EQ(histogram.count(0), 1U);
    EXPECT_EQ(histogram.count(histogram_borders.size() - 1), 3U);
    EXPECT_EQ(histogram.sum(), std::chrono::hours{3});
}

TEST(Histogram, shouldCountBetweenBorders) {
    Histogram<> histogram;
    histogram.record(milliseconds{3});
    histogram.record(milliseconds{3} - Duration{1});
    histogram.record(milliseconds{19}, 5);
    histogram.record(milliseconds{20});
    EXPECT_EQ(histogram.count_between(milliseconds{2}, milliseconds{3}), 1U);
    EXPECT_EQ(histogram.count_between(milliseconds{3}, milliseconds{20}), 6U);
    EXPECT_EQ(histogram.count_between(milliseconds{3}, milliseconds{3}), 0U);
    EXPECT_EQ(histogram.count_from(milliseconds{10}), 6U);
    EXPECT_EQ(histogram.count_from(Duration::zero()), 8U);
}

TEST(HistogramDeathTest, shouldRefuseATimeBeforeItsCause) {
    Histogram<> histogram;
    EXPECT_DEATH(histogram.record(Duration{-1}), "duration >= Duration::zero\\(\\)");
}

} // namespace
} // namespace linefeed
