// How the printer talks: framing modes, echo, CRC, firmware habits, and the smaller inquiries (protocol, sections 1, 4,
// 6; field notes, "Firmware habits").
#include "printer_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::simulator::test {
namespace {

using ::testing::ElementsAre;

PrinterSettings with_habit(std::string_view name) {
    PrinterSettings settings;
    EXPECT_TRUE(set_habit(settings.habits, name)) << name;
    return settings;
}

TEST(PrinterFraming, shouldPutTheLengthOfTheManualsVectorBeforeTheAnswer) {
    PrinterSettings settings;
    settings.speed = 0;
    Printer printer{settings};
    printer.fill(1, 2);
    printer.send("^0!GO\r");
    printer.rs();
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t0\t0\r");
    EXPECT_EQ(printer.send("^0!LN\r^0?RS\r"), "^000015=RS2\t6\t0\t0\t0\t0\r");
    PrinterSettings five = with_habit("five_value_status");
    five.speed = 0;
    five.length_on = true;
    Printer older{five};
    older.send("^0!GO\r");
    EXPECT_EQ(older.rs(), "^000013=RS2\t6\t0\t0\t0\r");
}

TEST(PrinterFraming, shouldKeepLengthAndEchoForTheNextClientUntilAFactoryReset) {
    Printer printer;
    printer.send("^0!LN\r^0!EM\r", 1);
    EXPECT_EQ(printer.send("^0=CM5\r^0?SM\r", 2), "^000005=CM5\r^000015=SM256\t0\t0\t5\t1\r");
    EXPECT_EQ(printer.send("^0!FA\r^0!EQ\r^0?SM\r", 2), "^000004!FA\r^0=SM256\t0\t0\t5\t1\r");
}

TEST(PrinterFraming, shouldEchoActionsAndParametersAsReceivedBeforeActing) {
    PrinterSettings settings;
    settings.echo_on = true;
    Printer printer{settings};
    EXPECT_EQ(printer.send("^0=MR1\ta\\^\xE4\r^0?SM\r^0!ZZ\r^0*x\r^0$RDx\r"),
              "^0=MR1\ta\\^\xE4\r^0=SM256\t0\t0\t0\t1\r^0!ZZ\r^0$DI1\t00\r");
    EXPECT_EQ(printer.send("^0=NR1\r^0!GO\r"), "^0=NR1\r^0!GO\r^0=FC3523139330\r");
}

TEST(PrinterFraming, shouldFillBlocksWithBlanks) {
    Printer printer;
    printer.send("^0=FL30\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r" + std::string(13, ' '));
    const std::string versions = printer.send("^0?VS\r");
    EXPECT_EQ(versions.size() % 30, 0U);
    printer.send("^0=FL0\r^0=FL2049\r^0=FLx\r");
    EXPECT_EQ(printer.sm().size(), 30U);
    EXPECT_EQ(printer.send("^0=NR3957421711\r^0?JL\r").size(), 30U + 30U + 60U); // OK, NR, JL
    printer.send("^0=FL2048\r");
    EXPECT_EQ(printer.sm().size(), 2048U);
}

TEST(PrinterFraming, shouldEndLinesAsItsFirmwareDoes) {
    Printer with_lf{with_habit("crlf")};
    EXPECT_EQ(with_lf.sm(), "^0=SM256\t0\t0\t0\t1\r\n");
    Printer reversed{with_habit("lfcr")};
    EXPECT_EQ(reversed.sm(), "^0=SM256\t0\t0\t0\t1\n\r");
}

TEST(PrinterFraming, shouldAnswerTheClientThatAskedAndIgnoreOtherAddresses) {
    Printer printer;
    EXPECT_EQ(printer.send("^0?SM\r", 7), "^0=SM256\t0\t0\t0\t1\r");
    EXPECT_TRUE(printer.others.empty());
    EXPECT_EQ(printer.send("^1?SM\r^1=CM5\r"), "");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r");
}

TEST(PrinterFraming, shouldIgnoreUnknownCommandsAndExcessParameters) {
    Printer printer;
    EXPECT_EQ(printer.send("^0?SL\r^0?XX\r^0?\r^0!XX\r^0!GOX\r^0=XX1\r^0=\r^0*BEGINLJSCRIPT\r\r\r"), "");
    EXPECT_EQ(printer.send("^0=CM5\t6\t7\r^0?SM\r"), "^0=SM256\t0\t0\t5\t1\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
}

TEST(PrinterHabits, shouldIgnoreStopPointsInTheVeryVersionThatDoes) {
    const auto ignores = [](const char* profile, const char* firmware) {
        PrinterSettings settings;
        settings.profile = *protocol::profile_by_name(profile);
        settings.firmware = firmware;
        return habits_of_version(settings).ignore_stop_at;
    };
    EXPECT_TRUE(ignores("jet2neo", "")); // V75.0.11.2
    EXPECT_TRUE(ignores("jet2neo", "V75.0.11.2"));
    EXPECT_FALSE(ignores("jet2neo", "V75.0.12.0"));
    EXPECT_FALSE(ignores("jet2neo-v71", ""));
    EXPECT_FALSE(ignores("jet3up", "V75.0.11.2"));
}

TEST(PrinterHabits, shouldSwallowRecordsWithoutAMailingField) {
    Printer printer{with_habit("no-mailing-field")};
    printer.fill(1, 300);
    printer.send("^0=MR\r^0!GO\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r");
    printer.products(2);
    ASSERT_EQ(printer.tape.size(), 2U);
    EXPECT_EQ(printer.tape[1].text, "Testprint");
    EXPECT_THAT(printer.error_codes(), testing::IsEmpty());
}

TEST(PrinterCrc, shouldHoldTheManualsSequence) {
    for (const char* profile : {"jet3", "jet3up"}) {
        PrinterSettings settings;
        settings.profile = *protocol::profile_by_name(profile);
        Printer printer{settings};
        EXPECT_EQ(printer.send("^0=NR3957421711\r^0?JL\r"),
                  "^0!OK\r^0=NR3560773416\r^0=JL\\FFSDISK\\JOBS\\Testprint.job\r");
    }
}

TEST(PrinterCrc, shouldTellItsOwnSumAndNotExecuteWhenItIsWrong) {
    Printer printer;
    EXPECT_EQ(printer.send("^0=NR3957421712\r^0?JL\r"), "^0=FC3957421711\r");
    EXPECT_EQ(printer.send("^0=NR1\r^0=CM5\r").substr(0, 5), "^0=FC");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r"); // and only the next frame is checked
}

TEST(PrinterCrc, shouldExecuteNoFrameWhoseAnnouncedSumCannotBeRead) {
    for (const char* damaged : {"", "abc", "39574x7711", "99999999999", "-1"}) {
        Printer printer;
        EXPECT_EQ(printer.send("^0=NR" + std::string{damaged} + "\r^0?JL\r"), "^0=FC3957421711\r") << damaged;
        printer.send("^0=NR" + std::string{damaged} + "\r^0=CM5\r");
        EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r") << damaged;
        EXPECT_EQ(printer.send("^0=NR" + std::string{damaged} + "\r^0=NR3957421711\r^0?JL\r").substr(0, 5), "^0!OK")
            << "the host repeats both";
    }
}

TEST(PrinterCrc, shouldConfirmCommandsWithoutAnAnswerAndCheckRecords) {
    Printer printer;
    // Sums from zlib: python3 -c 'import zlib; print(zlib.crc32(b"^0=MR1\ta"))'
    EXPECT_EQ(printer.send("^0=NR984658253\r^0=MR1\ta\r"), "^0!OK\r");
    EXPECT_EQ(printer.send("^0=NR984658253\r^0=MR2\ta\r").substr(0, 5), "^0=FC");
    printer.send("^0=MR2\tb\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t1\t0\t0\t1\r");
}

TEST(PrinterCrc, shouldKeepTheAnnouncementsOfClientsApartAndForgetThem) {
    Printer printer;
    printer.send("^0=NR1\r", 1);
    EXPECT_EQ(printer.send("^0?SM\r", 2), "^0=SM256\t0\t0\t0\t1\r");
    EXPECT_EQ(printer.send("^0?SM\r", 1).substr(0, 5), "^0=FC");
    printer.send("^0=NR1\r", 1);
    printer.model.disconnected(ConnectionId{1});
    EXPECT_EQ(printer.send("^0?SM\r", 1), "^0=SM256\t0\t0\t0\t1\r");
    printer.send("^0=NR1\r^0=NR3957421711\r", 1); // the newer announcement counts
    EXPECT_EQ(printer.send("^0?JL\r", 1).substr(0, 6), "^0!OK\r");
}

TEST(PrinterCrc, shouldLeaveFileTransferOut) {
    Printer printer;
    EXPECT_EQ(printer.send("^0=NR1\r^0$RDx\r^0?SM\r"), "^0$DI1\t00\r^0=SM256\t0\t0\t0\t1\r");
}

TEST(PrinterCrc, shouldSumWhatIsSentWithItsLength) {
    Printer printer;
    printer.send("^0!LN\r");
    const std::string answer = printer.send("^0=NR3957421711\r^0?JL\r");
    // zlib.crc32(b"^000031=JL\\FFSDISK\\JOBS\\Testprint.job")
    EXPECT_EQ(answer, "^000004!OK\r^000014=NR1694508846\r^000031=JL\\FFSDISK\\JOBS\\Testprint.job\r");
}

TEST(PrinterHabits, shouldKnowEveryNameOfTheHelp) {
    for (const std::string_view name : habit_names) {
        Habits habits;
        EXPECT_TRUE(set_habit(habits, name)) << name;
        EXPECT_NE(habits, Habits{}) << name;
    }
    Habits habits;
    EXPECT_FALSE(set_habit(habits, "nonsense"));
    EXPECT_FALSE(set_habit(habits, "nonsense=off"));
    EXPECT_FALSE(set_habit(habits, "crlf=off"));
    EXPECT_EQ(habits, Habits{});
    EXPECT_TRUE(set_habit(habits, "ignore-stop-at"));
    EXPECT_TRUE(set_habit(habits, "ignore_stop_at=off"));
    EXPECT_EQ(habits, Habits{});
}

TEST(PrinterHabits, shouldIgnoreTheStopNumber) {
    Printer printer{with_habit("ignore-stop-at")};
    printer.fill(1, 3);
    EXPECT_EQ(printer.send("^0=CM2\r^0?SM\r^0!GO\r^0=CM2\r^0?SM\r"), "^0=SM256\t2\t0\t0\t1\r^0=SM256\t2\t0\t0\t1\r");
    printer.products(3);
    EXPECT_THAT(printer.printed_numbers(), ElementsAre(1, 2, 3));
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped);
    EXPECT_THAT(printer.error_codes(), ElementsAre(5043));
}

TEST(PrinterHabits, shouldKeepTheStopNumberOnlyWhilePrinting) {
    Printer printer{with_habit("stop-at-only-while-printing")};
    printer.fill(1, 3);
    EXPECT_EQ(printer.send("^0=CM2\r^0?SM\r^0!GO\r^0=CM2\r^0?SM\r"), "^0=SM256\t2\t0\t0\t1\r^0=SM256\t2\t0\t2\t1\r");
}

TEST(PrinterHabits, shouldAnswerTheMailStatusOfThePreviousInquiry) {
    Printer printer{with_habit("stale-mail-status")};
    printer.fill(1, 3);
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t2\t0\t0\t1\r");
    printer.send("^0!GO\r");
    printer.products(2);
    EXPECT_EQ(printer.sm(), "^0=SM256\t2\t0\t0\t1\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t2\t0\t1\r");
}

TEST(PrinterHabits, shouldAppendThePrintGoCount) {
    Printer printer{with_habit("sixth-value")};
    printer.product();
    printer.fill(1, 3);
    printer.send("^0!GO\r");
    printer.products(2);
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t2\t0\t1\t3\r");
}

TEST(PrinterHabits, shouldLeaveOutTheTotalCounter) {
    PrinterSettings settings = with_habit("no-total-counter");
    settings.total_prints = 500;
    Printer printer{settings};
    printer.fill(1, 3);
    printer.send("^0!GO\r");
    printer.products(2);
    EXPECT_EQ(printer.send("^0?CC\r"), "^0=CC2\t0\r");
}

TEST(PrinterHabits, shouldSetBit24OfErrors) {
    Printer printer{with_habit("error-bit-24")};
    printer.send("^0=MR1\ta\r^0=CM1\r^0!GO\r");
    printer.product();
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t-1694497593\t0\t9\t1\r"); // 0x9B0004C7
}

TEST(PrinterHabits, shouldShowSpeedsInMetres) {
    PrinterSettings settings = with_habit("speed-in-metres");
    settings.speed = 1234;
    Printer printer{settings};
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t123\t1\r");
    EXPECT_EQ(printer.send("^0?EX\r"), "^0=EX123\t0\t300\t1\t0\t0\t0\t0\t0\r");
}

TEST(PrinterInquiries, shouldSetAndTellTheClock) {
    PrinterSettings settings;
    settings.clock_at_zero = std::chrono::sys_days{std::chrono::year{2015} / 10 / 26};
    Printer printer{settings};
    EXPECT_EQ(printer.send("^0?DL\r"), "^0=DL2015\t10\t1\t26\t0\t0\t1\r");
    printer.send("^0=DL2024\t2\t4\t29\t23\t59\t58\r");
    printer.wait(seconds{3});
    EXPECT_EQ(printer.send("^0?DL\r"), "^0=DL2024\t3\t5\t1\t0\t0\t1\r");
    printer.send("^0=DL2024\t2\t4\t29\t23\t59\r^0=DL2023\t2\t4\t29\t1\t1\t1\r^0=DL2023\t2\t4\t28\t24\t1\t1\r");
    EXPECT_EQ(printer.send("^0?DL\r"), "^0=DL2024\t3\t5\t1\t0\t0\t1\r");
}

TEST(PrinterInquiries, shouldStoreAnExternTextAfterItsTime) {
    Printer printer;
    EXPECT_EQ(printer.send("^0=ETHallo\\^(8 3 FF81FF)\r^0?ET\r"), "^0=ET\r");
    printer.wait(milliseconds{30});
    EXPECT_EQ(printer.send("^0?ET\r"), "^0=ETHallo\\^(8 3 FF81FF)\r");
}

TEST(PrinterInquiries, shouldSetAndTellPrintParameters) {
    Printer printer;
    EXPECT_EQ(printer.send("^0=PR2\t31000\r^0?PR2\r"), "^0=PR2\t31000\r");
    EXPECT_EQ(printer.send("^0=PR6\t1\r^0=PR0\t1\r^0?PR6\r^0?PR0\r^0?PR\r^0?PR2\r"), "^0=PR2\t31000\r");
}

TEST(PrinterInquiries, shouldAnswerWithTheNumberOfValuesOfTheManual) {
    const auto values = [](const std::string& answer) { return std::count(answer.begin(), answer.end(), '\t') + 1; };
    Printer printer;
    EXPECT_EQ(values(printer.send("^0?HS\r")), 6);
    EXPECT_EQ(values(printer.send("^0?IC\r")), 6);
    EXPECT_EQ(values(printer.send("^0?MC\r")), 13);
    EXPECT_EQ(values(printer.send("^0?OC\r")), 8);
    EXPECT_EQ(values(printer.send("^0?EX\r")), 9);
    EXPECT_EQ(values(printer.send("^0?SC\r")), 2);
    EXPECT_EQ(printer.send("^0?DS\r"), "^0=DS24576\r");
    EXPECT_EQ(printer.send("^0?AC\r"), "^0=AC0\r");
    EXPECT_EQ(printer.send("^0?MS\r"), "^0=MS1\t1\t1\t0\t0\t0\t1\t0\t2\t0\t0\r");
    // 2023-06-15 09:00:00: 23 << 26 | 6 << 22 | 15 << 17 | 9 << 12
    EXPECT_EQ(printer.send("^0?SH\r"), "^0=SH1234\t1000\t1570672640\r");
    PrinterSettings settings;
    settings.profile = *protocol::profile_by_name("jet2neo");
    Printer small{settings};
    EXPECT_EQ(values(small.send("^0?IC\r")), 3);
    EXPECT_EQ(values(small.send("^0?OC\r")), 4);
}

} // namespace
} // namespace linefeed::simulator::test
