// Jobs loaded with proof, and scripts both ways.
#include "printer/job_commands.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::printer {
namespace {

using protocol::EscapeMode;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string ready = "^0=RS2\t5\t0\t0\t9\t1\r";
const std::string printing = "^0=RS2\t6\t0\t0\t9\t1\r";

TEST(LoadJob, shouldLoadAndReadBack) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_EQ(load_job(*client, "FFSDISK\\Jobs\\DM.JOB").value(), "FFSDISK\\Jobs\\DM.JOB");
    EXPECT_EQ(load_job(*client, "FFSDISK\\Jobs\\dm.job").value(), "FFSDISK\\Jobs\\dm.job")
        << "once more, after editing";
    EXPECT_EQ(load_job(*client, "FFSDISK\\Jobs\\None.job").error().kind, FailureKind::input);
    EXPECT_EQ(load_job(*client, "FFSDISK\\Jobs").error().kind, FailureKind::input);
}

TEST(LoadJob, shouldNotBeDoneWhileThePrinterPrints) {
    Peer busy{[](std::string_view frame) { return Peer::Reaction{frame == "^0?RS" ? printing : ""}; }};
    const auto client = PrinterClient::connect(busy.settings()).value();
    EXPECT_EQ(load_job(*client, "FFSDISK\\Jobs\\A.job").error().kind, FailureKind::stopped);
    EXPECT_EQ(send_script(*client, {"OBJ [1]"}).error().kind, FailureKind::stopped);
    EXPECT_EQ(busy.heard(), "^0?RS\n^0?RS\n");
}

TEST(LoadJob, shouldSayThatAnotherJobIsLoaded) {
    Peer stubborn{[](std::string_view frame) {
        return Peer::Reaction{frame == "^0?RS"           ? ready
                              : frame.starts_with("^0$") ? "^0$DI1\t01\tA.job\r"
                              : frame == "^0?JL"         ? "^0=JLFFSDISK\\Jobs\\Other.job\r"
                                                         : ""};
    }};
    const auto client = PrinterClient::connect(stubborn.settings()).value();
    const auto loaded = load_job(*client, "FFSDISK\\Jobs\\A.job", milliseconds{200});
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, FailureKind::stopped);
    EXPECT_THAT(loaded.error().message, HasSubstr("its job is FFSDISK\\Jobs\\Other.job"));
}

TEST(LoadJob, shouldSayThatThePrinterDoesNotAnswer) {
    Peer silent{[](std::string_view) { return Peer::Reaction{}; }};
    const auto client = PrinterClient::connect(silent.settings()).value();
    EXPECT_EQ(load_job(*client, "FFSDISK\\Jobs\\A.job").error().kind, FailureKind::unreachable);
    EXPECT_EQ(read_script(*client).error().kind, FailureKind::unreachable);
    Peer half{[](std::string_view frame) { return Peer::Reaction{frame == "^0?RS" ? ready : ""}; }};
    const auto other = PrinterClient::connect(half.settings()).value();
    EXPECT_EQ(load_job(*other, "FFSDISK\\Jobs\\A.job").error().kind, FailureKind::unreachable);
    EXPECT_EQ(send_script(*other, {"OBJ [1]"}).error().kind, FailureKind::unreachable);
}

TEST(Script, shouldGoToThePrinterAndComeBack) {
    RunningSimulator printer;
    const auto client = PrinterClient::connect(printer.settings()).value();
    const std::vector<std::string> lines{"BEGINJOB [0 (a^b\\c)]", "OBJ [1 0 0 0 (ISO1_7x5) (Größe)]", "ENDJOB []"};
    const auto sent = send_script(*client, lines);
    ASSERT_TRUE(sent) << sent.error().message;
    EXPECT_EQ(sent->job, "EXTERN");
    EXPECT_TRUE(sent->reads_back_alike);
    EXPECT_EQ(read_script(*client).value(), lines);
}

TEST(Script, shouldSayThatItEndsEarlyOrReadsBackDifferently) {
    bool sent = false;
    Peer printer{[&sent](std::string_view frame) {
        sent = sent || frame == "^0*ENDLJSCRIPT";
        return Peer::Reaction{frame == "^0?RS"            ? ready
                              : frame == "^0?JL"          ? "^0=JLEXTERN\r"
                              : frame == "^0?JB" && !sent ? "^0*BEGINLJSCRIPT\r^0*OBJ [0]\r^0*ENDLJSCRIPT\r"
                              : frame == "^0?JB"          ? "^0*BEGINLJSCRIPT\r^0*OBJ [2]\r^0*ENDLJSCRIPT\r"
                                                          : ""};
    }};
    const auto client = PrinterClient::connect(printer.settings()).value();
    EXPECT_FALSE(send_script(*client, {"OBJ [1]"})->reads_back_alike);
    Peer cut{[](std::string_view) { return Peer::Reaction{"^0*BEGINLJSCRIPT\r^0*OBJ [2]\r", true}; }};
    EXPECT_THAT(read_script(*PrinterClient::connect(cut.settings()).value()).error().message, HasSubstr("ends early"));
}

TEST(Script, shouldSayThatThePrinterStillHasTheScriptFromBefore) {
    const std::string unchanged = "^0=RS2\t5\t0\t0\t9\t0\r";
    Peer stubborn{[&unchanged](std::string_view frame) {
        return Peer::Reaction{frame == "^0?RS"   ? unchanged
                              : frame == "^0?JL" ? "^0=JLEXTERN\r"
                              : frame == "^0?JB" ? "^0*BEGINLJSCRIPT\r^0*OBJ [2]\r^0*ENDLJSCRIPT\r"
                                                 : ""};
    }};
    const auto client = PrinterClient::connect(stubborn.settings()).value();
    const auto refused = send_script(*client, {"OBJ [1]"}, milliseconds{100});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, FailureKind::stopped);
    EXPECT_THAT(refused.error().message, HasSubstr("it still has the one that it had before"));
    EXPECT_TRUE(send_script(*client, {"OBJ [2]"}, milliseconds{100})->reads_back_alike) << "the same once more";
}

TEST(Script, shouldSayThatTheConnectionBrokeWithinTheScript) {
    Peer printer{[](std::string_view frame) {
        return Peer::Reaction{frame == "^0?RS"   ? ready
                              : frame == "^0?JL" ? "^0=JLFFSDISK\\Jobs\\A.job\r"
                                                 : "",
                              frame == "^0?JL"};
    }};
    const auto client = PrinterClient::connect(printer.settings()).value();
    const std::vector<std::string> lines(20'000, "OBJ [1 0 0 0 (ISO1_7x5) (a line)]");
    const auto sent = send_script(*client, lines, milliseconds{100});
    ASSERT_FALSE(sent);
    EXPECT_EQ(sent.error().kind, FailureKind::unreachable);
    EXPECT_THAT(sent.error().message, HasSubstr("within the script"));
}

TEST(ScriptLines, shouldTakeFilesOfAnyLineEnd) {
    EXPECT_THAT(script_lines("A\r\nB\rC\n\nD", EscapeMode::none).value(), ElementsAre("A", "B", "C", "D"));
    EXPECT_THAT(script_lines("BEGINLJSCRIPT\nA\nENDLJSCRIPT\n\n", EscapeMode::none).value(), ElementsAre("A"));
}

TEST(ScriptLines, shouldRefuseWhatCannotBeSent) {
    EXPECT_FALSE(script_lines("", EscapeMode::backslash));
    EXPECT_FALSE(script_lines("BEGINLJSCRIPT\nENDLJSCRIPT\n", EscapeMode::backslash));
    EXPECT_FALSE(script_lines("A\nBEGINLJSCRIPT\nB", EscapeMode::backslash));
    EXPECT_THAT(script_lines("A\nENDLJSCRIPT\nB", EscapeMode::backslash).error().message, HasSubstr("line 3"));
    EXPECT_FALSE(script_lines(std::string(5000, 'x'), EscapeMode::backslash));
    EXPECT_FALSE(script_lines(std::string_view{"A\0B", 3}, EscapeMode::backslash));
    EXPECT_FALSE(script_lines("A ^", EscapeMode::none));
    EXPECT_TRUE(script_lines("A ^", EscapeMode::backslash));
}

} // namespace
} // namespace linefeed::printer
