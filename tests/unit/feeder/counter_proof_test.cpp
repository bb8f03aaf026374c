// What the total print counter proves about reported numbers, and what it does not.
#include "feeder/counter_proof.hpp"

#include <gtest/gtest.h>

namespace linefeed::feeder {
namespace {

using Result = CounterProof::Result;
using std::chrono::milliseconds;

constexpr Instant at(int ms) {
    return Instant{milliseconds{1000 + ms}};
}

TEST(CounterProof, shouldWantNoCountWithoutDoubt) {
    CounterProof proof;
    EXPECT_FALSE(proof.doubted());
    EXPECT_FALSE(proof.wants_count(at(0)));
    EXPECT_FALSE(proof.reported(5));
}

TEST(CounterProof, shouldProveByTheSecondAnswerBehindTheCount) {
    CounterProof proof;
    proof.doubt(0);
    EXPECT_TRUE(proof.wants_count(at(0)));
    EXPECT_EQ(proof.counted(5, 5, 100, false, at(0)), Result::consistent);
    EXPECT_FALSE(proof.wants_count(at(100))) << "the last count is not compared yet";
    EXPECT_FALSE(proof.reported(5)) << "may be older than the count";
    EXPECT_TRUE(proof.reported(5));
    EXPECT_FALSE(proof.reported(5)) << "one count proves once";
}

TEST(CounterProof, shouldProveNothingWhenThePrinterPrintsOnSinceTheCount) {
    CounterProof proof;
    proof.doubt(0);
    EXPECT_EQ(proof.counted(5, 5, 100, true, at(0)), Result::consistent);
    EXPECT_FALSE(proof.reported(5));
    EXPECT_FALSE(proof.reported(6)) << "6 may have been 5, with one left out";
    EXPECT_TRUE(proof.doubted());
}

TEST(CounterProof, shouldDoubtNoLongerOnceAStopWouldShow) {
    CounterProof proof;
    proof.doubt(0);
    EXPECT_EQ(proof.counted(5, 5, 100, false, at(0)), Result::consistent);
    EXPECT_FALSE(proof.reported(5));
    EXPECT_TRUE(proof.reported(5));
    EXPECT_TRUE(proof.doubted()) << "a stop could go unseen right now";
    EXPECT_EQ(proof.counted(6, 6, 100, true, at(50)), Result::consistent);
    EXPECT_FALSE(proof.reported(6));
    EXPECT_TRUE(proof.reported(6));
    EXPECT_FALSE(proof.doubted());
}

TEST(CounterProof, shouldLeaveTimeBetweenCounts) {
    CounterProof proof;
    proof.doubt(0);
    EXPECT_EQ(proof.counted(5, 5, 100, false, at(0)), Result::consistent);
    EXPECT_FALSE(proof.reported(9));
    EXPECT_FALSE(proof.reported(9));
    EXPECT_FALSE(proof.wants_count(at(39)));
    EXPECT_TRUE(proof.wants_count(at(40)));
}

TEST(CounterProof, shouldHavePatienceWithACounterThatLags) {
    CounterProof proof;
    proof.doubt(0);
    EXPECT_EQ(proof.counted(4, 5, 100, false, at(0)), Result::consistent);
    EXPECT_EQ(proof.counted(5, 6, 100, false, at(99)), Result::consistent);
    EXPECT_EQ(proof.counted(5, 6, 100, false, at(100)), Result::behind);
    EXPECT_EQ(proof.counted(6, 6, 100, false, at(150)), Result::consistent) << "it has caught up";
    EXPECT_EQ(proof.counted(6, 7, 100, false, at(200)), Result::consistent) << "patience begins anew";
    EXPECT_EQ(proof.counted(6, 7, 100, false, at(300)), Result::behind);
}

TEST(CounterProof, shouldProveNothingByMorePrintsThanRecords) {
    CounterProof proof;
    proof.doubt(0);
    EXPECT_EQ(proof.counted(101, 5, 100, true, at(0)), Result::consistent);
    EXPECT_FALSE(proof.reported(5));
    EXPECT_FALSE(proof.reported(5));
    EXPECT_EQ(proof.counted(100, 5, 100, true, at(40)), Result::consistent);
    EXPECT_FALSE(proof.reported(5));
    EXPECT_TRUE(proof.reported(5));
}

TEST(CounterProof, shouldDoubtUntilAllDoubtedRecordsAreCounted) {
    CounterProof proof;
    proof.doubt(6);
    proof.doubt(3);
    EXPECT_EQ(proof.counted(5, 5, 100, true, at(0)), Result::consistent);
    EXPECT_FALSE(proof.reported(5));
    EXPECT_TRUE(proof.reported(5));
    EXPECT_TRUE(proof.doubted());
    EXPECT_EQ(proof.counted(6, 6, 100, true, at(40)), Result::consistent);
    EXPECT_FALSE(proof.reported(6));
    EXPECT_TRUE(proof.reported(6));
    EXPECT_FALSE(proof.doubted());
}

TEST(CounterProof, shouldKnowThatThereIsNoCounter) {
    CounterProof proof;
    proof.doubt(0);
    EXPECT_EQ(proof.counted(std::nullopt, 5, 100, false, at(0)), Result::no_counter);
    EXPECT_EQ(proof.counted(0, 5, 100, false, at(0)), Result::no_counter) << "it does not move";
    EXPECT_FALSE(proof.reported(5));
}

} // namespace
} // namespace linefeed::feeder
