// The rest of the interface as the printer model has it: scripts, counters, inputs and outputs, the panel, the WYSIWYG
// picture, troubles on the line, firmware profiles (protocol, sections 2, 4 and 7).
#include "printer_fixture.hpp"
#include "protocol/wysiwyg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::simulator::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

PrinterSettings of_profile(std::string_view type, std::string_view firmware) {
    PrinterSettings settings;
    settings.profile = protocol::profile_for(type, firmware).value();
    return settings;
}

// --- scripts and jobs

TEST(PrinterScripts, shouldReplaceTheJobWhenTheyEnd) {
    Printer printer;
    printer.rs();
    EXPECT_THAT(printer.send("^0?JB\r"), HasSubstr("\r^0*OBJ [1 0 0 0 (ISO1_7x5) (Testprint)"));
    printer.send("^0*BEGINLJSCRIPT [()]\r^0*one \\^\\\\\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(printer.send("^0?JB\r"), "^0*BEGINLJSCRIPT\r^0*ENDLJSCRIPT\r") << "BEGIN deletes the current job";
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JL\\FFSDISK\\JOBS\\Testprint.job\r");
    printer.send("^0*two\r^0*ENDLJSCRIPT []\r^0*lost\r");
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JL\\FFSDISK\\JOBS\\Testprint.job\r");
    printer.wait(milliseconds{100});
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JLEXTERN\r");
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(printer.send("^0?JB\r"), "^0*BEGINLJSCRIPT\r^0*one \\^\\\\\r^0*two\r^0*ENDLJSCRIPT\r");
}

TEST(PrinterScripts, shouldBeCheckedLineByLineAndAnnouncedLineByLine) {
    Printer printer;
    const std::string begin = "^0*BEGINLJSCRIPT";
    // python3 -c 'import zlib; print(zlib.crc32(b"^0*BEGINLJSCRIPT"))'
    EXPECT_EQ(printer.send("^0=NR3942348305\r" + begin + "\r"), "^0!OK\r");
    EXPECT_EQ(printer.send("^0=NR1\r" + begin + "\r"), "^0=FC3942348305\r");
    const std::string job = printer.send("^0=NR207182728\r^0?JB\r"); // zlib.crc32(b"^0?JB")
    EXPECT_EQ(job.substr(0, 40), "^0!OK\r^0=NR3942348305\r^0*BEGINLJSCRIPT\r^");
    EXPECT_EQ(std::count(job.begin(), job.end(), '\r'), 1 + 2 * 2);
}

TEST(PrinterJobs, shouldLoadWhatWasUploaded) {
    Printer printer;
    printer.send("^0$FHFFSDISK\\Jobs\\new.job\t1\r");
    // "BEGINLJSCRIPT\r\nx\n\ny\rENDLJSCRIPT\r\n" is the job of the lines x and y
    std::string block;
    protocol::append_message(block, protocol::FileBlock::of(1, "BEGINLJSCRIPT\r\nx\n\ny\rENDLJSCRIPT\r\n"));
    EXPECT_EQ(printer.send(block), "^0$FA1\t1\r");
    printer.send("^0=JLnew.job\r");
    printer.wait(milliseconds{100});
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JLnew.job\r");
    EXPECT_EQ(printer.send("^0?JB\r"), "^0*BEGINLJSCRIPT\r^0*x\r^0*y\r^0*ENDLJSCRIPT\r");
}

TEST(PrinterJobs, shouldKeepTheOldOneForAMissingFileWithThatHabit) {
    PrinterSettings settings;
    settings.habits.missing_jobs_refused = true;
    Printer printer{settings};
    printer.send("^0=JLFFSDISK\\Jobs\\none.job\r");
    printer.wait(milliseconds{100});
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JL\\FFSDISK\\JOBS\\Testprint.job\r");
    printer.send("^0=JLFFSDISK\\Jobs\\DM.JOB\r");
    printer.wait(milliseconds{100});
    EXPECT_EQ(printer.send("^0?JL\r"), "^0=JLFFSDISK\\Jobs\\DM.JOB\r");
}

// --- counters

PrinterSettings with_counters() {
    PrinterSettings settings;
    settings.counters = {{8, 10, 0}, {3, 1, 2}};
    return settings;
}

void print(Printer& printer, std::uint32_t first, std::uint32_t last) {
    printer.fill(first, last);
    printer.send("^0!GO\r");
    printer.products(static_cast<int>(last - first + 1));
}

TEST(PrinterJobCounters, shouldCountUpAndDownWithRepetitions) {
    Printer printer{with_counters()};
    EXPECT_EQ(printer.send("^0?AC\r"), "^0=AC2\t1\t0\t8\t1\t0\t3\r");
    print(printer, 1, 1);
    EXPECT_EQ(printer.send("^0?AC\r"), "^0=AC2\t1\t0\t9\t2\t0\t3\r");
    print(printer, 2, 3);
    EXPECT_EQ(printer.send("^0?AC\r"), "^0=AC2\t1\t0\t8\t2\t0\t2\r") << "the first has begun anew";
}

TEST(PrinterJobCounters, shouldTakeNewLimitsAtTheEndOnlyAndForgetThemWithTheJob) {
    Printer printer{with_counters()};
    printer.send("^0=CP1\t1\t20\r^0=CP1\t2\t21\r^0=CP3\t1\t5\r");
    EXPECT_EQ(printer.send("^0?CP\r"), "^0=CP1\t1\t8\r^0=CP1\t2\t10\r^0=CP2\t1\t3\r^0=CP2\t2\t1\r");
    print(printer, 1, 3);
    EXPECT_EQ(printer.send("^0?CP1\r"), "^0=CP1\t1\t20\r^0=CP1\t2\t21\r");
    EXPECT_THAT(printer.send("^0?AC\r"), HasSubstr("AC2\t1\t0\t20\t"));
    printer.send("^0=JLDM.JOB\r");
    printer.wait(milliseconds{100});
    EXPECT_EQ(printer.send("^0?CP1\t2\r"), "^0=CP1\t2\t10\r");
    EXPECT_EQ(printer.send("^0?CP9\r"), "");
}

TEST(PrinterJobCounters, shouldBeSetBackOneOrAll) {
    Printer printer{with_counters()};
    print(printer, 1, 2);
    printer.send("^0=RC1\t9999999999\r");
    EXPECT_EQ(printer.send("^0?AC\r"), "^0=AC2\t1\t2\t1410065407\t1\t0\t2\r");
    printer.send("^0=RC1\t-1\r");
    EXPECT_EQ(printer.send("^0?AC\r"), "^0=AC2\t1\t0\t8\t1\t0\t2\r");
    printer.send("^0=RC0\t7\r");
    EXPECT_EQ(printer.send("^0?AC\r"), "^0=AC2\t1\t0\t7\t1\t0\t7\r");
    printer.send("^0=RC\r^0=RC1\t-2\r");
    EXPECT_EQ(printer.send("^0?AC\r"), "^0=AC2\t1\t0\t7\t1\t0\t7\r");
}

TEST(PrinterJobCounters, shouldTakeNoLimitsOnOtherFirmware) {
    PrinterSettings settings = of_profile("JET3up", "V62.0.6.0");
    settings.counters = {{1, 1, 0}};
    Printer printer{settings};
    printer.send("^0=CP1\t1\t20\r");
    print(printer, 1, 1);
    EXPECT_EQ(printer.send("^0?AC\r^0?CP\r"), "^0=AC1\t1\t0\t1\r");
}

// --- inputs, outputs, panel

TEST(PrinterInputs, shouldShowInTheirBitsAndDoWhatTheyAreConfiguredFor) {
    using protocol::Input;
    using protocol::InputFunction;
    PrinterSettings settings = with_counters();
    settings.inputs.functions = {InputFunction::print_start,     InputFunction::print_stop,
                                 InputFunction::nozzle_close,    InputFunction::nozzle_open,
                                 InputFunction::counter_reset_1, InputFunction::shutdown};
    Printer printer{settings};
    const auto pulse = [&printer](Input input) {
        printer.operate([input](auto& model, Instant now) { model.set_input(input, true, now); });
        const std::string states = printer.send("^0?EX\r");
        printer.operate([input](auto& model, Instant now) { model.set_input(input, false, now); });
        return states;
    };
    EXPECT_EQ(printer.send("^0?IC\r"), "^0=IC3\t4\t2\t1\t8\t5\r");
    EXPECT_THAT(pulse(Input::x4_9), HasSubstr("=EX9\t1\t"));
    EXPECT_TRUE(printer.model.printing());
    EXPECT_THAT(pulse(Input::x4_22), HasSubstr("=EX9\t2\t"));
    EXPECT_FALSE(printer.model.printing());
    EXPECT_THAT(pulse(Input::x4_2), HasSubstr("=EX9\t64\t")); // increments
    EXPECT_THAT(printer.send("^0?AC\r"), HasSubstr("AC2\t1\t0\t9\t2\t0\t3"));
    pulse(Input::x4_11);
    EXPECT_THAT(printer.send("^0?AC\r"), HasSubstr("AC2\t1\t0\t8\t2\t0\t3"));
    EXPECT_THAT(pulse(Input::x4_1), HasSubstr("=EX9\t128\t"));
    EXPECT_THAT(printer.send("^0?AC\r"), HasSubstr("AC2\t1\t0\t8\t1\t0\t3"));
    EXPECT_THAT(pulse(Input::x4_20), HasSubstr("=EX9\t131072\t"));
    pulse(Input::x4_10);
    EXPECT_THAT(printer.rs(), HasSubstr("=RS3\t4"));
    printer.wait(seconds{10});
    pulse(Input::x4_23);
    EXPECT_THAT(printer.rs(), HasSubstr("=RS1\t4"));
    printer.operate([](auto& model, Instant now) { model.set_input(Input::x4_24, true, now); });
    EXPECT_THAT(printer.rs(), HasSubstr("=RS0\t1"));
}

TEST(PrinterOutputs, shouldSignalUntilTheHostTakesThemAndAfterItGivesThemBack) {
    Printer printer;
    EXPECT_TRUE(printer.model.output(3)) << "print readiness";
    printer.operate([](auto& model, Instant now) { model.raise_error(10202, now); });
    EXPECT_TRUE(printer.model.output(2)) << "error";
    printer.send("^0=CO0\t1\r");
    EXPECT_FALSE(printer.model.output(2)) << "no signals while the host is in control";
    printer.send("^0=CO8\t1\r");
    EXPECT_TRUE(printer.model.output(8));
    printer.send("^0=CO0\t0\r");
    EXPECT_TRUE(printer.model.output(2));
    EXPECT_FALSE(printer.model.output(8)) << "undone";
    printer.send("^0!EQ\r^0=MR1\ta\r^0!GO\r");
    printer.now += milliseconds{10};
    printer.model.print_go(printer.now);
    EXPECT_TRUE(printer.model.output(4)) << "print active";
}

TEST(PrinterOutputs, shouldNotBeTheHostsOnAJet2neo) {
    Printer printer{of_profile("JET2neo", "V75.0.11.2")};
    printer.send("^0=CO0\t1\r^0=CO1\t1\r");
    EXPECT_TRUE(printer.model.output(3));
    EXPECT_FALSE(printer.model.output(1));
    EXPECT_EQ(printer.send("^0?IC\r^0?OC\r"), "^0=IC0\t0\t0\r^0=OC1\t2\t3\t4\r");
}

TEST(PrinterPanel, shouldBeBlockedAsLongAsTheHostKeepsTalking) {
    Printer printer;
    const auto start = [&printer] {
        printer.operate([](auto& model, Instant now) { model.press(protocol::Action::start_print, now); });
        const bool printing = printer.model.printing();
        printer.send("^0!ST\r");
        return printing;
    };
    printer.send("^0!US\r");
    EXPECT_FALSE(start());
    printer.wait(seconds{9});
    printer.rs();
    printer.wait(seconds{9});
    EXPECT_FALSE(start());
    printer.wait(seconds{10});
    EXPECT_TRUE(start());
    printer.rs();
    EXPECT_FALSE(printer.model.panel_blocked()) << "talking does not block it again";
    printer.send("^0!US\r^0!UR\r");
    EXPECT_TRUE(start());
}

TEST(PrinterMotor, shouldStepWhileTheMachineIsReady) {
    PrinterSettings settings;
    settings.power_up = PowerUpState::nozzle_closed;
    Printer printer{settings};
    printer.send("^0!MC\r");
    EXPECT_THAT(printer.rs(), HasSubstr("=RS4\t4"));
    printer.send("^0!MO\r");
    EXPECT_THAT(printer.rs(), HasSubstr("=RS5\t4"));
    EXPECT_THAT(printer.send("^0?MS\r"), HasSubstr("\t5\t0\t0\r"));
    printer.send("^0!MC\r");
    EXPECT_THAT(printer.rs(), HasSubstr("=RS4\t4"));
    Printer printing;
    printing.send("^0!GO\r^0!MO\r^0!MC\r");
    EXPECT_THAT(printing.rs(), HasSubstr("=RS2\t6"));
}

// --- lists

TEST(PrinterEvents, shouldNoteEachChangeOfTheMachineInBlocksOf16) {
    PrinterSettings settings;
    settings.clock_at_zero = std::chrono::sys_days{std::chrono::year{2024} / 5 / 6};
    Printer printer{settings};
    for (int i = 0; i < 8; ++i) {
        printer.send("^0!GO\r^0!ST\r");
    }
    const std::string events = printer.send("^0?EV\r");
    EXPECT_THAT(events, ::testing::StartsWith("^0=EV1\t17\t16\t24-05-06 00:00:01/30/1/4/12/2400/1000/7100/5\t"
                                              "24-05-06 00:00:01/30/1/4/12/2400/1000/7100/6\t"));
    EXPECT_THAT(events, ::testing::EndsWith("\r^0=EV17\t17\t1\t24-05-06 00:00:01/30/1/4/12/2400/1000/7100/5\r"));
}

// --- WYSIWYG

protocol::WysiwygImage picture(Printer& printer) {
    const std::string answer = printer.send("^0?GW\r");
    protocol::FrameDecoder decoder;
    std::string_view rest = answer;
    protocol::WysiwygAssembly assembly;
    bool ended = false;
    for (auto result = decoder.next(rest); !std::holds_alternative<std::monostate>(result);
         result = decoder.next(rest)) {
        const auto message =
            protocol::parse_message(std::get<protocol::Frame>(result), protocol::EscapeMode::backslash);
        if (const auto* line = std::get_if<protocol::WysiwygLine>(&message)) {
            EXPECT_FALSE(ended);
            assembly.add(*line);
        } else {
            ended = message == protocol::Message{protocol::ActionMessage{protocol::Action::end_of_data}};
        }
    }
    EXPECT_TRUE(ended);
    return assembly.image().value();
}

TEST(PrinterPicture, shouldShowTheRecordThatIsLoaded) {
    Printer printer;
    printer.send("^0=MR1\tI\t(12 4 FF0F01080108FF0F)\r");
    const auto image = picture(printer);
    EXPECT_EQ(image.height, 12U);
    EXPECT_EQ(image.width, 6U + 3U + 4U);
    EXPECT_EQ(image.delivered(), image.width);
    // The strokes of an I, 7 dots high, a distance, and the rectangle.
    const std::string expected{"\x00\x00\x41\x00\x7F\x00\x41\x00\x00\x00\x00\x00"
                               "\x00\x00\x00\x00\x00\x00"
                               "\xFF\x0F\x01\x08\x01\x08\xFF\x0F",
                               26};
    EXPECT_EQ(image.strokes, expected);
}

TEST(PrinterPicture, shouldScrollAndDeliverADetail) {
    Printer printer;
    printer.send("^0=MR1\t" + std::string(100, 'x') + "\xE4\r");
    auto image = picture(printer);
    EXPECT_EQ(image.width, 606U);
    EXPECT_EQ(image.delivered(), 400U);
    printer.send("^0=SW600\r");
    image = picture(printer);
    EXPECT_EQ(image.width, 606U);
    EXPECT_EQ(image.strokes, (std::string{"\x7F\x41\x41\x41\x7F\x00", 6})) << "a box for what the font has not";
    printer.send("^0=SW4294967295\r");
    EXPECT_EQ(picture(printer).delivered(), 0U);
}

TEST(PrinterPicture, shouldShowAGraphicWithinAText) {
    Printer printer;
    printer.send("^0=MR1\tI(8 3 FF81FF)(I\r");
    const auto image = picture(printer);
    EXPECT_EQ(image.height, 8U);
    EXPECT_EQ(image.width, 6U + 3U + 2U * 6U);
    EXPECT_EQ(image.strokes.substr(6, 3), "\xFF\x81\xFF");
}

TEST(PrinterPicture, shouldShowExternTextOrJobWithoutARecord) {
    Printer printer;
    EXPECT_EQ(picture(printer).width, 6 * std::string{"Testprint"}.size());
    printer.send("^0=ETHi\r");
    printer.wait(milliseconds{30});
    EXPECT_EQ(picture(printer).width, 12U);
    printer.send("^0=MR0\tabc\r^0!GO\r");
    printer.product();
    EXPECT_EQ(picture(printer).width, 18U) << "it will be printed again";
    printer.operate([](auto& model, Instant now) { model.load_job("none", now); });
    EXPECT_EQ(picture(printer).width, 24U) << "the name of a job without texts";
}

// --- troubles and profiles

TEST(PrinterTroubles, shouldHappenAtTheNextOccasionAndNotAgain) {
    Printer printer;
    printer.model.expect(Trouble::lost_answer, 2);
    EXPECT_EQ(printer.send("^0?SM\r^0?SM\r^0?DS\r"), "^0=DS24576\r");
    printer.model.expect(Trouble::damaged_answer, 1);
    EXPECT_EQ(printer.send("^0?DS\r^0?DS\r"), "^0=DS34576\r^0=DS24576\r");
    printer.model.expect(Trouble::wrong_crc, 1);
    const std::string right = "^0!OK\r^0=NR3560773416\r^0=JL\\FFSDISK\\JOBS\\Testprint.job\r";
    EXPECT_EQ(printer.send("^0?DS\r"), "^0=DS24576\r") << "no occasion";
    EXPECT_EQ(printer.send("^0=NR3957421711\r^0?JL\r"),
              "^0!OK\r^0=NR1560773416\r^0=JL\\FFSDISK\\JOBS\\Testprint.job\r");
    EXPECT_EQ(printer.send("^0=NR3957421711\r^0?JL\r"), right);
    printer.model.expect(Trouble::refused_crc, 1);
    EXPECT_EQ(printer.send("^0=NR3957421711\r^0?JL\r"), "^0=FC337545584\r");
    EXPECT_EQ(printer.send("^0=NR3957421711\r^0?JL\r"), right);
    printer.model.expect(Trouble::damaged_block, 1);
    const std::string damaged = printer.send("^0$RFFFSDISK\\Jobs\\DM.JOB\r");
    EXPECT_NE(damaged.substr(damaged.find("^0$FT")), printer.send("^0$FA1\t0\r"));
    printer.model.expect(Trouble::refused_block, 1);
    EXPECT_EQ(printer.send("^0$FHx.job\t1\r^0$FT1\t0\t\r"), "^0$FA1\t0\r");
}

TEST(PrinterProfiles, shouldTakePropertiesForAFieldOnOldFirmware) {
    Printer old{of_profile("JET3", "V60.0.1.17")};
    old.send("^0=MR0\ta\t{ho2r3}\r^0!GO\r");
    old.products(2);
    ASSERT_EQ(old.tape.size(), 2U);
    EXPECT_EQ(old.tape.front().text, "a\t{ho2r3}");
    Printer newer{of_profile("JET3", "V60.0.1.22")};
    newer.send("^0=MR0\ta\t{ho2r3}\r^0!GO\r");
    newer.products(1);
    EXPECT_EQ(newer.tape.front().text, "a");
}

TEST(PrinterProfiles, shouldShowSpeedsInMetresOnOldFirmware) {
    PrinterSettings settings = of_profile("JET2neo", "V71.0.00.11");
    settings.speed = 300;
    settings.firmware = "V71.0.00.11";
    Printer printer{settings};
    EXPECT_EQ(printer.rs(), "^0=RS2\t5\t0\t0\t30\t1\r");
    EXPECT_THAT(printer.send("^0?VS\r"), HasSubstr("\tV71.0.00.11\tJET2neo\t"));
}

TEST(PrinterReset, shouldBringTheFactorysSettingsBack) {
    Printer printer;
    printer.send("^0=PR4\t50\r^0=SW5\r^0!W0\r^0=CO0\t1\r^0!FA\r");
    EXPECT_EQ(printer.send("^0?PR4\r"), "^0=PR4\t100\r");
    EXPECT_TRUE(printer.model.display_on());
    EXPECT_TRUE(printer.model.output(3));
}

} // namespace
} // namespace linefeed::simulator::test
