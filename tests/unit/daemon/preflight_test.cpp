// Facts in, findings out: every state of a printer in words, with what to do. And the whole look at the simulated
// printer and at peers that are none.
#include "daemon/preflight.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace linefeed::daemon {
namespace {

using printer::Peer;
using printer::RunningSimulator;
using protocol::MachineState;
using protocol::NozzleState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

PreflightFacts healthy() {
    PreflightFacts facts;
    facts.machine = protocol::MachineStatus{NozzleState::open, MachineState::ready_to_print, {}, false, 9, false};
    facts.version = protocol::VersionInfo{};
    facts.version->type = "JET3up";
    facts.version->firmware = "V62.0.9.0";
    facts.version->serial_number = "104711";
    facts.job = protocol::JobName{"\\FFSDISK\\JOBS\\names.job"};
    facts.mail = protocol::MailStatus{256, 0, RecordNumber{0}, RecordNumber{0}, true, {}};
    facts.counters = protocol::Counters{1, 0, 4711};
    facts.second_connection = true;
    return facts;
}

class PreflightTest : public testing::Test {
protected:
    [[nodiscard]] std::vector<Finding> findings() const {
        return judge(facts_,
                     {settings_, printer_, known_serial_, may_be_printing_, records_, same_machine_, keeps_stop_at_});
    }
    /// That of this check; one line: severity, words and advice.
    [[nodiscard]] std::string finding(std::string_view check) const {
        for (const Finding& one : findings()) {
            if (one.check == check) {
                constexpr std::array words{"ok: ", "warning: ", "problem: "};
                EXPECT_EQ(one.advice.empty(), one.severity == Severity::ok) << one.words;
                return words[static_cast<std::size_t>(one.severity)] + one.words +
                       (one.advice.empty() ? "" : " - " + one.advice);
            }
        }
        return "none";
    }
    [[nodiscard]] std::vector<std::string> checks() const {
        std::vector<std::string> names;
        for (const Finding& one : findings()) {
            names.push_back(one.check);
        }
        return names;
    }

    PreflightFacts facts_ = healthy();
    config::Settings settings_;
    config::PrinterSettings printer_;
    std::string known_serial_;
    bool may_be_printing_ = false;
    RecordFacts records_;
    std::vector<std::string> same_machine_;
    std::optional<bool> keeps_stop_at_;
};

TEST_F(PreflightTest, shouldFindNothingAmissWithAHealthyPrinter) {
    for (const Finding& one : findings()) {
        EXPECT_EQ(one.severity, Severity::ok) << one.words;
        EXPECT_EQ(one.advice, "") << one.words;
        EXPECT_NE(one.words, "");
    }
    EXPECT_TRUE(may_start(findings()));
    EXPECT_THAT(checks(), ElementsAre("reachable", "identity", "profile", "ready", "nozzle", "cover", "errors",
                                      "job_file", "fifo", "stop_point", "counter", "modes", "connections"));
    EXPECT_EQ(finding("identity"), "ok: JET3up, firmware V62.0.9.0, serial number 104711");
}

TEST_F(PreflightTest, shouldStopAtAPrinterThatCannotBeReached) {
    facts_ = {};
    facts_.unreachable = "tcp://10.0.0.5:3000: Connection refused";
    EXPECT_THAT(checks(), ElementsAre("reachable"));
    EXPECT_THAT(finding("reachable"), HasSubstr("problem: tcp://10.0.0.5:3000: Connection refused - Look whether"));
    EXPECT_FALSE(may_start(findings()));
}

TEST_F(PreflightTest, shouldTellSilenceFromAnotherLanguageAndFromABreak) {
    facts_ = {};
    EXPECT_THAT(finding("reachable"), HasSubstr("problem: it takes the connection, but does not answer"));
    facts_.oddities.unsecured = true;
    EXPECT_THAT(finding("reachable"), HasSubstr("problem: the printer answers, but without CRC32"));
    facts_.oddities = {.damaged_bytes = 40, .unreadable = "=RS: parameter 2 is not a machine state: \"x\""};
    EXPECT_THAT(finding("reachable"), HasSubstr("problem: the printer's answer cannot be read: =RS: parameter 2"));
    facts_.oddities.unreadable.clear();
    EXPECT_THAT(finding("reachable"), HasSubstr("problem: something answers, but not in the printer's language"));
    facts_ = healthy();
    facts_.broke_off = true;
    EXPECT_THAT(finding("reachable"), HasSubstr("problem: the printer closed the connection"));
}

TEST_F(PreflightTest, shouldNoticeAnotherPrinterAtTheSameAddress) {
    known_serial_ = "104711";
    EXPECT_THAT(finding("identity"), HasSubstr("ok: "));
    known_serial_ = "99";
    printer_.name = "line1";
    EXPECT_THAT(finding("identity"), HasSubstr("problem: JET3up, firmware V62.0.9.0, serial number 104711; the serial "
                                               "number here was 99 - If the printer was exchanged, accept it: linefeed "
                                               "printer line1 accept 104711."));
    EXPECT_FALSE(may_start(findings()));
    facts_.version->serial_number.clear();
    EXPECT_THAT(finding("identity"), HasSubstr("warning: the printer does not say its serial number; it was 99 - "));
    facts_.version.reset();
    EXPECT_THAT(finding("identity"), HasSubstr("warning: the printer does not say its serial number; it was 99 - "));
    EXPECT_TRUE(may_start(findings()));
    known_serial_.clear();
    EXPECT_EQ(finding("identity"), "none");
}

TEST_F(PreflightTest, shouldNoticeAProfileOfAnotherKind) {
    facts_.version->type = "JET2neo";
    EXPECT_THAT(finding("profile"), HasSubstr("warning: the printer says that it is a JET2neo, and its profile is "
                                              "jet3up"));
    facts_.version->firmware = "V75.0.11.2";
    printer_.profile = *protocol::profile_by_name("jet2neo");
    EXPECT_EQ(finding("profile"), "ok: jet2neo fits JET2neo");
    facts_.version->type.clear();
    EXPECT_THAT(finding("profile"), HasSubstr("ok: "));
}

TEST_F(PreflightTest, shouldSayWhichProfileAnAutomaticOneIs) {
    printer_.profile = *protocol::profile_by_name("auto");
    EXPECT_EQ(finding("profile"), "ok: auto: jet3up, since it is a JET3up, firmware V62.0.9.0");
    facts_.version->type = "LJ9";
    EXPECT_THAT(finding("profile"), HasSubstr("warning: auto, but the printer does not say"));
    EXPECT_THAT(finding("profile"), HasSubstr("Name its profile"));
}

TEST_F(PreflightTest, shouldStartNoRecordsWithEscapesWhereThePrinterKnowsNone) {
    printer_.profile = *protocol::profile_by_name("auto");
    records_.have_escapes = [] { return true; };
    EXPECT_EQ(finding("profile"), "ok: auto: jet3up, since it is a JET3up, firmware V62.0.9.0");
    facts_.version->type = "JET3";
    EXPECT_EQ(finding("profile"), "problem: auto: jet3, which knows no escapes; the job was imported for firmware that "
                                  "does, and ^ and \\ would come out wrong - Import its file again for this printer.");
    facts_.version->firmware = "new";
    EXPECT_THAT(finding("profile"), HasSubstr("problem: auto, but the printer does not say"));
    EXPECT_THAT(finding("profile"), HasSubstr("name its profile in the settings (jet3up, "));
    facts_.version.reset();
    EXPECT_THAT(finding("profile"), HasSubstr("problem: auto, but the printer does not say"));
    records_.have_escapes = [] { return false; };
    EXPECT_THAT(finding("profile"), HasSubstr("warning: auto, but the printer does not say"));
    facts_.version.emplace().type = "JET3";
    facts_.version->firmware = "V62.0.9.0";
    EXPECT_EQ(finding("profile"), "ok: auto: jet3, since it is a JET3, firmware V62.0.9.0");
}

TEST_F(PreflightTest, shouldNoticeOneMachineBehindTwoNames) {
    same_machine_ = {"line2"};
    EXPECT_THAT(finding("identity"), HasSubstr("warning: "));
    EXPECT_THAT(finding("identity"), HasSubstr("printer line2 is the same machine - Look at the addresses of both"));
    known_serial_ = "1";
    EXPECT_THAT(finding("identity"), HasSubstr("problem: ")) << "another one than it should be";
}

TEST_F(PreflightTest, shouldNoticeAProfileWithOtherEscapes) {
    facts_.version->type = "JET3";
    EXPECT_THAT(finding("profile"),
                HasSubstr("warning: the printer says that it is a JET3, firmware V62.0.9.0: that is "
                          "jet3, and its profile is jet3up"));
    printer_.profile = *protocol::profile_by_name("jet3");
    EXPECT_EQ(finding("profile"), "ok: jet3 fits JET3");
}

TEST_F(PreflightTest, shouldTakeTheOwnersWordOnEscapes) {
    printer_.profile = protocol::parse_profile("jet3,escapes=on").value();
    facts_.version->type = "JET3";
    facts_.version->firmware = "V60.0.25.0";
    EXPECT_EQ(finding("profile"), "ok: jet3,escapes=on fits JET3");
    printer_.profile = protocol::parse_profile("auto,escapes=on").value();
    records_.have_escapes = [] { return true; };
    EXPECT_THAT(finding("profile"), HasSubstr("ok: auto: jet3,escapes=on, since it is a JET3"));
    printer_.profile = protocol::parse_profile("auto,escapes=off").value();
    facts_.version->type = "JET3up";
    EXPECT_THAT(finding("profile"), HasSubstr("problem: auto: jet3up,escapes=off, which knows no escapes"));
}

TEST_F(PreflightTest, shouldStartNoRecordsWithPropertiesWhereThePrinterKnowsNone) {
    records_.have_properties = true;
    EXPECT_THAT(finding("profile"), HasSubstr("ok: "));
    printer_.profile = protocol::parse_profile("jet3up,record-properties=off").value();
    EXPECT_THAT(finding("profile"), HasSubstr("problem: jet3up,record-properties=off, which knows no properties"));
    printer_.profile = protocol::parse_profile("auto").value();
    facts_.version->firmware = "V60.0.1.21";
    EXPECT_THAT(finding("profile"), HasSubstr("which knows no properties of records"));
    records_.have_properties = false;
    EXPECT_THAT(finding("profile"), HasSubstr("ok: "));
}

TEST_F(PreflightTest, shouldWarnWhereASerialLineCarriesLessThanTheConveyorBrings) {
    printer_.address = link::parse_printer_address("serial:///dev/ttyUSB0?baud=9600").value();
    EXPECT_THAT(finding("line"), HasSubstr("ok: the serial line carries about 19 records a second"));
    printer_.expected_rate = 19;
    EXPECT_THAT(finding("line"), HasSubstr("ok: "));
    printer_.expected_rate = 20;
    EXPECT_THAT(finding("line"),
                HasSubstr("warning: the conveyor is to bring 20 products a second, and the serial line "
                          "carries about 19"));
    EXPECT_THAT(finding("line"), HasSubstr(" - Slow the conveyor down"));
    records_.bytes = 20;
    EXPECT_THAT(finding("line"), HasSubstr("ok: ")) << "by the records of the job";
    printer_.address = link::parse_printer_address("tcp://printer").value();
    EXPECT_EQ(finding("line"), "none");
}

TEST_F(PreflightTest, shouldRememberAFirmwareWithoutStopPoint) {
    keeps_stop_at_ = true;
    EXPECT_THAT(finding("stop_point"), HasSubstr("ok: "));
    keeps_stop_at_ = false;
    EXPECT_THAT(finding("stop_point"), HasSubstr("warning: by the last probe its firmware does not keep a stop point"));
}

TEST_F(PreflightTest, shouldHaveWordsForEveryState) {
    facts_.machine->machine = MachineState::initialising;
    EXPECT_THAT(finding("ready"), HasSubstr("problem: the printer is initialising - "));
    facts_.machine->machine = MachineState::service;
    EXPECT_THAT(finding("ready"), HasSubstr("problem: "));
    facts_.machine->machine = MachineState::ready;
    facts_.machine->nozzle = NozzleState::closed;
    EXPECT_THAT(finding("ready"), HasSubstr("problem: the nozzle is not open"));
    printer_.open_nozzle = true;
    EXPECT_THAT(finding("ready"), HasSubstr("ok: "));
    facts_.machine->machine = MachineState::printing;
    EXPECT_THAT(finding("ready"), HasSubstr("problem: it is printing something"));
    may_be_printing_ = true;
    EXPECT_THAT(finding("ready"), HasSubstr("ok: it is printing"));
}

TEST_F(PreflightTest, shouldLookNoFurtherInStandby) {
    facts_ = {};
    facts_.machine = protocol::MachineStatus{};
    EXPECT_THAT(checks(), ElementsAre("reachable", "ready"));
    EXPECT_THAT(finding("ready"), HasSubstr("problem: the printer is in standby - Switch it on."));
}

TEST_F(PreflightTest, shouldLookAtNozzleAndCover) {
    facts_.machine->nozzle = NozzleState::in_between;
    EXPECT_THAT(finding("nozzle"), HasSubstr("warning: the nozzle: in between"));
    facts_.machine->cover_open = true;
    EXPECT_THAT(finding("cover"), HasSubstr("problem: the head cover is open - Close it."));
}

TEST_F(PreflightTest, shouldSayWhatAnErrorMeansAndWhatBecomesOfIt) {
    settings_.errors.entries = {{10202, "battery low", "Have it replaced.", config::ErrorPolicy::report},
                                {51001, "camera", "", config::ErrorPolicy::stop}};
    facts_.machine->error.raw = 10202; // an error window
    EXPECT_THAT(finding("errors"), HasSubstr("problem: pending: 10202 (battery low), error from FEP: battery low - "
                                             "Have it replaced. Then acknowledge it"));
    printer_.errors[10202] = config::ErrorPolicy::acknowledge;
    EXPECT_THAT(finding("errors"), HasSubstr("warning: pending: 10202"));
    EXPECT_THAT(finding("errors"), HasSubstr("; the start acknowledges it - "));
    constexpr std::int32_t warning_window = 1 << 30;
    facts_.machine->error.raw = warning_window | 51001;
    EXPECT_THAT(finding("errors"), HasSubstr("problem: ")) << "its policy is stop";
    facts_.machine->error.raw = warning_window | 777;
    EXPECT_THAT(finding("errors"), HasSubstr("warning: pending: 777, warning from FEP - Look it up"));
    facts_.machine->error.raw = -1711274809; // 1223: mailing's own, whose truth the ledger knows
    EXPECT_THAT(finding("errors"), HasSubstr("; the start acknowledges it"));
}

TEST_F(PreflightTest, shouldCompareTheJobFileWithTheOneThatIsWanted) {
    printer_.job_file = "FFSDISK\\JOBS\\names.job";
    EXPECT_EQ(finding("job_file"), "ok: \\FFSDISK\\JOBS\\names.job is loaded");
    facts_.job = protocol::JobName{"\\FFSDISK\\JOBS\\other.job"};
    EXPECT_THAT(finding("job_file"), HasSubstr("problem: \\FFSDISK\\JOBS\\other.job is loaded, and it has to be "
                                               "FFSDISK\\JOBS\\names.job - Load"));
    facts_.job = protocol::JobName{};
    EXPECT_THAT(finding("job_file"), HasSubstr("problem: no job file is loaded"));
    facts_.job.reset();
    EXPECT_THAT(finding("job_file"), HasSubstr("warning: the printer does not say"));
    printer_.job_file.reset();
    EXPECT_THAT(finding("job_file"), HasSubstr("ok: "));
    facts_.job = protocol::JobName{};
    EXPECT_THAT(finding("job_file"), HasSubstr("warning: no job file is loaded - Load the job"));
}

TEST(SameJobFile, shouldOverlookHowThePathIsWritten) {
    EXPECT_TRUE(same_job_file("\\FFSDISK\\JOBS\\Names.JOB", "ffsdisk\\Jobs\\names.job"));
    EXPECT_TRUE(same_job_file("\\\\FFSDISK\\\\JOBS\\\\names.job", "FFSDISK/JOBS/names.job"));
    EXPECT_TRUE(same_job_file("\\FFSDISK\\JOBS\\names.job", "names.job"));
    EXPECT_FALSE(same_job_file("\\FFSDISK\\JOBS\\names.job", "ames.job"));
    EXPECT_FALSE(same_job_file("\\Storage Card\\LJ3\\JOBS\\names.job", "FFSDISK\\JOBS\\names.job"));
    EXPECT_FALSE(same_job_file("", "names.job"));
}

TEST_F(PreflightTest, shouldLookAtTheFifoAndSayWhatOnlyTheRunProves) {
    EXPECT_THAT(finding("fifo"), HasSubstr("ok: 256 records fit; the start fills it and reads back"));
    EXPECT_THAT(finding("stop_point"), HasSubstr("ok: none is set; the start sets it and reads it back"));
    facts_.mail->stop_at = RecordNumber{500};
    EXPECT_THAT(finding("stop_point"), HasSubstr("ok: it stands at 500"));
    facts_.mail->entries = 3;
    EXPECT_THAT(finding("fifo"), HasSubstr("warning: 256 records fit; 3 of somebody lie there"));
    may_be_printing_ = true;
    EXPECT_THAT(finding("fifo"), HasSubstr("ok: "));
    facts_.mail->depth = 0;
    EXPECT_THAT(finding("fifo"), HasSubstr("problem: the printer has no mailing FIFO"));
    facts_.mail.reset();
    EXPECT_THAT(finding("fifo"), HasSubstr("problem: the printer does not answer ?SM"));
    EXPECT_EQ(finding("stop_point"), "none");
}

TEST_F(PreflightTest, shouldNoticeAStopOfTheProductCounter) {
    facts_.counters->stop_after = 1000;
    EXPECT_THAT(finding("counter"), HasSubstr("warning: the printer stops by itself after 1000 products (now 1)"));
    facts_.counters = protocol::Counters{};
    EXPECT_THAT(finding("counter"), HasSubstr("warning: the printer does not report its total print counter"));
    facts_.counters.reset();
    EXPECT_EQ(finding("counter"), "none");
}

TEST_F(PreflightTest, shouldNoticeWhatOthersHaveLeftOn) {
    facts_.oddities = {.lengths = true, .echoes = true, .filled = true};
    EXPECT_THAT(finding("modes"), HasSubstr("warning: another program has left on: lengths (!LN), echo (!EM), filled "
                                            "blocks (=FL) - "));
    facts_.oddities = {.damaged_bytes = 9};
    EXPECT_THAT(finding("modes"), HasSubstr("warning: 9 bytes were no frames"));
    facts_.second_connection = false;
    EXPECT_THAT(finding("connections"), HasSubstr("warning: "));
    facts_.second_connection.reset();
    EXPECT_EQ(finding("connections"), "none");
    EXPECT_TRUE(may_start(findings()));
}

class PreflightOnPrinters : public PreflightTest {
protected:
    [[nodiscard]] std::vector<std::string> not_ok(const PreflightFacts& facts) {
        facts_ = facts;
        std::vector<std::string> names;
        for (const Finding& one : findings()) {
            if (one.severity != Severity::ok) {
                names.push_back(one.check);
            }
        }
        return names;
    }
};

TEST_F(PreflightOnPrinters, shouldPassTheSimulatedPrinter) {
    RunningSimulator printer;
    printer_.job_file = "FFSDISK\\JOBS\\Testprint.job";
    EXPECT_THAT(not_ok(gather_facts(printer.settings())), IsEmpty());
    EXPECT_EQ(facts_.second_connection, true);
}

TEST_F(PreflightOnPrinters, shouldFindWhatIsWrongWithTheSimulatedPrinter) {
    simulator::SimulatorSettings line;
    line.printer.power_up = simulator::PowerUpState::nozzle_closed;
    line.printer.cover_open = true;
    line.printer.length_on = true;
    line.printer.profile = *protocol::profile_by_name("jet2neo");
    RunningSimulator printer{line};
    printer_.job_file = "FFSDISK\\JOBS\\names.job";
    EXPECT_THAT(not_ok(gather_facts(printer.settings())),
                ElementsAre("profile", "ready", "cover", "job_file", "modes"));
}

TEST_F(PreflightOnPrinters, shouldUnderstandAPrinterInStandby) {
    simulator::SimulatorSettings line;
    line.printer.power_up = simulator::PowerUpState::standby;
    RunningSimulator printer{line};
    EXPECT_THAT(not_ok(gather_facts(printer.settings())), ElementsAre("ready"));
    line.printer.habits.standby_silent = true;
    RunningSimulator silent{line};
    EXPECT_THAT(not_ok(gather_facts(silent.settings())), ElementsAre("reachable"));
}

TEST_F(PreflightOnPrinters, shouldNotBeFooledByPeersThatAreNoPrinters) {
    Peer mad{[](std::string_view) { return Peer::Reaction{"SSH-2.0-OpenSSH_9.2p1\r\n"}; }};
    EXPECT_THAT(not_ok(gather_facts(mad.settings())), ElementsAre("reachable"));
    EXPECT_THAT(finding("reachable"), HasSubstr("not in the printer's language"));
    Peer closing{[](std::string_view) { return Peer::Reaction{{}, true}; }};
    EXPECT_THAT(not_ok(gather_facts(closing.settings())), ElementsAre("reachable"));
    EXPECT_THAT(finding("reachable"), HasSubstr("closed the connection"));
}

TEST_F(PreflightOnPrinters, shouldNoticeAConnectionThatBreaksInTheMiddle) {
    Peer breaking{[](std::string_view frame) {
        return frame == "^0?RS" ? Peer::Reaction{"^0=RS2\t5\t0\t0\t9\t1\r"} : Peer::Reaction{{}, true};
    }};
    EXPECT_THAT(not_ok(gather_facts(breaking.settings())), ElementsAre("reachable"));
    EXPECT_FALSE(may_start(findings()));
}

TEST_F(PreflightOnPrinters, shouldNoticeAPrinterThatServesOnlyOne) {
    Peer single{[served = 0](std::string_view frame) mutable {
        // The sixth inquiry is that of the second connection: nobody answers it.
        ++served;
        if (frame == "^0?RS" && served == 1) {
            return Peer::Reaction{"^0=RS2\t5\t0\t0\t9\t1\r"};
        }
        if (frame == "^0?VS") {
            return Peer::Reaction{"^0=VS1\t1\t1\t1\t1\tJET3up\t1\t1\tV62\tJET3up\t7\r"};
        }
        if (frame == "^0?JL") {
            return Peer::Reaction{"^0=JLa.job\r"};
        }
        if (frame == "^0?SM") {
            return Peer::Reaction{"^0=SM256\t0\t0\t0\t1\r"};
        }
        return Peer::Reaction{frame == "^0?CC" ? "^0=CC0\t0\t5\r" : ""};
    }};
    EXPECT_THAT(not_ok(gather_facts(single.settings())), ElementsAre("connections"));
}

} // namespace
} // namespace linefeed::daemon
