// Messages as bytes, compared with literal frames of the manual.
#include "protocol/messages.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

template <typename... Arguments>
std::string encoded(const Arguments&... arguments) {
    std::string out = ">";
    append_message(out, arguments...);
    return out.substr(1);
}

TEST(MessagesEncoder, shouldWriteTheMachineStatus) {
    const PrinterError last_printed{-1711274809};
    EXPECT_EQ(encoded(MachineStatus{NozzleState::open, MachineState::printing, last_printed, false, 9, false}),
              "^0=RS2\t6\t-1711274809\t0\t9\t0\r");
    EXPECT_EQ(encoded(MachineStatus{NozzleState::open, MachineState::ready_to_print, {}, false, 9, true}),
              "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(encoded(MachineStatus{NozzleState::closed, MachineState::ready, {}, true, 0, std::nullopt}),
              "^0=RS4\t4\t0\t1\t0\r");
}

TEST(MessagesEncoder, shouldWriteTheMailStatus) {
    EXPECT_EQ(encoded(MailStatus{256, 253, RecordNumber{22119}, RecordNumber{100000}, true, std::nullopt}),
              "^0=SM256\t253\t22119\t100000\t1\r");
    EXPECT_EQ(encoded(MailStatus{256, 0, RecordNumber{3}, RecordNumber{0}, false, 21}), "^0=SM256\t0\t3\t0\t0\t21\r");
}

TEST(MessagesEncoder, shouldWriteStopAt) {
    EXPECT_EQ(encoded(StopAt{RecordNumber{100000}}), "^0=CM100000\r");
    EXPECT_EQ(encoded(StopAt{}), "^0=CM0\r");
}

TEST(MessagesEncoder, shouldLeaveAbsentCountersEmpty) {
    EXPECT_EQ(encoded(Counters{17, 0, 123456}), "^0=CC17\t0\t123456\r");
    EXPECT_EQ(encoded(Counters{17, 500, std::nullopt}), "^0=CC17\t500\r");
    EXPECT_EQ(encoded(Counters{std::nullopt, 500, std::nullopt}), "^0=CC\t500\r");
    EXPECT_EQ(encoded(Counters{17, std::nullopt, std::nullopt}), "^0=CC17\t\r");
    EXPECT_EQ(encoded(Counters{std::nullopt, std::nullopt, 5}), "^0=CC\t\t5\r");
}

TEST(MessagesEncoder, shouldWriteElevenVersions) {
    EXPECT_EQ(encoded(VersionInfo{"f", "r", "s", "fe", "k", "JET3up", "l", "fo", "V62.0.7.0", "t", "4711"},
                      EscapeMode::backslash),
              "^0=VSf\tr\ts\tfe\tk\tJET3up\tl\tfo\tV62.0.7.0\tt\t4711\r");
    EXPECT_EQ(encoded(VersionInfo{}, EscapeMode::none), "^0=VS\t\t\t\t\t\t\t\t\t\t\r");
}

TEST(MessagesEncoder, shouldWriteJobPathsForTheFirmware) {
    const JobName job{"\\FFSDISK\\JOBS\\Testprint.job"};
    EXPECT_EQ(encoded(job, EscapeMode::none), "^0=JL\\FFSDISK\\JOBS\\Testprint.job\r");
    EXPECT_EQ(encoded(job, EscapeMode::backslash), "^0=JL\\\\FFSDISK\\\\JOBS\\\\Testprint.job\r");
}

TEST(MessagesEncoderDeathTest, shouldAbortOnTextThatWouldEndOrSplitTheParameter) {
    EXPECT_DEATH(encoded(JobName{"a\tb"}, EscapeMode::none), "find_first_of");
    EXPECT_DEATH(encoded(JobName{"a\rb"}, EscapeMode::none), "find_first_of");
}

} // namespace
} // namespace linefeed::protocol
