// The table of exit codes (design, section 7): scripts rely on every line of it.
#include "cli/exit_code.hpp"

#include <gtest/gtest.h>

namespace linefeed::cli {
namespace {

using feeder::Outcome;
using feeder::OutcomeCode;

ExitCode code_of(OutcomeCode code, bool issued) {
    return exit_code(Outcome{code, protocol::MachineState::standby, {}, issued});
}

TEST(ExitCode, shouldHaveTheNumbersOfTheDesign) {
    EXPECT_EQ(static_cast<int>(ExitCode::done), 0);
    EXPECT_EQ(static_cast<int>(ExitCode::other), 1);
    EXPECT_EQ(static_cast<int>(ExitCode::usage), 2);
    EXPECT_EQ(static_cast<int>(ExitCode::unreachable), 3);
    EXPECT_EQ(static_cast<int>(ExitCode::stopped), 4);
    EXPECT_EQ(static_cast<int>(ExitCode::input_rejected), 5);
    EXPECT_EQ(static_cast<int>(ExitCode::in_doubt), 6);
}

TEST(ExitCode, shouldFollowTheKindOfAFailure) {
    EXPECT_EQ(exit_code(FailureKind::usage), ExitCode::usage);
    EXPECT_EQ(exit_code(FailureKind::unreachable), ExitCode::unreachable);
    EXPECT_EQ(exit_code(FailureKind::stopped), ExitCode::stopped);
    EXPECT_EQ(exit_code(FailureKind::input), ExitCode::input_rejected);
    EXPECT_EQ(exit_code(FailureKind::in_doubt), ExitCode::in_doubt);
    EXPECT_EQ(exit_code(FailureKind::storage), ExitCode::other);
    EXPECT_EQ(exit_code(FailureKind::internal), ExitCode::other);
}

TEST(ExitCode, shouldBeZeroOnlyWhenNothingIsLeftToPrint) {
    for (int value = 0; value <= static_cast<int>(OutcomeCode::storage_failed); ++value) {
        const auto code = static_cast<OutcomeCode>(value);
        const bool complete = code == OutcomeCode::finished || code == OutcomeCode::nothing_to_print;
        EXPECT_EQ(code_of(code, true) == ExitCode::done, complete) << to_string(code);
        EXPECT_EQ(code_of(code, false) == ExitCode::done, complete) << to_string(code);
    }
}

TEST(ExitCode, shouldCallASilentPrinterUnreachableOnlyBeforeTheFirstRecord) {
    for (const OutcomeCode code : {OutcomeCode::no_answer, OutcomeCode::not_secured, OutcomeCode::link_lost}) {
        EXPECT_EQ(code_of(code, false), ExitCode::unreachable) << to_string(code);
        EXPECT_EQ(code_of(code, true), ExitCode::stopped) << to_string(code);
    }
    EXPECT_EQ(code_of(OutcomeCode::unreachable, false), ExitCode::unreachable);
}

TEST(ExitCode, shouldAskForTheOperatorWhenRecordsAreInDoubt) {
    EXPECT_EQ(code_of(OutcomeCode::records_in_doubt, true), ExitCode::in_doubt);
    EXPECT_EQ(code_of(OutcomeCode::records_in_doubt, false), ExitCode::in_doubt);
}

TEST(ExitCode, shouldBeResumableForEveryStopInBetween) {
    for (const OutcomeCode code :
         {OutcomeCode::stop_requested, OutcomeCode::stopped_at_printer, OutcomeCode::printer_error,
          OutcomeCode::not_ready, OutcomeCode::cover_open, OutcomeCode::busy, OutcomeCode::error_pending,
          OutcomeCode::fifo_not_flushed, OutcomeCode::records_not_taken, OutcomeCode::did_not_start,
          OutcomeCode::did_not_stop, OutcomeCode::impossible_report, OutcomeCode::printer_restarted,
          OutcomeCode::storage_failed}) {
        EXPECT_EQ(code_of(code, true), ExitCode::stopped) << to_string(code);
    }
}

} // namespace
} // namespace linefeed::cli
