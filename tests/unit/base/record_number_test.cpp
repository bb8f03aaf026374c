// Numbers, counts and ranges of records: the arithmetic on which "no record twice, none left out" rests.
#include "base/record_number.hpp"

#include <gtest/gtest.h>

#include <concepts>
#include <sstream>

namespace linefeed {
namespace {

constexpr std::uint32_t largest = 4'294'967'295U;

RecordRange range(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

template <typename T>
std::string printed(const T& value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

template <typename A, typename B>
concept addable = requires(A a, B b) {
    a + b;
};

TEST(RecordNumber, shouldNotMixWithCounts) {
    static_assert(!std::convertible_to<RecordNumber, RecordCount>);
    static_assert(!std::convertible_to<RecordCount, RecordNumber>);
    static_assert(!addable<RecordNumber, RecordNumber>);
    static_assert(addable<RecordNumber, RecordCount>);
    SUCCEED() << "checked by the compiler";
}

TEST(RecordNumber, shouldCountUpAndDownByOne) {
    EXPECT_EQ(RecordNumber{22118}.next(), RecordNumber{22119});
    EXPECT_EQ(RecordNumber{22118}.previous(), RecordNumber{22117});
    EXPECT_EQ(RecordNumber{largest - 1}.next(), RecordNumber::max());
    EXPECT_EQ(RecordNumber{1}.previous(), RecordNumber{});
}

TEST(RecordNumber, shouldAddACountAndGiveTheDistanceBack) {
    const RecordNumber first{22118};
    const RecordNumber last = first + RecordCount{255};
    EXPECT_EQ(last, RecordNumber{22373});
    EXPECT_EQ(last - first, RecordCount{255});
    EXPECT_EQ(RecordNumber{0} + RecordCount{largest}, RecordNumber::max());
}

TEST(RecordNumber, shouldBeOrdered) {
    EXPECT_LT(RecordNumber{1}, RecordNumber{2});
    EXPECT_GE(RecordNumber::max(), RecordNumber{largest});
}

TEST(RecordNumber, shouldPrintAsDigits) {
    EXPECT_EQ(printed(RecordNumber::max()), "4294967295");
    EXPECT_EQ(printed(RecordCount{18'446'744'073'709'551'615U}), "18446744073709551615");
}

TEST(RecordNumberDeathTest, shouldAbortInsteadOfWrappingAround) {
    EXPECT_DEATH(static_cast<void>(RecordNumber::max().next()), "max");
    EXPECT_DEATH(static_cast<void>(RecordNumber{0}.previous()), "value_ > 0");
    EXPECT_DEATH(static_cast<void>(RecordNumber{1} + RecordCount{largest}), "count.value");
    EXPECT_DEATH(static_cast<void>(RecordNumber{1} - RecordNumber{2}), "a >= b");
}

TEST(RecordCount, shouldAddAndSubtract) {
    RecordCount count{250};
    count += RecordCount{6};
    EXPECT_EQ(count, RecordCount{256});
    EXPECT_EQ(count - RecordCount{256}, RecordCount{});
    EXPECT_EQ((RecordCount{1} + RecordCount{2}).value(), 3U);
}

TEST(RecordCountDeathTest, shouldAbortBelowZero) {
    EXPECT_DEATH(static_cast<void>(RecordCount{1} - RecordCount{2}), "a.value_ >= b.value_");
}

TEST(RecordRange, shouldIncludeBothEnds) {
    const RecordRange job = range(22118, 100000);
    EXPECT_EQ(job.count(), RecordCount{77883});
    EXPECT_EQ(job.first(), RecordNumber{22118});
    EXPECT_EQ(job.last(), RecordNumber{100000});
    EXPECT_TRUE(job.contains(RecordNumber{22118}));
    EXPECT_TRUE(job.contains(RecordNumber{100000}));
    EXPECT_FALSE(job.contains(RecordNumber{22117}));
    EXPECT_FALSE(job.contains(RecordNumber{100001}));
}

TEST(RecordRange, shouldBeEmptyWhenTheLastLiesBeforeTheFirst) {
    EXPECT_TRUE(range(5, 4).empty());
    EXPECT_EQ(range(5, 4).first(), RecordNumber{5});
    EXPECT_FALSE(range(5, 5).empty());
    EXPECT_EQ(range(5, 5).count(), RecordCount{1});
    EXPECT_TRUE(RecordRange{}.empty());
}

TEST(RecordRange, shouldContainNothingWhenEmpty) {
    EXPECT_FALSE(range(5, 4).contains(RecordNumber{5}));
}

TEST(RecordRange, shouldReachFromTheFirstNumberToTheLargest) {
    const RecordRange all = range(0, largest);
    EXPECT_EQ(all.count(), RecordCount{4'294'967'296U});
    EXPECT_EQ(all.last(), RecordNumber::max());
}

TEST(RecordRange, shouldTakeAllEmptyRangesForEqual) {
    EXPECT_EQ(range(5, 4), range(9, 2));
    EXPECT_EQ(range(5, 6), (RecordRange{RecordNumber{5}, RecordCount{2}}));
    EXPECT_NE(range(5, 6), range(5, 7));
    EXPECT_NE(range(5, 6), range(6, 7));
}

TEST(RecordRange, shouldPrintAsFirstAndLast) {
    EXPECT_EQ(printed(range(22118, 22373)), "22118-22373");
    EXPECT_EQ(printed(RecordRange{}), "none");
}

TEST(RecordRangeDeathTest, shouldAbortWhenItWouldEndBehindTheLargestNumber) {
    EXPECT_DEATH(static_cast<void>(RecordRange{RecordNumber{1}, RecordCount{4'294'967'296U}}), "count.value");
}

TEST(RecordRangeDeathTest, shouldHaveNoLastNumberWhenEmpty) {
    EXPECT_DEATH(static_cast<void>(RecordRange{}.last()), "!empty");
}

} // namespace
} // namespace linefeed
