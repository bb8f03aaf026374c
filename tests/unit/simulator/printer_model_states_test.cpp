// The machine of the printer: power, nozzle, cover, errors, jobs, counters (protocol, sections 2 and 4).
#include "printer_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::simulator::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

PrinterSettings in_standby() {
    PrinterSettings settings;
    settings.power_up = PowerUpState::standby;
    return settings;
}

TEST(PrinterStates, shouldGoFromStandbyToPrintingStepByStep) {
    Printer printer{in_standby()};
    EXPECT_EQ(printer.rs(), "^0=RS0\t1\t0\t0\t0\t0\r");
    printer.send("^0!PO\r");
    EXPECT_EQ(printer.rs(), "^0=RS0\t2\t0\t0\t9\t1\r");
    printer.send("^0!NO\r^0!GO\r"); // too early: nothing happens
    EXPECT_EQ(printer.rs(), "^0=RS0\t2\t0\t0\t9\t0\r");
    printer.wait(seconds{5});
    EXPECT_EQ(printer.rs(), "^0=RS4\t4\t0\t0\t9\t0\r");
    printer.send("^0!GO\r"); // the nozzle is closed
    EXPECT_EQ(printer.rs(), "^0=RS4\t4\t0\t0\t9\t0\r");
    printer.send("^0!NO\r");
    EXPECT_EQ(printer.rs(), "^0=RS1\t4\t0\t0\t9\t0\r");
    printer.wait(seconds{30} - Duration{1});
    EXPECT_EQ(printer.rs(), "^0=RS1\t4\t0\t0\t9\t0\r");
    printer.wait(Duration{1});
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t0\r");
    printer.send("^0!GO\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t0\r");
    printer.send("^0!ST\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t0\r");
    printer.send("^0!NC\r");
    EXPECT_EQ(printer.rs(), "^0=RS3\t4\t0\t0\t9\t0\r");
    printer.wait(seconds{10});
    EXPECT_EQ(printer.rs(), "^0=RS4\t4\t0\t0\t9\t0\r");
    printer.send("^0!PF\r");
    EXPECT_EQ(printer.rs(), "^0=RS0\t1\t0\t0\t0\t0\r");
}

TEST(PrinterStates, shouldHandleOnlyPowerOnRestartAndStatusInStandby) {
    Printer printer{in_standby()};
    for (const char* frame : {"^0?SM\r", "^0?VS\r", "^0?CC\r", "^0?JL\r", "^0=CM5\r", "^0=MR1\ta\r", "^0!GO\r",
                              "^0!NO\r", "^0!LN\r", "^0!EM\r", "^0=NR1\r"}) {
        EXPECT_EQ(printer.send(frame), "") << frame;
    }
    EXPECT_EQ(printer.rs(), "^0=RS0\t1\t0\t0\t0\t0\r");
    printer.send("^0!PO\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r");
}

TEST(PrinterStates, shouldBeSilentInStandbyWithThatHabit) {
    PrinterSettings settings = in_standby();
    settings.habits.standby_silent = true;
    Printer printer{settings};
    EXPECT_EQ(printer.rs(), "");
}

TEST(PrinterStates, shouldRestartOnlyInStandby) {
    Printer printer;
    printer.fill(1, 3);
    printer.send("^0!RM\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t2\t0\t0\t1\r");
    EXPECT_THAT(printer.others, IsEmpty());
    printer.send("^0!PF\r^0!RM\r");
    EXPECT_THAT(printer.others, Contains(Effect{ConnectionsLost{printer.now}}));
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
}

TEST(PrinterStates, shouldCloseTheNozzleWhileItOpens) {
    PrinterSettings settings;
    settings.power_up = PowerUpState::nozzle_closed;
    Printer printer{settings};
    printer.send("^0!NO\r");
    printer.wait(seconds{5});
    printer.send("^0!NC\r");
    EXPECT_EQ(printer.rs(), "^0=RS3\t4\t0\t0\t9\t1\r");
    printer.wait(seconds{60});
    EXPECT_EQ(printer.rs(), "^0=RS4\t4\t0\t0\t9\t0\r");
}

TEST(PrinterStates, shouldTakeRecordsBeforeTheNozzleIsOpen) {
    PrinterSettings settings;
    settings.power_up = PowerUpState::nozzle_closed;
    Printer printer{settings};
    printer.fill(1, 3);
    printer.send("^0!NO\r");
    printer.wait(seconds{30});
    printer.send("^0!GO\r");
    printer.products(3);
    EXPECT_THAT(printer.printed_numbers(), ElementsAre(1, 2, 3));
}

TEST(PrinterStates, shouldStopWithAnErrorWhenTheCoverIsOpened) {
    Printer printer;
    printer.fill(1, 3);
    printer.send("^0!GO\r");
    printer.operate([](auto& model, Instant now) { model.open_cover(now); });
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t335556320\t1\t9\t1\r"); // 0x14000000 | 12000: SDC, one tone
    EXPECT_EQ(printer.errors.at(0).error.source(), protocol::ErrorSource::sdc);
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r");
    printer.send("^0!EQ\r^0!GO\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t335556320\t1\t9\t0\r"); // an open cover cannot print
    printer.operate([](auto& model, Instant now) { model.close_cover(now); });
    printer.send("^0!EQ\r^0!GO\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t0\r");
}

TEST(PrinterStates, shouldOnlyShowTheCoverWhenNotPrinting) {
    PrinterSettings settings;
    settings.cover_open = true;
    Printer printer{settings};
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t1\t9\t1\r");
    printer.operate([](auto& model, Instant now) { model.close_cover(now); });
    printer.operate([](auto& model, Instant now) { model.open_cover(now); });
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t1\t9\t0\r");
    EXPECT_THAT(printer.error_codes(), IsEmpty());
}

TEST(PrinterErrors, shouldStayUntilAcknowledgedAndGiveWayToANewerOne) {
    Printer printer;
    printer.operate([](auto& model, Instant now) { model.raise_error(12113, now); });
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t302002001\t0\t9\t1\r"); // 0x12000000 | 12113
    printer.fill(1, 2);
    printer.send("^0!GO\r");
    printer.product();
    printer.send("^0!ST\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t302002001\t0\t9\t0\r");
    printer.operate([](auto& model, Instant now) { model.raise_error(12650, now); });
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t302002538\t0\t9\t0\r");
    printer.send("^0!EQ\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t0\r");
}

TEST(PrinterErrors, shouldSwitchTheMachineOffAfterThirtyMinutesUnlessTheNumberSaysNot) {
    Printer forgotten;
    forgotten.operate([](auto& model, Instant now) { model.raise_error(12113, now); });
    forgotten.wait(std::chrono::minutes{30} - Duration{1});
    EXPECT_EQ(forgotten.rs(), "^0=RS2\t5\t302002001\t0\t9\t1\r");
    forgotten.wait(Duration{1});
    EXPECT_EQ(forgotten.rs(), "^0=RS0\t1\t0\t0\t0\t0\r");

    Printer acknowledged;
    acknowledged.operate([](auto& model, Instant now) { model.raise_error(12113, now); });
    acknowledged.send("^0!EQ\r");
    acknowledged.wait(std::chrono::hours{2});
    EXPECT_EQ(acknowledged.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");

    Printer message;
    message.send("^0=MR1\ta\r^0=CM1\r^0!GO\r");
    message.product();
    message.wait(std::chrono::hours{2});
    EXPECT_EQ(message.rs(), "^0=RS2\t5\t-1711274809\t0\t9\t1\r");
}

TEST(PrinterErrors, shouldListErrorsInBlocksOf32) {
    PrinterSettings settings;
    settings.clock_at_zero = std::chrono::sys_days{std::chrono::year{2024} / 5 / 6};
    Printer printer{settings};
    EXPECT_EQ(printer.send("^0?EL\r"), "^0=EL1\t0\t0\r");
    printer.operate([](auto& model, Instant now) { model.raise_error(5043, now); });
    EXPECT_EQ(printer.send("^0?EL\r"), "^0=EL1\t1\t1\t24-05-06 00:00:01/00005043\r");
    for (std::uint32_t code = 1; code <= 33; ++code) {
        printer.operate([code](auto& model, Instant now) { model.raise_error(code, now); });
    }
    const std::string blocks = printer.send("^0?EL\r");
    EXPECT_TRUE(blocks.starts_with("^0=EL1\t34\t32\t24-05-06 00:00:01/00005043\t24-05-06 00:00:01/00000001\t"));
    EXPECT_TRUE(blocks.ends_with("\r^0=EL33\t34\t2\t24-05-06 00:00:01/00000032\t24-05-06 00:00:01/00000033\r"));
    for (std::uint32_t code = 100; code < 200; ++code) {
        printer.operate([code](auto& model, Instant now) { model.raise_error(code, now); });
    }
    EXPECT_TRUE(printer.send("^0?EL\r").starts_with("^0=EL1\t64\t32\t24-05-06 00:00:01/00000136\t"));
}

TEST(PrinterCounters, shouldSetProductAndStopAfterAndKeepWhatIsEmpty) {
    PrinterSettings settings;
    settings.total_prints = 500;
    Printer printer{settings};
    EXPECT_EQ(printer.send("^0?CC\r"), "^0=CC0\t0\t500\r");
    EXPECT_EQ(printer.send("^0=CC10\t20\t9999\r^0?CC\r"), "^0=CC10\t20\t500\r");
    EXPECT_EQ(printer.send("^0=CC\t30\r^0?CC\r"), "^0=CC10\t30\t500\r");
    EXPECT_EQ(printer.send("^0=CC11\r^0?CC\r"), "^0=CC11\t30\t500\r");
    EXPECT_EQ(printer.send("^0=CCx\t7\r^0?CC\r"), "^0=CC11\t30\t500\r");
    printer.fill(1, 2);
    printer.send("^0!GO\r");
    printer.products(2);
    EXPECT_EQ(printer.send("^0?CC\r"), "^0=CC13\t30\t502\r");
}

TEST(PrinterJobs, shouldLoadAJobAfterItsTimeAndStopNothing) {
    Printer printer;
    printer.rs();
    printer.fill(1, 5);
    printer.send("^0!GO\r");
    EXPECT_EQ(printer.send("^0=JLFFSDISK\\JOBS\\Other.job\r^0?JL\r"), "^0=JL\\FFSDISK\\JOBS\\Testprint.job\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t0\r");
    printer.wait(milliseconds{100});
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JLFFSDISK\\JOBS\\Other.job\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t1\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t0\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t4\t0\t0\t1\r");
}

TEST(PrinterJobs, shouldReadAPathWithSingleAndDoubledBackslashesAlike) {
    Printer printer;
    printer.send("^0=JLA\\\\B.job\r");
    printer.wait(milliseconds{100});
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JLA\\B.job\r");
    printer.operate([](auto& model, Instant now) { model.load_job("\\\\host\\^.job", now); });
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JL\\\\\\\\host\\\\\\^.job\r"); // would be read differently unescaped

    PrinterSettings settings;
    settings.habits.escaped_paths = true;
    Printer escaping{settings};
    EXPECT_EQ(escaping.send("^0?JL\r"), "^0=JL\\\\FFSDISK\\\\JOBS\\\\Testprint.job\r");
}

TEST(PrinterJobs, shouldFlagAJobTheOperatorLoaded) {
    Printer printer;
    printer.rs();
    printer.operate([](auto& model, Instant now) { model.load_job("X.job", now); });
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JLX.job\r");
}

TEST(PrinterJobs, shouldFlagChangesWithinTheJob) {
    PrinterSettings settings;
    settings.counters = {{1, 9, 0}};
    Printer printer{settings};
    printer.rs();
    const auto flag_after = [&printer](const char* frame) {
        printer.send(frame);
        const std::string told = printer.rs();
        EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t0\r") << "told once";
        return told.substr(told.rfind('\t') + 1);
    };
    EXPECT_EQ(flag_after("^0=PR2\t31000\r"), "1\r");
    EXPECT_EQ(flag_after("^0=PR2\t31000\r"), "0\r") << "the value that it has";
    EXPECT_EQ(flag_after("^0=CP1\t2\t99\r"), "1\r");
    EXPECT_EQ(flag_after("^0=CP7\t2\t99\r"), "0\r") << "the job has no such counter";
    EXPECT_EQ(flag_after("^0*BEGINLJSCRIPT\r"), "1\r") << "the job's file is deleted";
    EXPECT_EQ(flag_after("^0=MR1\ta\r^0=CC5\t9\r^0!RC\r"), "0\r") << "what is printed, not how";
}

TEST(PrinterPower, shouldLoseTheMailingButNoCounterInAPowerCycle) {
    PrinterSettings settings;
    settings.total_prints = 7;
    settings.echo_on = true;
    Printer printer{settings};
    printer.fill(1, 9);
    printer.send("^0=CM9\r^0!LN\r^0=FL40\r^0!GO\r");
    printer.products(3);
    printer.now += milliseconds{10};
    printer.model.print_go(printer.now);
    printer.operate([](auto& model, Instant now) { model.power_cycle(now); });
    EXPECT_THAT(printer.others, Contains(Effect{PrintAborted{printer.now, RecordNumber{4}}}));
    EXPECT_THAT(printer.others, Contains(Effect{ConnectionsLost{printer.now}}));
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(printer.send("^0?CC\r"), "^0=CC4\t0\t11\r");
}

TEST(PrinterPower, shouldSwitchLengthAndEchoOffInStandbyAndBlocksAtPowerOn) {
    Printer printer;
    printer.send("^0!LN\r^0!EM\r^0=FL40\r^0!PF\r");
    EXPECT_EQ(printer.rs(), "^0=RS0\t1\t0\t0\t0\t0\r" + std::string(23, ' '));
    printer.send("^0!PO\r");
    EXPECT_EQ(printer.rs(), "^0=RS0\t2\t0\t0\t9\t1\r");
}

TEST(PrinterVersions, shouldAnswerElevenStringsPerProfile) {
    for (const auto& [name, firmware, type] :
         {std::tuple{"jet3up", "V62.0.9.0", "JET3up"}, std::tuple{"jet3", "V60.0.25.0", "JET3"},
          std::tuple{"jet2neo", "V75.0.11.2", "JET2neo"}, std::tuple{"jet2neo-v71", "V71.0.22.00", "JET2neo"}}) {
        PrinterSettings settings;
        settings.profile = *protocol::profile_by_name(name);
        settings.serial_number = "4711";
        Printer printer{settings};
        const std::string answer = printer.send("^0?VS\r");
        EXPECT_EQ(std::count(answer.begin(), answer.end(), '\t'), 10) << name;
        EXPECT_TRUE(answer.ends_with(std::string{"\t"} + firmware + "\t" + type + "\t4711\r")) << answer;
    }
}

} // namespace
} // namespace linefeed::simulator::test
