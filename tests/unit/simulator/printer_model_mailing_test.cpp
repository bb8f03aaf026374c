// Mailing as the printer does it (protocol, section 5): the manual's own session, the FIFO, the numbering law, PrintGo
// and its 3 ms, the ends of a job.
#include "printer_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::simulator::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// "5043, print stop" and the like as they show in RS.
constexpr const char* buffer_empty_raw = "301994931";

TEST(PrinterMailing, shouldHoldTheManualsOwnSession) {
    Printer printer;
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r");
    EXPECT_EQ(printer.send("^0=CM100000\r^0?SM\r"), "^0=SM256\t0\t0\t100000\t1\r");
    printer.fill(22118, 22373);
    EXPECT_EQ(printer.sm(), "^0=SM256\t255\t0\t100000\t1\r");
    EXPECT_EQ(printer.send("^0!GO\r"), "");
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t0\r");
    printer.products(2);
    EXPECT_EQ(printer.sm(), "^0=SM256\t253\t22119\t100000\t1\r");

    std::uint32_t sent = 22373; // kept 250 ahead from here on, as the manual's 249 entries at 99 750 want it
    for (std::uint32_t printed = 22119; printed < 99750; ++printed) {
        if (sent < 100000) {
            ++sent;
            printer.fill(sent, sent);
        }
        printer.product();
    }
    EXPECT_EQ(printer.sm(), "^0=SM256\t249\t99750\t100000\t1\r");
    printer.products(122);
    EXPECT_EQ(printer.sm(), "^0=SM256\t127\t99872\t100000\t1\r");
    printer.products(78);
    EXPECT_EQ(printer.sm(), "^0=SM256\t49\t99950\t100000\t1\r");
    printer.products(46);
    EXPECT_EQ(printer.sm(), "^0=SM256\t3\t99996\t100000\t1\r");
    printer.products(4);
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t-1711274809\t0\t9\t0\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t100000\t0\t1\r");
    EXPECT_EQ(printer.tape.size(), 100000U - 22117U);
    EXPECT_EQ(printer.tape.front().number, RecordNumber{22118});
    EXPECT_EQ(printer.tape.back().text, "t100000");
    EXPECT_EQ(printer.product(), PrintGoOutcome::not_printing);
}

TEST(PrinterMailing, shouldCountTheLoadedRecordToTheDepthAndRefuseOneMore) {
    PrinterSettings settings;
    settings.depth = 3;
    Printer printer{settings};
    printer.fill(1, 1);
    EXPECT_EQ(printer.sm(), "^0=SM3\t0\t0\t0\t1\r");
    printer.fill(2, 3);
    EXPECT_EQ(printer.sm(), "^0=SM3\t2\t0\t0\t1\r");
    EXPECT_THAT(printer.error_codes(), IsEmpty());
    printer.fill(4, 4);
    EXPECT_EQ(printer.sm(), "^0=SM3\t2\t0\t0\t1\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t1375732727\t0\t9\t1\r"); // 0x520003F7: warning window, RIP, one tone, 1015
    EXPECT_EQ(printer.errors.back().error.display(), protocol::ErrorDisplay::warning);
}

TEST(PrinterMailing, shouldGoOnPrintingWhenTheFifoOverflowsAndStopAtTheGap) {
    PrinterSettings settings;
    settings.depth = 3;
    Printer printer{settings};
    printer.fill(1, 3);
    printer.send("^0!GO\r");
    printer.fill(4, 4);
    EXPECT_THAT(printer.error_codes(), ElementsAre(1015));
    EXPECT_EQ(printer.product(), PrintGoOutcome::printed);
    printer.fill(5, 5);
    printer.products(2);
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped);
    EXPECT_THAT(printer.error_codes(), ElementsAre(1015, 1019));
    EXPECT_THAT(printer.printed_numbers(), ElementsAre(1, 2, 3));
    EXPECT_EQ(printer.sm(), "^0=SM3\t0\t3\t0\t1\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t301990907\t0\t9\t1\r"); // 0x120003FB
}

TEST(PrinterMailing, shouldFollowTheManualsExampleOfNumbers) {
    Printer printer;
    for (const char* number : {"0", "0", "0", "0", "500", "501", "502", "503", "0", "100", "101", "102"}) {
        printer.send("^0=MR" + std::string{number} + "\tx\r");
    }
    printer.send("^0!GO\r");
    printer.products(12);
    EXPECT_THAT(printer.printed_numbers(), ElementsAre(0, 0, 0, 0, 500, 501, 502, 503, 0, 100, 101, 102));
    EXPECT_THAT(printer.error_codes(), IsEmpty());
}

TEST(PrinterMailing, shouldStopOnABreakDoubleOrStepBackOfNumbers) {
    for (const char* second : {"7", "5", "4"}) {
        Printer printer;
        printer.send("^0=MR5\ta\r^0=MR" + std::string{second} + "\tb\r^0!GO\r");
        EXPECT_EQ(printer.product(), PrintGoOutcome::printed);
        EXPECT_EQ(printer.product(), PrintGoOutcome::stopped) << second;
        EXPECT_THAT(printer.error_codes(), ElementsAre(1019)) << second;
        EXPECT_THAT(printer.printed_numbers(), ElementsAre(5)) << second;
    }
}

TEST(PrinterMailing, shouldTakeAnyNumberAfterTheFifoWasEmptyFlushedOrStopped) {
    Printer printer;
    printer.send("^0=MR5\ta\r^0!GO\r");
    printer.product();
    printer.send("^0=MR900\tb\r"); // the FIFO was empty
    printer.send("^0=MR77\tc\r");
    EXPECT_EQ(printer.product(), PrintGoOutcome::printed);
    printer.send("^0!FF\r^0=MR3\td\r");
    EXPECT_EQ(printer.product(), PrintGoOutcome::printed);
    printer.send("^0=MR4\te\r^0!ST\r^0=MR1000\tf\r^0!GO\r");
    EXPECT_EQ(printer.product(), PrintGoOutcome::printed);
    EXPECT_THAT(printer.printed_numbers(), ElementsAre(5, 900, 3, 1000));
}

TEST(PrinterMailing, shouldDemandALeadingZeroUnderTheLeadInLaw) {
    PrinterSettings settings;
    settings.habits.lead_in_law = true;
    Printer refused{settings};
    refused.send("^0=MR5\ta\r^0!GO\r");
    EXPECT_EQ(refused.product(), PrintGoOutcome::stopped);
    EXPECT_THAT(refused.error_codes(), ElementsAre(1019));

    Printer taken{settings};
    taken.send("^0=MR0\t\r^0=MR5\ta\r^0=MR6\tb\r^0!GO\r");
    taken.products(3);
    EXPECT_THAT(taken.printed_numbers(), ElementsAre(0, 5, 6));
}

TEST(PrinterMailing, shouldStopWhenTheNumberedFifoIsEmpty) {
    Printer printer;
    printer.send("^0=MR5\ta\r^0=CM9\r^0!GO\r");
    printer.product();
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped);
    EXPECT_EQ(printer.rs(), std::string{"^0=RS2\t5\t"} + buffer_empty_raw + "\t0\t9\t1\r"); // 0x12000000 | 5043
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t5\t0\t1\r");
    EXPECT_THAT(printer.others, Contains(Effect{Underrun{printer.now - milliseconds{2}, std::nullopt}}));
}

TEST(PrinterMailing, shouldWantTheRecordThreeMillisecondsBeforeThePrintGo) {
    Printer in_time;
    in_time.send("^0!GO\r^0=MR1\ta\r");
    EXPECT_EQ(in_time.product(milliseconds{3}), PrintGoOutcome::printed);
    EXPECT_EQ(in_time.tape.at(0).lead_time, Duration{milliseconds{3}});

    Printer late;
    late.send("^0=MR1\ta\r^0!GO\r");
    late.product();
    late.send("^0=MR2\tb\r");
    EXPECT_EQ(late.product(milliseconds{3} - Duration{1}), PrintGoOutcome::stopped);
    EXPECT_THAT(late.error_codes(), ElementsAre(5043));
    EXPECT_THAT(late.printed_numbers(), ElementsAre(1));
    EXPECT_EQ(late.sm(), "^0=SM256\t0\t1\t0\t1\r");
}

TEST(PrinterMailing, shouldPrintTheJobsOwnTextUntilTheFirstRecordIsThereInTime) {
    Printer printer;
    printer.send("^0!GO\r^0=MR1\ta\r");
    EXPECT_EQ(printer.product(milliseconds{3} - Duration{1}), PrintGoOutcome::printed);
    EXPECT_THAT(printer.others,
                Contains(Effect{Underrun{printer.now - milliseconds{2}, milliseconds{3} - Duration{1}}}));
    EXPECT_EQ(printer.product(), PrintGoOutcome::printed);
    ASSERT_EQ(printer.tape.size(), 2U);
    EXPECT_EQ(printer.tape[0].source, PrintSource::job);
    EXPECT_EQ(printer.tape[0].text, "Testprint");
    EXPECT_EQ(printer.tape[1].number, RecordNumber{1});
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped) << "from the first number on, the FIFO may not get empty";
    EXPECT_THAT(printer.error_codes(), ElementsAre(5043));
}

TEST(PrinterMailing, shouldTakeTheMarginFromTheSettings) {
    PrinterSettings settings;
    settings.margin = milliseconds{7};
    Printer printer{settings};
    printer.send("^0=MR1\ta\r^0!GO\r");
    printer.product();
    printer.send("^0=MR2\tb\r");
    EXPECT_EQ(printer.product(milliseconds{6}), PrintGoOutcome::stopped);
}

TEST(PrinterMailing, shouldPrintTheLastRecordAgainWhenItsNumberWasZero) {
    Printer printer;
    printer.send("^0=MR0\tsame\r^0!GO\r");
    printer.products(3);
    ASSERT_EQ(printer.tape.size(), 3U);
    EXPECT_EQ(printer.tape[2].text, "same");
    EXPECT_EQ(printer.tape[2].lead_time, std::nullopt);
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r");
    EXPECT_EQ(printer.send("^0?CC\r"), "^0=CC3\t0\t3\r");
    printer.send("^0=MR0\tnew\r");
    printer.product(milliseconds{1}); // too fresh: the old one once more
    printer.product();
    EXPECT_EQ(printer.tape[3].text, "same");
    EXPECT_EQ(printer.tape[4].text, "new");
    EXPECT_THAT(printer.error_codes(), IsEmpty());
}

TEST(PrinterMailing, shouldPrintTheLastRecordOfNumberZeroAgainAfterAStopButNotAfterAJobLoad) {
    Printer printer;
    printer.send("^0=MR0\tsame\r^0=MR0\tlost\r^0!GO\r");
    printer.product();
    printer.send("^0!ST\r^0!GO\r");
    printer.product();
    printer.operate([](auto& model, Instant now) { model.load_job("\\FFSDISK\\JOBS\\DM.JOB", now); });
    printer.product();
    ASSERT_EQ(printer.tape.size(), 3U);
    EXPECT_EQ(printer.tape[1].text, "same");
    EXPECT_EQ(printer.tape[2].text, "DM") << "the wildcards of the editor";
    EXPECT_THAT(printer.error_codes(), IsEmpty());
}

TEST(PrinterMailing, shouldStayNumberedOverAStopUntilAnotherJobIsLoaded) {
    Printer printer;
    printer.send("^0=MR5\ta\r^0!GO\r");
    printer.product();
    printer.send("^0!ST\r^0!GO\r");
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped) << "nothing with a number is printed twice";
    EXPECT_THAT(printer.error_codes(), ElementsAre(5043));
    printer.send("^0=JLFFSDISK\\JOBS\\DM.JOB\r^0!GO\r");
    printer.wait(milliseconds{100});
    EXPECT_EQ(printer.product(), PrintGoOutcome::printed);
    EXPECT_EQ(printer.tape.back().text, "DM");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t0\t0\t1\r") << "what was printed last has no number";
}

TEST(PrinterMailing, shouldCountNoPrintOfTheJobAsTheLeadingZero) {
    PrinterSettings settings;
    settings.habits.lead_in_law = true;
    Printer printer{settings};
    printer.send("^0!GO\r");
    printer.product();
    printer.send("^0=MR5\ta\r");
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped);
    EXPECT_THAT(printer.error_codes(), ElementsAre(1019));
}

TEST(PrinterExternText, shouldBePrintedAtEveryPrintGo) {
    Printer printer;
    printer.send("^0=ETHallo\r^0!GO\r");
    EXPECT_EQ(printer.product(), PrintGoOutcome::printed); // it takes 30 ms
    printer.wait(milliseconds{30});
    printer.products(2);
    printer.send("^0=ETWelt\r");
    printer.wait(milliseconds{30});
    printer.product();
    printer.send("^0=ET\r"); // the zero string
    printer.wait(milliseconds{30});
    printer.product();
    std::vector<std::string> texts;
    for (const Printed& print : printer.tape) {
        EXPECT_EQ(print.number, RecordNumber{});
        EXPECT_EQ(print.lead_time, std::nullopt);
        texts.push_back(print.text);
    }
    EXPECT_THAT(texts, ElementsAre("Testprint", "Hallo", "Hallo", "Welt", "Testprint"));
    EXPECT_EQ(printer.tape[1].source, PrintSource::extern_text);
    EXPECT_EQ(printer.send("^0?CC\r"), "^0=CC5\t0\t5\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t1\r");
}

TEST(PrinterExternText, shouldStandWhereTheLastRecordStood) {
    Printer printer;
    printer.send("^0=MR0\trecord\r^0!GO\r");
    printer.product();
    printer.send("^0=ETtext\r");
    printer.wait(milliseconds{30});
    printer.product();
    printer.send("^0=MR0\tagain a record\r");
    printer.products(2);
    ASSERT_EQ(printer.tape.size(), 4U);
    EXPECT_EQ(printer.tape[1].text, "text");
    EXPECT_EQ(printer.tape[3].text, "again a record");
}

TEST(PrinterExternText, shouldSaveNoNumberedRunButBeginAfterIt) {
    Printer printer;
    printer.send("^0=MR5\ta\r^0!GO\r");
    printer.product();
    printer.send("^0=ETtext\r");
    printer.wait(milliseconds{30});
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped);
    EXPECT_THAT(printer.error_codes(), ElementsAre(5043));
    printer.send("^0=ETtext\r^0!GO\r");
    printer.wait(milliseconds{30});
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped) << "it came while the printer was printing";
    printer.send("^0=ETtext\r");
    printer.wait(milliseconds{30});
    printer.send("^0!GO\r");
    EXPECT_EQ(printer.product(), PrintGoOutcome::printed);
    EXPECT_EQ(printer.tape.back().text, "text");
}

TEST(PrinterExternText, shouldWaitForTheJobThatItIsMeantFor) {
    Printer printer;
    printer.send("^0=JLFFSDISK\\JOBS\\DM.JOB\r^0=ETtext\r^0!GO\r");
    printer.wait(milliseconds{130});
    printer.product();
    EXPECT_EQ(printer.tape.back().text, "text");
    printer.operate([](auto& model, Instant now) { model.power_cycle(now); });
    printer.send("^0!GO\r");
    printer.product();
    EXPECT_EQ(printer.tape.back().text, "DM") << "the job is loaded anew";
}

TEST(PrinterScripts, shouldBePrintedWithoutAnyRecord) {
    Printer printer;
    printer.send("^0!GO\r^0*BEGINLJSCRIPT [()]\r^0*OBJ [1 0 0 0 (ISO1_7x5)  (Los (7) A) 1 0 ()]\r"
                 "^0*OBJ [2 0 0 0 (ISO1_7x5) () 1 0 ()]\r^0*OBJ[3 0 0 0 (ISO1_7x5) (B) 1]\r");
    printer.product();
    printer.send("^0*ENDLJSCRIPT []\r");
    printer.wait(milliseconds{100});
    printer.products(2);
    ASSERT_EQ(printer.tape.size(), 3U);
    EXPECT_EQ(printer.tape[0].text, "Testprint") << "the job that is loaded, until the script has ended";
    EXPECT_EQ(printer.tape[2].text, "Los (7) A\tB");
    EXPECT_THAT(printer.error_codes(), IsEmpty());
}

TEST(PrinterMailing, shouldRepeatOnlyRecordsOfNumberZero) {
    Printer printer;
    printer.send("^0=MR0\ttwice\t{hr2}\r^0=MR0\tonce\r^0=MR7\tnumbered\t{r3}\r^0=MR8\tnext\r^0!GO\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t3\t0\t0\t1\r");
    printer.product();
    EXPECT_EQ(printer.sm(), "^0=SM256\t3\t0\t0\t1\r"); // still loaded
    printer.products(4);
    ASSERT_EQ(printer.tape.size(), 5U);
    EXPECT_EQ(printer.tape[0].text, "twice");
    EXPECT_EQ(printer.tape[1].text, "twice");
    EXPECT_EQ(printer.tape[2].text, "once");
    EXPECT_EQ(printer.tape[3].text, "numbered");
    EXPECT_EQ(printer.tape[4].text, "next");
}

TEST(PrinterMailing, shouldStopAtTheTurnOfARecordWithoutReadableNumber) {
    for (const char* record : {"", "\ta", "x\ta", "007\ta", "4294967296\ta", "-1\ta"}) {
        Printer printer;
        printer.fill(1, 3);
        printer.send("^0!GO\r^0=MR" + std::string{record} + "\r^0=MR4\tb\r");
        EXPECT_EQ(printer.sm(), "^0=SM256\t4\t0\t0\t1\r") << record;
        printer.products(3);
        EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t1\r") << "numbers are checked during readout; " << record;
        EXPECT_EQ(printer.product(), PrintGoOutcome::stopped) << record;
        EXPECT_THAT(printer.error_codes(), ElementsAre(1018)) << record;
        EXPECT_EQ(printer.rs(), "^0=RS2\t5\t301990906\t0\t9\t0\r") << record;
        EXPECT_EQ(printer.sm(), "^0=SM256\t0\t3\t0\t1\r") << record;
    }
}

TEST(PrinterMailing, shouldTakeARecordWithoutNumberOnlyIfThereIsRoom) {
    PrinterSettings settings;
    settings.depth = 2;
    Printer printer{settings};
    printer.fill(1, 2);
    printer.send("^0=MRx\ta\r");
    EXPECT_THAT(printer.error_codes(), ElementsAre(1015));
    EXPECT_EQ(printer.sm(), "^0=SM2\t1\t0\t0\t1\r");
    printer.send("^0!GO\r");
    printer.products(2);
    printer.fill(3, 4); // in the places of those that were printed: none of them is without a number
    printer.products(2);
    EXPECT_THAT(printer.printed_numbers(), ElementsAre(1, 2, 3, 4));
}

TEST(PrinterMailing, shouldTruncateSilentlyWhatIsLongerThan2048Bytes) {
    Printer printer;
    printer.send("^0=MR1\t" + std::string(2046, 'a') + "\r^0=MR2\t" + std::string(3000, 'b') + "\r^0!GO\r");
    printer.products(2);
    ASSERT_EQ(printer.tape.size(), 2U);
    EXPECT_EQ(printer.tape[0].text.size(), 2046U);
    EXPECT_EQ(printer.tape[1].text, std::string(2046, 'b'));
    EXPECT_THAT(printer.error_codes(), IsEmpty());
}

TEST(PrinterMailing, shouldIgnoreFieldsBeyond255AndReadNulAsBlank) {
    Printer printer;
    std::string record = "^0=MR1";
    for (int field = 1; field <= 300; ++field) {
        record += "\t" + std::to_string(field);
    }
    using namespace std::string_literals;
    printer.send(record + "\r^0=MR2\ta\0b\r^0!GO\r"s);
    printer.products(2);
    ASSERT_EQ(printer.tape.size(), 2U);
    EXPECT_TRUE(printer.tape[0].text.ends_with("\t254\t255"));
    EXPECT_EQ(printer.tape[1].text, "a b");
}

TEST(PrinterMailing, shouldUndoEscapesUnlessTheFirmwareKnowsNone) {
    Printer newer;
    newer.send("^0=MR1\ta\\^b\\\\c\r^0!GO\r");
    newer.product();
    EXPECT_EQ(newer.tape.at(0).text, "a^b\\c");

    PrinterSettings settings;
    settings.profile = *protocol::profile_by_name("jet3");
    Printer older{settings};
    older.send("^0=MR1\tb\\\\c\r^0!GO\r");
    older.product();
    EXPECT_EQ(older.tape.at(0).text, "b\\\\c");
}

TEST(PrinterMailing, shouldReachTheLargestNumber) {
    Printer printer;
    printer.send("^0=MR4294967294\ta\r^0=MR4294967295\tb\r^0=MR0\tc\r^0=MR4294967295\td\r^0=MR1\te\r^0!GO\r");
    printer.products(4);
    EXPECT_THAT(printer.printed_numbers(), ElementsAre(4294967294, 4294967295, 0, 4294967295));
    EXPECT_EQ(printer.product(), PrintGoOutcome::stopped);
    EXPECT_THAT(printer.error_codes(), ElementsAre(1019));
}

TEST(PrinterMailing, shouldStopAtTheStopNumberOnlyWhenItsPrintHasFinished) {
    Printer printer;
    printer.fill(1, 5);
    printer.send("^0=CM2\r^0!GO\r");
    printer.product();
    printer.now += milliseconds{10};
    printer.model.print_go(printer.now);
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t1\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t2\t2\t2\t0\r");
    EXPECT_EQ(printer.model.next_event(), printer.now + milliseconds{1});
    printer.wait(milliseconds{1});
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t-1711274809\t0\t9\t0\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t2\t0\t1\r");
}

TEST(PrinterMailing, shouldShowWhetherTheLastPrintIsFinished) {
    Printer printer;
    printer.fill(1, 3);
    printer.send("^0!GO\r");
    printer.now += milliseconds{10};
    printer.model.print_go(printer.now);
    EXPECT_EQ(printer.sm(), "^0=SM256\t1\t1\t0\t0\r");
    printer.wait(milliseconds{1} - Duration{1});
    EXPECT_EQ(printer.sm(), "^0=SM256\t1\t1\t0\t0\r");
    printer.wait(Duration{1});
    EXPECT_EQ(printer.sm(), "^0=SM256\t1\t1\t0\t1\r");
}

TEST(PrinterMailing, shouldFinishTheRunningPrintAtAStop) {
    Printer printer;
    printer.fill(1, 3);
    printer.send("^0!GO\r");
    printer.now += milliseconds{10};
    printer.model.print_go(printer.now);
    EXPECT_EQ(printer.send("^0!ST\r^0?SM\r"), "^0=SM256\t0\t1\t0\t0\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
    printer.wait(milliseconds{1});
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t1\t0\t1\r");
}

TEST(PrinterMailing, shouldLeaveTheRunningPrintUnfinishedWhereAStopBreaksItOff) {
    PrinterSettings settings;
    settings.habits.abort_print_on_stop = true;
    Printer printer{settings};
    printer.fill(1, 3);
    printer.send("^0!GO\r");
    printer.now += milliseconds{10};
    printer.model.print_go(printer.now);
    printer.send("^0!ST\r");
    EXPECT_THAT(printer.others, Contains(Effect{PrintAborted{printer.now, RecordNumber{1}}}));
    printer.wait(seconds{5});
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t1\t0\t0\r");
    printer.send("^0=MR2\ta\r^0!GO\r");
    printer.product();
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t2\t0\t1\r");
}

TEST(PrinterMailing, shouldEmptyFifoAndStopNumberAtAnyStopButKeepTheLastNumber) {
    const auto filled = [] {
        Printer printer;
        printer.fill(1, 9);
        printer.send("^0=CM9\r^0!GO\r");
        printer.products(3);
        EXPECT_EQ(printer.sm(), "^0=SM256\t5\t3\t9\t1\r");
        return printer;
    };
    Printer by_host = filled();
    by_host.send("^0!ST\r");
    EXPECT_EQ(by_host.sm(), "^0=SM256\t0\t3\t0\t1\r");
    Printer by_operator = filled();
    by_operator.operate([](auto& model, Instant now) { model.press(protocol::Action::stop_print, now); });
    EXPECT_EQ(by_operator.sm(), "^0=SM256\t0\t3\t0\t1\r");
    Printer by_error = filled();
    by_error.operate([](auto& model, Instant now) { model.raise_error(12113, now); });
    EXPECT_EQ(by_error.sm(), "^0=SM256\t0\t3\t0\t1\r");
    Printer by_nozzle = filled();
    by_nozzle.send("^0!NC\r");
    EXPECT_EQ(by_nozzle.sm(), "^0=SM256\t0\t3\t0\t1\r");
}

TEST(PrinterMailing, shouldKeepWhatWasFilledWhenAStopFindsItNotPrinting) {
    Printer printer;
    printer.fill(1, 9);
    printer.send("^0=CM9\r^0!ST\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t8\t0\t9\t1\r");
}

TEST(PrinterMailing, shouldFlushTheFifoAndNothingElse) {
    Printer printer;
    printer.fill(1, 9);
    printer.send("^0=CM9\r^0!GO\r");
    printer.product();
    EXPECT_EQ(printer.send("^0!FF\r^0?SM\r"), "^0=SM256\t0\t1\t9\t1\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t6\t0\t0\t9\t1\r");
}

TEST(PrinterMailing, shouldStopAfterTheNumberOfProducts) {
    Printer printer;
    printer.fill(1, 9);
    printer.send("^0=CC10\t12\r^0!GO\r");
    printer.products(2);
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(printer.sm(), "^0=SM256\t0\t2\t0\t1\r");
    EXPECT_EQ(printer.send("^0?CC\r"), "^0=CC12\t12\t2\r");
}

TEST(PrinterMailing, shouldLetProductsPassWhenNotPrinting) {
    Printer printer;
    printer.fill(1, 3);
    EXPECT_EQ(printer.product(), PrintGoOutcome::not_printing);
    EXPECT_THAT(printer.tape, IsEmpty());
    EXPECT_EQ(printer.sm(), "^0=SM256\t2\t0\t0\t1\r");
}

} // namespace
} // namespace linefeed::simulator::test
