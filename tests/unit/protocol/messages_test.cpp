// Typed messages out of literal frames: the conversations of the manual and of real firmware.
#include "parsing.hpp"

namespace linefeed::protocol {
namespace {

// --- RS

TEST(Messages, shouldReadTheMachineStatusOfTheManual) {
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS2\t5\t0\t0\t9\t1\r"),
              (MachineStatus{NozzleState::open, MachineState::ready_to_print, {}, false, 9, true}));
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS2\t6\t0\t0\t9\t0\r"),
              (MachineStatus{NozzleState::open, MachineState::printing, {}, false, 9, false}));
    const auto finished = parsed_as<MachineStatus>("^0=RS2\t5\t-1711274809\t0\t9\t0\r");
    EXPECT_EQ(finished.error.code(), error_code::last_record_printed);
}

TEST(Messages, shouldReadTheMachineStatusOfOldFirmware) {
    const auto status = parsed_as<MachineStatus>("^0=RS2\t6\t0\t0\t0\r");
    EXPECT_EQ(status, (MachineStatus{NozzleState::open, MachineState::printing, {}, false, 0, std::nullopt}));
    EXPECT_EQ(parsed_as<MachineStatus>("^000013=RS2\t6\t0\t0\t0\r"), status) << "with the length of !LN";
}

TEST(Messages, shouldReadEveryNozzleAndMachineState) {
    for (int nozzle = 0; nozzle <= 5; ++nozzle) {
        for (int machine = 2; machine <= 6; ++machine) {
            const auto status =
                parsed_as<MachineStatus>("^0=RS" + std::to_string(nozzle) + "\t" + std::to_string(machine) + "\t0\r");
            EXPECT_EQ(static_cast<int>(status.nozzle), nozzle);
            EXPECT_EQ(static_cast<int>(status.machine), machine);
        }
    }
}

TEST(Messages, shouldReadTheErrorNumberSignedAndUnsigned) {
    const auto of_signed = parsed_as<MachineStatus>("^0=RS2\t5\t-1711274809\t1\t9\t0\r");
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS2\t5\t2583692487\t1\t9\t0\r"), of_signed);
    EXPECT_TRUE(of_signed.cover_open);
}

TEST(Messages, shouldLeaveEmptyParametersOfTheMachineStatusAtTheirDefaults) {
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS4\t4\t0\t\t\t\r"),
              (MachineStatus{NozzleState::closed, MachineState::ready, {}, false, 0, std::nullopt}));
}

TEST(Messages, shouldTakeWhatNewerFirmwareAddsToTheMachineStatus) {
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS6\t4\t0\t0\t0\r").nozzle, NozzleState::invalid);
    EXPECT_TRUE(parsed_as<MachineStatus>("^0=RS2\t6\t0\t2\r").cover_open);
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS2\t7\t0\t0\t0\r").machine, MachineState::unknown);
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS2\t0\t0\t0\t0\r").machine, MachineState::unknown);
}

TEST(Messages, shouldReadNothingButTheStateInStandby) {
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS255\t1\tx\t0\t0\t0\r"), MachineStatus{});
}

TEST(Messages, shouldRefuseAMachineStatusThatCannotBeTrue) {
    EXPECT_EQ(reason("^0=RS2\tx\t0\t0\t0\r"), "=RS: parameter 2 is not a machine state: \"x\"");
    EXPECT_EQ(reason("^0=RS2\t6\t4294967296\r"), "=RS: parameter 3 is not an error number: \"4294967296\"");
    EXPECT_EQ(reason("^0=RS2\t6\t0\t0\tfast\r"), "=RS: parameter 5 is not a speed: \"fast\"");
    EXPECT_EQ(reason("^0=RS2\t6\t0\t0\t9\t-1\r"), "=RS: parameter 6 is not 0 or 1: \"-1\"");
}

TEST(Messages, shouldRefuseAMachineStatusThatLacksWhatMatters) {
    EXPECT_EQ(reason("^0=RS\r"), "=RS: parameter 2 is missing: a machine state");
    EXPECT_EQ(reason("^0=RS2\r"), "=RS: parameter 2 is missing: a machine state");
    EXPECT_EQ(reason("^0=RS2\t6\r"), "=RS: parameter 3 is missing: an error number");
    EXPECT_EQ(parsed_as<MalformedMessage>("^0=RS2\t\t0\r").payload, "RS2\t\t0");
}

// --- SM

TEST(Messages, shouldReadTheMailStatusOfTheManual) {
    EXPECT_EQ(parsed_as<MailStatus>("^0=SM256\t255\t0\t100000\t1\r"),
              (MailStatus{256, 255, RecordNumber{0}, RecordNumber{100000}, true, std::nullopt}));
    EXPECT_EQ(parsed_as<MailStatus>("^0=SM256\t253\t22119\t100000\t0\r"),
              (MailStatus{256, 253, RecordNumber{22119}, RecordNumber{100000}, false, std::nullopt}));
}

TEST(Messages, shouldReadTheMailStatusOfNewerFirmware) {
    EXPECT_EQ(parsed_as<MailStatus>("^0=SM256\t0\t3\t0\t1\t21\r"),
              (MailStatus{256, 0, RecordNumber{3}, RecordNumber{0}, true, 21}));
}

TEST(Messages, shouldTakeAnyLastPrintAbove0ForFinished) {
    EXPECT_TRUE(parsed_as<MailStatus>("^0=SM256\t0\t3\t0\t2\r").last_print_finished);
    EXPECT_FALSE(parsed_as<MailStatus>("^0=SM256\t0\t3\t0\t0\t\r").last_print_finished);
}

TEST(Messages, shouldIgnoreExcessParametersAndTrailingBlanks) {
    EXPECT_EQ(parsed_as<MailStatus>("^0=SM256 \t0 \t3  \t0\t1 \t21 \t99\tx \r"),
              (MailStatus{256, 0, RecordNumber{3}, RecordNumber{0}, true, 21}));
    EXPECT_EQ(parsed_as<MachineStatus>("^0=RS2\t6\t0\t0\t9\t0\tnew\r").speed, 9U);
}

TEST(Messages, shouldRefuseAMailStatusThatCannotBeRead) {
    EXPECT_EQ(reason("^0=SMx\t0\t0\t0\t1\r"), "=SM: parameter 1 is not a FIFO depth: \"x\"");
    EXPECT_EQ(reason("^0=SM256\t-1\t0\t0\t1\r"), "=SM: parameter 2 is not a number of entries: \"-1\"");
    EXPECT_EQ(reason("^0=SM256\t0\tx\t0\t1\r"), "=SM: parameter 3 is not a record number: \"x\"");
    EXPECT_EQ(reason("^0=SM256\t0\t0\t4294967296\t1\r"), "=SM: parameter 4 is not a record number: \"4294967296\"");
    EXPECT_EQ(reason("^0=SM256\t0\t0\t0\tyes\r"), "=SM: parameter 5 is not a number: \"yes\"");
    EXPECT_EQ(reason("^0=SM256\t0\t0\t0\t1\tx\r"), "=SM: parameter 6 is not a number of PrintGos: \"x\"");
    EXPECT_EQ(reason("^0=SM\r"), "=SM: parameter 1 is missing: a FIFO depth");
    EXPECT_EQ(reason("^0=SM256\t0\t\t0\t1\r"), "=SM: parameter 3 is missing: a record number");
    EXPECT_EQ(reason("^0=SM256\t0\t3\t0\r"), "=SM: parameter 5 is missing: a number") << "no flag is no finished print";
    EXPECT_EQ(reason("^0=SM256\t0\t3\t0\t\r"), "=SM: parameter 5 is missing: a number");
    EXPECT_EQ(reason("^0=SM256\t0\t0\r"), "=SM: parameter 4 is missing: a record number");
}

// --- CM, CC, VS, JL

TEST(Messages, shouldReadStopAt) {
    EXPECT_EQ(parsed_as<StopAt>("^0=CM100000\r"), (StopAt{RecordNumber{100000}}));
    EXPECT_EQ(reason("^0=CM\r"), "=CM: parameter 1 is missing: a record number");
    EXPECT_EQ(reason("^0=CM10000 0\r"), "=CM: parameter 1 is not a record number: \"10000 0\"");
}

TEST(Messages, shouldReadCounters) {
    EXPECT_EQ(parsed_as<Counters>("^0=CC17\t0\t123456\r"), (Counters{17, 0, 123456}));
    EXPECT_EQ(parsed_as<Counters>("^0=CC\t500\r"), (Counters{std::nullopt, 500, std::nullopt}));
    EXPECT_EQ(parsed_as<Counters>("^0=CC\r"), Counters{});
    EXPECT_EQ(reason("^0=CCx\r"), "=CC: parameter 1 is not a product counter: \"x\"");
    EXPECT_EQ(reason("^0=CC1\tx\r"), "=CC: parameter 2 is not a number of products: \"x\"");
    EXPECT_EQ(reason("^0=CC1\t2\tx\r"), "=CC: parameter 3 is not a print counter: \"x\"");
}

TEST(Messages, shouldReadUpToElevenVersions) {
    const auto all = parsed_as<VersionInfo>("^0=VSf\tr\ts\tfe\tk\tJET3up\tl\tfo\tV62.0.7.0\tt\t4711\texcess\r");
    EXPECT_EQ(all, (VersionInfo{"f", "r", "s", "fe", "k", "JET3up", "l", "fo", "V62.0.7.0", "t", "4711"}));
    const auto few = parsed_as<VersionInfo>("^0=VSf\t\ta\\^b\r");
    EXPECT_EQ(few.fpga, "f");
    EXPECT_EQ(few.rip, "");
    EXPECT_EQ(few.sdc, "a^b");
    EXPECT_EQ(few.serial_number, "");
}

TEST(Messages, shouldReadJobPathsLeniently) {
    EXPECT_EQ(parsed_as<JobName>("^0=JLFFSDISK\\JOBS\\TESTPRINT.JOB\r").path, "FFSDISK\\JOBS\\TESTPRINT.JOB");
    EXPECT_EQ(parsed_as<JobName>("^0=JL\\FFSDISK\\JOBS\\Testprint.job\r").path, "\\FFSDISK\\JOBS\\Testprint.job");
    EXPECT_EQ(parsed_as<JobName>("^0=JLFFSDISK\\\\JOBS\\\\a\\^b.job\texcess\r").path, "FFSDISK\\JOBS\\a^b.job");
    EXPECT_EQ(parsed_as<JobName>("^0=JL\r").path, "");
    EXPECT_EQ(std::get<JobName>(parsed("^0=JLA\\\\B\r", EscapeMode::none)).path, "A\\\\B");
}

// --- MR

TEST(Messages, shouldReadMailRecords) {
    EXPECT_EQ(parsed_as<MailRecord>("^0=MR22118\tMaier\r"), (MailRecord{RecordNumber{22118}, {"Maier"}, {}}));
    EXPECT_EQ(reason("^0=MR\tMaier\r"), "=MR: the record number is wrong or missing");
    EXPECT_EQ(reason("^0=MR017\tMaier\r"), "=MR: the record number is wrong or missing");
}

TEST(Messages, shouldTruncateAnOverlongMailRecordAsThePrinterDoes) {
    const auto record = parsed_as<MailRecord>("^0=MR1\t" + std::string(10'000, 'x') + "\r");
    EXPECT_EQ(record.fields.at(0).size(), 2046U);
}

// --- actions, inquiries and the rest

TEST(Messages, shouldReadActions) {
    EXPECT_EQ(parsed_as<ActionMessage>("^0!GO\r"), ActionMessage{Action::start_print});
    EXPECT_EQ(parsed_as<ActionMessage>("^0!OK\r"), ActionMessage{Action::crc_ok});
    EXPECT_EQ(parsed_as<ActionMessage>("^0!EQ  \r"), ActionMessage{Action::acknowledge_errors});
    EXPECT_EQ(parsed_as<ActionMessage>("^0!FF\t1\r"), ActionMessage{Action::flush_fifo});
}

TEST(Messages, shouldReadInquiriesWithTheirArgument) {
    EXPECT_EQ(parsed_as<InquiryMessage>("^0?SM\r"), (InquiryMessage{Parameter::SM, ""}));
    EXPECT_EQ(parsed_as<InquiryMessage>("^0?PR3\r"), (InquiryMessage{Parameter::PR, "3"}));
}

TEST(Messages, shouldCarryUnknownCommandsAlong) {
    const auto unknown = [](Group group, const char* payload) { return UnknownMessage{group, payload}; };
    EXPECT_EQ(parsed_as<UnknownMessage>("^0=QQ19\t12\t0\t0\r"), unknown(Group::parameter, "QQ19\t12\t0\t0"));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0=X\r"), unknown(Group::parameter, "X"));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0=\r"), unknown(Group::parameter, ""));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0!XX\r"), unknown(Group::action, "XX"));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0!G\r"), unknown(Group::action, "G"));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0!GOAL\r"), unknown(Group::action, "GOAL"));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0!\r"), unknown(Group::action, ""));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0?QQ\r"), unknown(Group::inquiry, "QQ"));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0$XX1\r"), unknown(Group::file, "XX1"));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0$\r"), unknown(Group::file, ""));
    EXPECT_EQ(parsed_as<UnknownMessage>("^0=JB1\r"), unknown(Group::parameter, "JB1")) << "answered with script lines";
}

TEST(Messages, shouldNotTrustTheBeginningOfAnOverlongFrame) {
    const std::string excess(max_frame_bytes, '0');
    EXPECT_EQ(reason("^0=SM256\t0\t0\t0\t1\t" + excess + "\r"), "=SM: the frame is longer than any that is known");
    EXPECT_EQ(reason("^0$RD" + excess + "\r"), "$RD: the frame is longer than any that is known");
    EXPECT_EQ(reason("^0*LINE" + excess + "\r"), "*LI: the frame is longer than any that is known");
}

TEST(Messages, shouldWriteWhatCannotBeReadAsItCame) {
    for (const char* const frame : {"^0=SMx\r", "^0$FT1\t0\tZ\r", "^0?XX\tand more\r"}) {
        EXPECT_EQ(rewritten(frame), frame);
    }
    EXPECT_EQ(parsed("^0=SMx\r"), parsed("^0=SMx\r"));
    EXPECT_NE(parsed("^0=SMx\r"), parsed("^0=SMy\r"));
    EXPECT_NE(parsed("^0=XXx\r"), parsed("^0!XXx\r"));
}

TEST(Messages, shouldSayStatesInWords) {
    EXPECT_EQ(to_string(NozzleState::invalid), "invalid");
    EXPECT_EQ(to_string(NozzleState::opens), "opens");
    EXPECT_EQ(to_string(NozzleState::open), "open");
    EXPECT_EQ(to_string(NozzleState::closes), "closes");
    EXPECT_EQ(to_string(NozzleState::closed), "closed");
    EXPECT_EQ(to_string(NozzleState::in_between), "in between");
    EXPECT_EQ(to_string(MachineState::unknown), "unknown");
    EXPECT_EQ(to_string(MachineState::standby), "standby");
    EXPECT_EQ(to_string(MachineState::initialising), "initialising");
    EXPECT_EQ(to_string(MachineState::service), "interval or service panel");
    EXPECT_EQ(to_string(MachineState::ready), "ready for action");
    EXPECT_EQ(to_string(MachineState::ready_to_print), "ready for print start");
    EXPECT_EQ(to_string(MachineState::printing), "printing");
}

TEST(MessagesDeathTest, shouldAbortOnStatesAndGroupsThatDoNotExist) {
    EXPECT_DEATH(static_cast<void>(to_string(static_cast<NozzleState>(9))), "NozzleState");
    EXPECT_DEATH(static_cast<void>(to_string(static_cast<MachineState>(9))), "MachineState");
    Frame frame;
    frame.group = static_cast<Group>('x');
    EXPECT_DEATH(static_cast<void>(parse_message(frame, EscapeMode::none)), "Group");
}

} // namespace
} // namespace linefeed::protocol
