// The promise, judged from outside: whatever goes wrong between the feeder, a printer and the ledger, every record is
// printed once, or the ledger names it as in doubt. Random faults from a seed; then they end, and the job must come to
// its end.
#include "line_double.hpp"

namespace linefeed::feeder {
namespace {

using Habit = PrinterDouble::StopPointHabit;

constexpr std::uint32_t seeds = 50;

/// The number of records that were in doubt over all seeds.
std::uint64_t run_all(const Faults& faults, Habit habit) {
    std::uint64_t doubts = 0;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", habit " << static_cast<int>(habit));
        Line line{seed, faults, habit};
        line.run();
        if (testing::Test::HasFatalFailure()) {
            ADD_FAILURE() << line.trace();
            break;
        }
        doubts += line.doubts();
    }
    return doubts;
}

class Exactness : public testing::TestWithParam<Habit> {};
INSTANTIATE_TEST_SUITE_P(StopPoint, Exactness,
                         testing::Values(Habit::kept, Habit::only_while_printing, Habit::ignored));

TEST_P(Exactness, shouldPrintEveryRecordOnceWhenNothingGoesWrong) {
    EXPECT_EQ(run_all({}, GetParam()), 0U);
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWhenTheLinkBreaks) {
    EXPECT_EQ(run_all({.link = true}, GetParam()), 0U);
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWhenLinefeedDies) {
    run_all({.host_crash = true}, GetParam());
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWhenThePrinterLosesItsPower) {
    run_all({.power = true}, GetParam());
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWhenThePrinterStops) {
    EXPECT_EQ(run_all({.errors = true, .operator_stops = true, .requests = true}, GetParam()), 0U);
}

TEST_P(Exactness, shouldPrintEveryRecordOnceOrDoubtItWhenThePrinterIsRestartedBehindOurBack) {
    if (GetParam() != Habit::ignored) { // there, only the stop point gives a short stop away
        run_all({.restarts = true}, GetParam());
        run_all({.link = true, .errors = true, .operator_stops = true, .restarts = true, .requests = true}, GetParam());
    }
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWhenEverythingGoesWrong) {
    run_all({.link = true, .host_crash = true, .power = true, .errors = true, .operator_stops = true, .requests = true},
            GetParam());
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWithoutTheCounter) {
    run_all({.link = true,
             .host_crash = true,
             .power = true,
             .errors = true,
             .operator_stops = true,
             .requests = true,
             .broken_counter = true},
            GetParam());
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWhileTheSourceIsRead) {
    EXPECT_EQ(run_all({.slow_source = true}, GetParam()), 0U);
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWhenEverythingGoesWrongWhileTheSourceIsRead) {
    run_all({.link = true,
             .host_crash = true,
             .power = true,
             .errors = true,
             .operator_stops = true,
             .requests = true,
             .slow_source = true},
            GetParam());
}

TEST_P(Exactness, shouldPrintEveryRecordOnceWhenRestartedWhileTheSourceIsRead) {
    if (GetParam() != Habit::ignored) {
        run_all({.restarts = true, .slow_source = true}, GetParam());
    }
}

} // namespace
} // namespace linefeed::feeder
