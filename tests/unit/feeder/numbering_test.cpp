// Which number means which record, where two jobs lie one behind the other.
#include "feeder/numbering.hpp"

#include <gtest/gtest.h>

namespace linefeed::feeder {
namespace {

RecordNumber no(std::uint32_t value) {
    return RecordNumber{value};
}

/// The records 1-1000 of one job, and behind them those of another that begins with 1 as well.
Numbering two_jobs() {
    Numbering numbering;
    numbering.append(no(1001), no(1));
    return numbering;
}

TEST(Numbering, shouldLeaveTheNumbersOfOneJobAlone) {
    const Numbering numbering;
    EXPECT_EQ(numbering.number_of(no(22118)), no(22118));
    EXPECT_EQ(numbering.on_wire(no(22118)), no(22118));
    EXPECT_EQ(numbering.place_of(no(22118), no(22000), no(22200)), no(22118));
    EXPECT_EQ(numbering.place_of(no(77), no(22000), no(22200)), no(77)) << "left over from before";
    EXPECT_EQ(numbering.distinct_through(no(5)), RecordNumber::max());
    EXPECT_FALSE(numbering.has_zero(no(0), RecordNumber::max()));
}

TEST(Numbering, shouldBeginTheFollowerWithNumberZero) {
    const Numbering numbering = two_jobs();
    EXPECT_EQ(numbering.on_wire(no(1000)), no(1000));
    EXPECT_EQ(numbering.on_wire(no(1001)), no(0));
    EXPECT_EQ(numbering.number_of(no(1001)), no(1));
    EXPECT_EQ(numbering.on_wire(no(1002)), no(2));
}

TEST(Numbering, shouldFindARecordAmongThoseThatCanBeReported) {
    const Numbering numbering = two_jobs();
    EXPECT_EQ(numbering.place_of(no(998), no(990), no(1200)), no(998));
    EXPECT_EQ(numbering.place_of(no(0), no(990), no(1200)), no(1001));
    EXPECT_EQ(numbering.place_of(no(200), no(990), no(1200)), no(1200));
    EXPECT_EQ(numbering.place_of(no(200), no(150), no(1100)), no(200));
}

TEST(Numbering, shouldFindNothingWhereNoRecordOfOursHasTheNumber) {
    const Numbering numbering = two_jobs();
    EXPECT_EQ(numbering.place_of(no(201), no(990), no(1200)), RecordNumber::max()) << "not sent";
    EXPECT_EQ(numbering.place_of(no(1), no(990), no(1200)), RecordNumber::max()) << "this one went out with 0";
    EXPECT_EQ(numbering.place_of(no(1001), no(990), no(1200)), RecordNumber::max()) << "a place is not a number";
    EXPECT_EQ(numbering.place_of(no(0), no(1002), no(1200)), no(0)) << "printed before";
    EXPECT_EQ(numbering.place_of(no(0), no(900), no(1000)), no(0)) << "not sent";
}

TEST(Numbering, shouldSendOnlySoManyThatEachNumberMeansOneRecord) {
    const Numbering numbering = two_jobs();
    EXPECT_EQ(numbering.distinct_through(no(998)), no(1997)) << "997 is the last; 998 may be reported of the job";
    EXPECT_EQ(numbering.distinct_through(no(2)), no(1001)) << "only the one with 0";
    EXPECT_EQ(numbering.distinct_through(no(1001)), RecordNumber::max()) << "nothing of the job is reported any more";
    Numbering ascending;
    ascending.append(no(1001), no(5000));
    EXPECT_EQ(ascending.distinct_through(no(2)), RecordNumber::max());
}

TEST(Numbering, shouldNotPassTheLastPlaceThereIs) {
    Numbering numbering;
    numbering.append(no(UINT32_MAX - 100), no(1));
    EXPECT_EQ(numbering.distinct_through(no(UINT32_MAX - 200)), RecordNumber::max());
}

TEST(Numbering, shouldForgetTheJobThatIsPrinted) {
    Numbering numbering;
    numbering.forget_before(no(500));
    numbering.append(no(1001), no(1));
    numbering.forget_before(no(1000));
    EXPECT_EQ(numbering.number_of(no(1000)), no(1000)) << "not yet";
    numbering.forget_before(no(1001));
    EXPECT_EQ(numbering.number_of(no(1500)), no(500));
    EXPECT_EQ(numbering.place_of(no(500), no(1400), no(1600)), no(1500));
    EXPECT_EQ(numbering.place_of(no(0), no(1400), no(1600)), no(0));
    numbering.append(no(2001), no(1));
    EXPECT_EQ(numbering.on_wire(no(2000)), no(1000));
    EXPECT_EQ(numbering.on_wire(no(2001)), no(0));
    EXPECT_TRUE(numbering.has_zero(no(2001), no(2001)));
    EXPECT_FALSE(numbering.has_zero(no(1002), no(2000)));
    EXPECT_TRUE(numbering.has_zero(no(1001), no(2000)));
}

TEST(Numbering, shouldKnowARunThatHasBegunWithZero) {
    const Numbering numbering = Numbering::begun_with_zero(no(101));
    EXPECT_EQ(numbering.on_wire(no(101)), no(0));
    EXPECT_EQ(numbering.on_wire(no(102)), no(102));
    EXPECT_EQ(numbering.place_of(no(0), no(100), no(300)), no(101));
    EXPECT_EQ(numbering.place_of(no(102), no(100), no(300)), no(102));
    EXPECT_EQ(numbering.place_of(no(77), no(100), no(300)), no(77)) << "left over from before";
    EXPECT_EQ(numbering.number_of(no(77)), no(77));
}

} // namespace
} // namespace linefeed::feeder
