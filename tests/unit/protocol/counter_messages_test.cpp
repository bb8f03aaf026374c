// Counters of the job: values beyond 32 bits, ids, start values.
#include "parsing.hpp"

namespace linefeed::protocol {
namespace {

TEST(JobCounters, shouldPutHighAndLowTogether) {
    const auto counters = parsed_as<JobCounters>("^0=AC2\t1\t0\t17\t3\t2\t1410065407\r");
    EXPECT_EQ(counters, (JobCounters{{{1, 17}, {3, 9'999'999'999}}}));
    EXPECT_EQ(parsed_as<JobCounters>("^0=AC0\r"), JobCounters{});
    EXPECT_EQ(reason("^0=AC2\t1\t0\t17\r"), "=AC: parameter 5 is missing: a number of repetitions");
    EXPECT_EQ(reason("^0=AC1\t1\t0\tx\r"), "=AC: parameter 4 is not the low part of a value: \"x\"");
    EXPECT_EQ(reason("^0=AC4294967295\t1\r"), "=AC: parameter 3 is missing: the high part of a value");
}

TEST(CounterParameter, shouldKnowStartAndEndOnly) {
    EXPECT_EQ(parsed_as<CounterParameter>("^0=CP1\t2\t9999999999\r"),
              (CounterParameter{1, CounterLimit::end, max_counter_value}));
    EXPECT_EQ(reason("^0=CP1\t3\t1\r"), "=CP: parameter 2 is not 1 or 2: \"3\"");
    EXPECT_EQ(reason("^0=CP1\t1\t10000000000\r"), "=CP: parameter 3 is not a counter value: \"10000000000\"");
    EXPECT_EQ(reason("^0=CP1\t1\r"), "=CP: parameter 3 is missing: a counter value");
}

TEST(CounterReset, shouldTakeTheJobsStartForMinusOneAndForNothing) {
    EXPECT_EQ(parsed_as<CounterReset>("^0=RC0\r"), (CounterReset{0, std::nullopt}));
    EXPECT_EQ(parsed_as<CounterReset>("^0=RC2\t-1\r"), (CounterReset{2, std::nullopt}));
    EXPECT_EQ(parsed_as<CounterReset>("^0=RC2\t \r"), (CounterReset{2, std::nullopt}));
    EXPECT_EQ(parsed_as<CounterReset>("^0=RC2\t9999999999 \r"), (CounterReset{2, 9'999'999'999}));
    EXPECT_EQ(reason("^0=RC2\t-2\r"), "=RC: parameter 2 is not a start value: \"-2\"");
    EXPECT_EQ(reason("^0=RC2\t10000000000\r"), "=RC: parameter 2 is not a start value: \"10000000000\"");
    EXPECT_EQ(reason("^0=RC\r"), "=RC: parameter 1 is missing: a counter id");
    EXPECT_EQ(encoded(CounterReset{0, std::nullopt}), "^0=RC0\r");
}

} // namespace
} // namespace linefeed::protocol
