// The examples and vectors of the manual, section by section: what it shows is what comes out and what is understood.
#include "parsing.hpp"
#include "protocol/crc32.hpp"
#include "protocol/frame_encoder.hpp"
#include "protocol/graphic.hpp"
#include "protocol/printer_time.hpp"

#include <gmock/gmock.h>

#include <array>

namespace linefeed::protocol {
namespace {

using ::testing::ElementsAre;

TEST(Reference1Frame, shouldHoldTheVectorOfTheLength) {
    const std::string_view without = "^0=RS2\t6\t0\t0\t0\r";
    EXPECT_EQ(std::string_view{"=RS2\t6\t0\t0\t0\r"}.size(), 13U);
    EXPECT_EQ(parsed_as<MachineStatus>("^000013=RS2\t6\t0\t0\t0\r"), parsed_as<MachineStatus>(without));
    std::string out;
    append_frame_with_length(out, Group::parameter, "RS2\t6\t0\t0\t0");
    EXPECT_EQ(out, "^000013=RS2\t6\t0\t0\t0\r");
}

TEST(Reference4Parameters, shouldHoldTheExampleOfTheClock) {
    const auto clock = parsed_as<ClockTime>("^0=DL2015\t10\t1\t26\t7\t45\t23\r");
    EXPECT_EQ(clock, (ClockTime{{2015, 10, 26, 7, 45, 23}, 1}));
    EXPECT_EQ(weekday_of(to_sys_seconds(clock.time).value()), clock.weekday) << "a Monday";
}

TEST(Reference4Parameters, shouldHoldTheExamplesOfTheOutputs) {
    EXPECT_TRUE(parsed_as<OutputChange>("^0=CO0\t1\r").is_control());
    EXPECT_EQ(parsed_as<OutputChange>("^0=CO0\t0\r"), (OutputChange{0, false}));
    EXPECT_EQ(parsed_as<OutputChange>("^0=CO3\t1\r"), (OutputChange{3, true}));
}

TEST(Reference4Parameters, shouldHoldTheExamplesOfTheCounterParameters) {
    EXPECT_EQ(parsed_as<CounterParameter>("^0=CP2\t1\t4\r"), (CounterParameter{2, CounterLimit::start, 4}));
    EXPECT_EQ(parsed_as<CounterParameter>("^0=CP3\t2\t9999\r"), (CounterParameter{3, CounterLimit::end, 9999}));
}

TEST(Reference4Parameters, shouldHoldTheExamplesOfTheExternText) {
    EXPECT_EQ(parsed_as<ExternText>("^0=ETHallo\r").text, "Hallo");
    EXPECT_EQ(parsed_as<ExternText>("^0=ET(8 3 FF81FF)\r").text, "(8 3 FF81FF)");
    EXPECT_EQ(parsed_as<ExternText>("^0=ETHallo(8 3 FF81FF)\r").text, "Hallo(8 3 FF81FF)");
}

TEST(Reference4Parameters, shouldHoldTheExampleOfAPartOfTheHydraulicState) {
    const auto state = parsed_as<HydraulicState>("^0=HS7100\t2400\r");
    EXPECT_EQ(state.fall_time_ms, 7100U);
    EXPECT_EQ(state.pressure_mbar, 2400U);
    EXPECT_EQ(state.mix_value, std::nullopt);
}

TEST(Reference4Parameters, shouldHoldTheExampleOfThePrintParameters) {
    EXPECT_EQ(parsed_as<PrintParameter>("^0=PR2\t31000\r"),
              (PrintParameter{PrintParameterType::print_go_distance, 31000}));
}

TEST(Reference4Parameters, shouldHoldTheVectorOfTheErrorNumber) {
    const PrinterError error{-1711274809};
    EXPECT_EQ(static_cast<std::uint32_t>(error.raw), 0x9A0004C7U);
    EXPECT_EQ(error.code(), 1223U);
    EXPECT_EQ(error.source(), ErrorSource::rip);
    EXPECT_FALSE(error.switches_off());
    EXPECT_EQ(error.tone(), ErrorTone::once);
    EXPECT_EQ(error.display(), ErrorDisplay::message);
    EXPECT_EQ(describe(error), "1223 (last data base entry printed), message from RIP");
}

TEST(Reference4Parameters, shouldHoldTheExampleOfAJobToLoad) {
    EXPECT_EQ(parsed_as<JobName>("^0=JLFFSDISK\\JOBS\\TESTPRINT.JOB\r").path, "FFSDISK\\JOBS\\TESTPRINT.JOB");
}

TEST(Reference5Mailing, shouldHoldTheExamplesOfTheRecord) {
    const auto record = parsed_as<MailRecord>("^0=MR17\tMiss\tJane\tMiller\t{ho2r3}\r");
    EXPECT_EQ(record.number, RecordNumber{17});
    EXPECT_THAT(record.fields, ElementsAre("Miss", "Jane", "Miller"));
    EXPECT_EQ(record.properties, (RecordProperties{true, Orientation::degrees_180, 3}));
    EXPECT_EQ(parsed_as<MailRecord>("^0=MR0\ttext1\t{ho2r3}\r").properties, record.properties);
    const auto repeated = parsed_as<MailRecord>("^0=MR0\ttext2\ttext3\t{r21}\r");
    EXPECT_THAT(repeated.fields, ElementsAre("text2", "text3"));
    EXPECT_EQ(repeated.properties, (RecordProperties{false, std::nullopt, 21}));
}

TEST(Reference5Mailing, shouldHoldTheExamplesOfTheGraphic) {
    const auto record = parsed_as<MailRecord>("^0=MR0\t111\t(8 3 FF81FF)\r");
    const auto graphic = parse_graphic(record.fields.at(1));
    ASSERT_TRUE(graphic);
    EXPECT_EQ(graphic->height, 8U);
    EXPECT_EQ(graphic->width, 3U);
    EXPECT_TRUE(graphic->dot(1, 0) && graphic->dot(1, 7) && !graphic->dot(1, 1));

    const auto rectangle = parse_graphic("(12 4 FF0F01080108FF0F)");
    ASSERT_TRUE(rectangle);
    for (std::uint32_t x = 0; x < 4; ++x) {
        for (std::uint32_t y = 0; y < 12; ++y) {
            EXPECT_EQ(rectangle->dot(x, y), x == 0 || x == 3 || y == 0 || y == 11) << x << " " << y;
        }
    }
}

TEST(Reference5Mailing, shouldHoldTheExampleOfUnicode) {
    std::string out;
    const MailRecordEncoder encoder{{Charset::unicode_hex}, EscapeMode::backslash};
    ASSERT_TRUE(encoder.append(out, RecordNumber{1}, std::array{std::string_view{"Hello World"}}));
    EXPECT_EQ(out, "^0=MR1\t00480065006C006C006F00200057006F0072006C0064\r");
}

TEST(Reference5Mailing, shouldUnderstandEveryAnswerOfTheManualsSession) {
    for (const auto& [frame, entries, printed, stop_at] :
         {std::tuple{"^0=SM256\t0\t0\t0\t1\r", 0U, 0U, 0U}, std::tuple{"^0=SM256\t0\t0\t100000\t1\r", 0U, 0U, 100000U},
          std::tuple{"^0=SM256\t255\t0\t100000\t1\r", 255U, 0U, 100000U},
          std::tuple{"^0=SM256\t253\t22119\t100000\t1\r", 253U, 22119U, 100000U},
          std::tuple{"^0=SM256\t198\t22175\t100000\t1\r", 198U, 22175U, 100000U},
          std::tuple{"^0=SM256\t249\t22219\t100000\t1\r", 249U, 22219U, 100000U},
          std::tuple{"^0=SM256\t249\t99750\t100000\t1\r", 249U, 99750U, 100000U},
          std::tuple{"^0=SM256\t127\t99872\t100000\t1\r", 127U, 99872U, 100000U},
          std::tuple{"^0=SM256\t49\t99950\t100000\t1\r", 49U, 99950U, 100000U},
          std::tuple{"^0=SM256\t3\t99996\t100000\t1\r", 3U, 99996U, 100000U},
          std::tuple{"^0=SM256\t0\t100000\t0\t1\r", 0U, 100000U, 0U}}) {
        EXPECT_EQ(parsed_as<MailStatus>(frame),
                  (MailStatus{256, entries, RecordNumber{printed}, RecordNumber{stop_at}, true, std::nullopt}));
        EXPECT_EQ(rewritten(frame), frame);
    }
    EXPECT_EQ(rewritten("^0=RS2\t5\t0\t0\t9\t1\r"), "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(rewritten("^0=RS2\t5\t-1711274809\t0\t9\t0\r"), "^0=RS2\t5\t-1711274809\t0\t9\t0\r");
    EXPECT_EQ(rewritten("^0=CM100000\r"), "^0=CM100000\r");
    EXPECT_EQ(parsed_as<MailRecord>("^0=MR22119\tMail\xE4nder\r").fields.at(0), "Mail\xE4nder");
}

TEST(Reference6Crc, shouldHoldTheVectors) {
    EXPECT_EQ(crc32("^0?JL"), 3957421711U);
    EXPECT_EQ(crc32("^0=JL\\FFSDISK\\JOBS\\Testprint.job"), 3560773416U);
    EXPECT_EQ(parsed_as<NextCrc>("^0=NR3957421711\r").crc, crc32("^0?JL"));
    EXPECT_EQ(parsed_as<CrcFailed>("^0=FC3560773416\r").crc, 3560773416U);
    EXPECT_EQ(encoded(NextCrc{3957421711}), "^0=NR3957421711\r");
}

TEST(Reference7Scripts, shouldKnowBothEnds) {
    EXPECT_TRUE(parsed_as<ScriptLine>("^0*BEGINLJSCRIPT\r").is_begin());
    EXPECT_TRUE(parsed_as<ScriptLine>("^0*ENDLJSCRIPT\r").is_end());
}

TEST(Reference8Files, shouldHoldTheExamplesOfTheDirectories) {
    EXPECT_EQ(parsed_as<DirectoryRequest>("^0$RDFFSDISK\\Jobs\r").path, "FFSDISK\\Jobs");
    EXPECT_EQ(parsed_as<DirectoryBlock>("^0$DI1\t01\t!Jobs\r"), (DirectoryBlock{true, {{"Jobs", true}}}));
    EXPECT_EQ(parsed_as<DirectoryBlock>("^0$DI1\t00\r"), (DirectoryBlock{true, {}}));
    EXPECT_EQ(encoded(DirectoryBlock{}), "^0$DI1\t00\r");
    EXPECT_EQ(parsed_as<DirectoryRequest>("^0$RDFFSDISK\\Jobs*\r").path, "FFSDISK\\Jobs*");
    const std::string jobs = "^0$DI1\t06\tCOUNTER.JOB\tDATE.JOB\tDM.JOB\tTestprint.job\tLINIE.job\tLJ24 Test.job\r";
    const auto listed = parsed_as<DirectoryBlock>(jobs);
    EXPECT_EQ(listed.entries.size(), 6U);
    EXPECT_EQ(listed.entries.back(), (DirectoryEntry{"LJ24 Test.job", false}));
    EXPECT_EQ(encoded(listed), jobs);
    EXPECT_EQ(parsed_as<DirectoryBlock>("^0$DI1\t09\tISO1_5x5.lft\tISO1_7x5.lft\tISO1_9x7.lft\tISO1_12x8.lft\t"
                                        "ISO1_14x10.lft\tISO1_16x10.lft\tISO1_24x18.lft\tISO1_32x20.lft\t"
                                        "ISO1_5x7flue.lft\r")
                  .entries.size(),
              9U);
}

TEST(Reference8Files, shouldHoldTheExampleOfAFileRequest) {
    EXPECT_EQ(parsed_as<FileRequest>("^0$RFFFSDISK\\Jobs\\MyJob1.job\r").path, "FFSDISK\\Jobs\\MyJob1.job");
    EXPECT_EQ(encoded(FileRequest{"FFSDISK\\Jobs\\MyJob1.job"}, EscapeMode::none), "^0$RFFFSDISK\\Jobs\\MyJob1.job\r");
}

TEST(Reference9Contradictions, shouldReadPathsWithSingleAndDoubledBackslashesAlike) {
    EXPECT_EQ(parsed_as<JobName>("^0=JL\\\\FFSDISK\\\\JOBS\\\\a.job\r"),
              parsed_as<JobName>("^0=JL\\FFSDISK\\JOBS\\a.job\r"));
    EXPECT_EQ(parsed_as<FileDeletion>("^0$DFA\\\\b\\^.job\r").path, "A\\b^.job");
}

} // namespace
} // namespace linefeed::protocol
