// What can be asked of a printer and done to it: every command has its way, answers of the manual in words, arguments
// that are wrong, and what is too dangerous for now.
#include "printer/printer_client.hpp"
#include "printer/tasks.hpp"
#include "support/peer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace linefeed::printer {
namespace {

using protocol::Group;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A printer that answers each frame as the manual has it.
class AnsweringPrinter {
public:
    explicit AnsweringPrinter(std::map<std::string, std::string, std::less<>> answers,
                              std::string_view profile = "jet3up")
        : peer_{[answers = std::move(answers)](std::string_view frame) {
            const auto found = answers.find(frame);
            return Peer::Reaction{found == answers.end() ? std::string{} : found->second};
        }}
        , client_(PrinterClient::connect(with_profile(peer_.settings(), profile)).value()) {}

    Result<Json> run(std::string_view name, const Json& arguments = nullptr) {
        const Task* const task = find_task(name);
        auto read = Arguments::read(task->arguments, arguments);
        if (!read) {
            return read.error();
        }
        return carry_out(*task, *client_,
                         {*std::move(read), [](const protocol::PrinterError& error) {
                              return error.code() == 1223 ? ErrorWords{"all printed", "next job"} : ErrorWords{};
                          }});
    }
    std::string heard() { return peer_.heard(); }

private:
    static ClientSettings with_profile(ClientSettings settings, std::string_view profile) {
        settings.profile = protocol::parse_profile(profile).value();
        return settings;
    }

    Peer peer_;
    std::unique_ptr<PrinterClient> client_;
};

TEST(Tasks, shouldHaveNamesThatAreUniqueAndWays) {
    std::set<std::string_view> names;
    for (const Task& task : tasks()) {
        EXPECT_TRUE(names.insert(task.name).second) << task.name;
        EXPECT_NE(task.run, nullptr) << task.name;
        EXPECT_FALSE(task.help.empty()) << task.name;
        EXPECT_FALSE(task.uses.empty()) << task.name;
    }
}

TEST(Tasks, shouldReachEveryCommandOfTheReference) {
    for (const protocol::Command& command : protocol::command_table) {
        EXPECT_THAT(tasks_using({command.group, command.code}), Not(IsEmpty()))
            << static_cast<char>(command.group) << command.code;
    }
    EXPECT_THAT(tasks_using({Group::file, "RF"}), ElementsAre("files get", "backup", "restore"));
    EXPECT_THAT(tasks_using({Group::file, "FA"}), ElementsAre("files get", "files put", "backup", "restore"));
}

TEST(Tasks, shouldSendNoFileAsItIsTypedWhileAJobIsOnTheLine) {
    const Task& send = *find_task("send");
    for (const auto& [frame, danger] :
         {std::pair{"$FHFFSDISK\\\\Jobs\\\\a.job\\t1", Danger::spoiling}, std::pair{"$FT1\\t0\\t", Danger::spoiling},
          std::pair{"$DFx", Danger::destructive}, std::pair{"$RFx", Danger::none}, std::pair{"?RS", Danger::none},
          std::pair{"!GO", Danger::feeding}, std::pair{"!NC", Danger::spoiling}, std::pair{"!MC", Danger::spoiling},
          std::pair{"!LF", Danger::spoiling}, std::pair{"=CM90", Danger::spoiling}, std::pair{"=JLa", Danger::spoiling},
          std::pair{"!ST", Danger::feeding}}) {
        const auto arguments = Arguments::read(send.arguments, {{"frame", frame}});
        EXPECT_EQ(danger_of(send, *arguments).value(), danger) << frame;
    }
}

TEST(Tasks, shouldUseOnlyCommandsThatThereAre) {
    for (const Task& task : tasks()) {
        for (const CommandId& used : task.uses) {
            EXPECT_TRUE(std::ranges::any_of(
                protocol::command_table,
                [&used](const protocol::Command& row) { return row.group == used.group && row.code == used.code; }))
                << task.name << ' ' << used.code;
        }
    }
}

TEST(Tasks, shouldShowTheErrorOfTheManualInWords) {
    AnsweringPrinter printer{{{"^0?RS", "^0=RS2\t5\t-1711274809\t0\t9\t0\r"},
                              {"^0?SM", "^0=SM256\t0\t100000\t0\t1\r"},
                              {"^0?JL", "^0=JL\\FFSDISK\\JOBS\\Testprint.job\r"}}};
    const Json status = printer.run("status").value();
    EXPECT_EQ(status["error"]["code"], 1223);
    EXPECT_EQ(status["error"]["raw"], -1711274809);
    EXPECT_EQ(status["error"]["meaning"], "all printed");
    EXPECT_EQ(status["error"]["advice"], "next job");
    EXPECT_THAT(status["error"]["words"].get<std::string>(), HasSubstr("message from RIP"));
    EXPECT_EQ(status["mailing"]["last_printed"], 100000);
    EXPECT_EQ(status["job"], "\\FFSDISK\\JOBS\\Testprint.job");
}

TEST(Tasks, shouldAskNothingElseInStandby) {
    AnsweringPrinter printer{{{"^0?RS", "^0=RS0\t1\t0\t0\t0\t0\r"}}};
    const Json status = printer.run("status").value();
    EXPECT_EQ(status["machine"], "standby");
    EXPECT_TRUE(status["mailing"].is_null());
    EXPECT_EQ(printer.heard(), "^0?RS\n");
}

TEST(Tasks, shouldPutAListTogetherFromItsBlocks) {
    std::string blocks = "^0=EL1\t33\t32";
    for (int i = 0; i < 32; ++i) {
        blocks += "\t24-05-06 07:08:09/00010202";
    }
    blocks += "\r^0=EL33\t33\t1\t24-05-06 07:08:10/-1711274809\r";
    AnsweringPrinter printer{{{"^0?EL", blocks}}};
    const Json errors = printer.run("errors").value();
    EXPECT_EQ(errors["total"], 33);
    ASSERT_EQ(errors["errors"].size(), 33U);
    EXPECT_EQ(errors["errors"][0]["code"], 10202);
    EXPECT_EQ(errors["errors"][32]["meaning"], "all printed");
    EXPECT_EQ(errors["errors"][32]["time"], "2024-05-06 07:08:10");
}

TEST(Tasks, shouldAskAgainForAListThatChangedMeanwhile) {
    int asked = 0;
    Peer peer{[&asked](std::string_view) {
        return Peer::Reaction{++asked == 1 ? "^0=EL2\t2\t1\t24-05-06 07:08:09/1\r"
                                           : "^0=EL1\t1\t1\t24-05-06 07:08:09/1015\r"};
    }};
    const auto client = PrinterClient::connect(peer.settings()).value();
    const Json errors = carry_out(*find_task("errors"), *client, {}).value();
    EXPECT_EQ(errors["errors"][0]["code"], 1015);
}

TEST(Tasks, shouldTellInputsByContactAndFunction) {
    AnsweringPrinter printer{{{"^0?EX", "^0=EX9\t65\t3000\t1\t0\t1\t0\t0\t0\r"}, {"^0?IC", "^0=IC3\t4\t99\r"}}};
    const Json inputs = printer.run("inputs").value();
    EXPECT_EQ(inputs["inputs_code"], 65);
    EXPECT_EQ(inputs["direction"], "forward");
    ASSERT_EQ(inputs["inputs"].size(), 18U);
    EXPECT_EQ(inputs["inputs"][0]["contact"], "X4.9");
    EXPECT_EQ(inputs["inputs"][0]["on"], true);
    EXPECT_EQ(inputs["inputs"][0]["function"], "print start");
    EXPECT_EQ(inputs["inputs"][2]["function"], "unknown");
    EXPECT_EQ(inputs["inputs"][6]["on"], true);
    EXPECT_EQ(inputs["inputs"][6]["function"], "counter increment");
}

TEST(Tasks, shouldUnpackTheDateOfTheLastService) {
    const std::string packed = std::to_string(24U << 26U | 5U << 22U | 6U << 17U | 7U << 12U | 8U << 6U | 9U);
    AnsweringPrinter printer{{{"^0?SH", "^0=SH1234\t1000\t" + packed + "\r"}, {"^0?SC", "^0=SC2000\t365\r"}}};
    const Json service = printer.run("service").value();
    EXPECT_EQ(service["last_service_date"], "2024-05-06 07:08:09");
    EXPECT_EQ(service["interval_days"], 365);
}

TEST(Tasks, shouldDisarmWhatPrintersSay) {
    AnsweringPrinter printer{{{"^0?ET", "^0=ETa\x1B[2Jb\r"}, {"^0?VS", "^0=VS\x9B\r"}}};
    EXPECT_EQ(printer.run("text").value()["text"], "a\\x1B[2Jb");
    EXPECT_EQ(printer.run("info").value()["fpga"], "\\x9B");
    EXPECT_EQ(printer.run("query", {{"code", "ET"}}).value()["answers"][0]["raw"], "^0=ETa\\x1B[2Jb");
}

TEST(Tasks, shouldShowAnInquiryThatNobodyKnows) {
    AnsweringPrinter printer{{{"^0?SL", "^0=SL19\t12\t0\t0\r"}}};
    const Json answer = printer.run("query", {{"code", "sl"}}).value();
    EXPECT_EQ(answer["answers"][0]["raw"], "^0=SL19\\t12\\t0\\t0");
    EXPECT_EQ(printer.run("query", {{"code", "XX"}}).error().kind, FailureKind::unreachable);
    for (const char* wrong : {"", "S", "SMX", "S\r"}) {
        EXPECT_EQ(printer.run("query", {{"code", wrong}}).error().kind, FailureKind::usage) << wrong;
    }
}

TEST(Tasks, shouldSendNoSecondFrameBehindTheFirst) {
    AnsweringPrinter printer{{{"^0?RS", "^0=RS2\t5\t0\t0\t9\t0\r"}}};
    for (const char* argument : {"^0!FF", "1^0!PF", "\\\\\\\\^0!FF"}) {
        const auto asked = printer.run("query", {{"code", "RS"}, {"argument", argument}});
        EXPECT_EQ(asked.error().kind, FailureKind::usage) << argument;
        const auto sent = printer.run("send", {{"frame", std::string{"?RS"} + argument}});
        EXPECT_EQ(sent.error().kind, FailureKind::usage) << argument;
    }
    EXPECT_THAT(printer.heard(), Not(HasSubstr("!")));
}

TEST(Tasks, shouldRefuseWhatLosesSomethingWhileTheMachinePrints) {
    AnsweringPrinter printer{{{"^0?RS", "^0=RS2\t6\t0\t0\t9\t0\r"}}};
    for (const char* name : {"flush", "power off", "restart", "factory-reset"}) {
        EXPECT_EQ(printer.run(name).error().kind, FailureKind::stopped) << name;
    }
    EXPECT_EQ(printer.run("nozzle close").error().kind, FailureKind::stopped);
    EXPECT_EQ(printer.run("fonts reload").error().kind, FailureKind::stopped);
    for (const char* frame : {"!FF", "!FA", "!PF", "!RM", "$DFx", "*BEGINLJSCRIPT", "=ZZ1", "^0!FF"}) {
        EXPECT_EQ(printer.run("send", {{"frame", frame}}).error().kind, FailureKind::stopped) << frame;
    }
    EXPECT_THAT(printer.heard(), Not(HasSubstr("!")));
    EXPECT_TRUE(printer.run("print stop")) << "that it may always";
}

TEST(Tasks, shouldSayThatNothingIsDoneInStandby) {
    AnsweringPrinter printer{{{"^0?RS", "^0=RS0\t1\t0\t0\t0\r"}}};
    for (const char* name : {"nozzle open", "counters reset", "mode length", "print start", "suspend"}) {
        const auto done = printer.run(name);
        EXPECT_EQ(done.error().kind, FailureKind::stopped) << name;
        EXPECT_THAT(done.error().message, HasSubstr("standby")) << name;
    }
}

TEST(Tasks, shouldSayWhyThePrinterDoesNotStart) {
    AnsweringPrinter closed{{{"^0?RS", "^0=RS4\t4\t0\t0\t0\r"}}};
    EXPECT_THAT(closed.run("print start").error().message, HasSubstr("the machine says: ready for action"));
    AnsweringPrinter open{{{"^0?RS", "^0=RS2\t5\t-1711274809\t1\t0\r"}}};
    EXPECT_THAT(open.run("print start").error().message, HasSubstr("cover open"));
    AnsweringPrinter printing{{{"^0?RS", "^0=RS2\t6\t0\t0\t0\r"}}};
    EXPECT_EQ(printing.run("print start").value()["machine"], "printing");
}

TEST(Tasks, shouldSetATextInTheCharactersOfThePrinter) {
    AnsweringPrinter printer{{{"^0?ET", "^0=ETGr\xF6\xDF"
                                        "e 5 \x80\r"}}};
    EXPECT_EQ(printer.run("text set", {{"text", "Gr\u00f6\u00dfe 5 \u20ac"}}).value()["text"],
              "Gr\u00f6\u00dfe 5 \u20ac");
    EXPECT_THAT(printer.heard(), HasSubstr("^0=ETGr\xF6\xDF"
                                           "e 5 \x80\n"));
    EXPECT_EQ(printer.run("text set", {{"text", "\u0141"}}).error().kind, FailureKind::input);
    EXPECT_THAT(printer.run("text set", {{"text", "b"}}).error().message, HasSubstr("it shows another text: Gr"));
}

/// The list has bare numbers: nobody knows who has reported them.
TEST(Tasks, shouldNotInventWhereAnErrorOfTheListComesFrom) {
    AnsweringPrinter printer{{{"^0?EL", "^0=EL1\t1\t1\t26-11-27 10:00:00/00001223\r"}}};
    const Json list = printer.run("errors").value();
    ASSERT_EQ(list["errors"].size(), 1U);
    EXPECT_EQ(list["errors"][0]["code"], 1223);
    EXPECT_EQ(list["errors"][0]["meaning"], "all printed");
    EXPECT_FALSE(list["errors"][0].contains("switches_off"));
    EXPECT_FALSE(list["errors"][0].contains("words"));
}

TEST(Tasks, shouldDoNothingDangerousWhereNobodyKnowsWhetherItPrints) {
    AnsweringPrinter silent{{}};
    EXPECT_EQ(silent.run("flush").error().kind, FailureKind::unreachable);
    EXPECT_EQ(silent.run("power off").error().kind, FailureKind::unreachable);
    EXPECT_EQ(silent.heard(), "^0?RS\n^0?RS\n^0?RS\n^0?RS\n") << "each twice: an answer may get lost";
    EXPECT_TRUE(silent.run("restart")) << "in standby the printer answers nothing else";
    EXPECT_THAT(silent.heard(), HasSubstr("^0!RM\n"));
}

TEST(Tasks, shouldSayThatAFlushHasNotWorked) {
    AnsweringPrinter printer{{{"^0?RS", "^0=RS2\t5\t0\t0\t9\t0\r"}, {"^0?SM", "^0=SM256\t7\t3\t0\t1\r"}}};
    EXPECT_THAT(printer.run("flush").error().message, HasSubstr("7 entries"));
}

TEST(Tasks, shouldNeverAcknowledgeBlindly) {
    AnsweringPrinter calm{{{"^0?RS", "^0=RS2\t5\t0\t0\t9\t0\r"}}};
    EXPECT_EQ(calm.run("acknowledge").error().kind, FailureKind::stopped);
    AnsweringPrinter other{{{"^0?RS", "^0=RS2\t5\t10202\t0\t9\t0\r"}}};
    EXPECT_EQ(other.run("acknowledge", {{"error", 1015}}).error().kind, FailureKind::stopped);
    EXPECT_THAT(calm.heard() + other.heard(), Not(HasSubstr("!EQ")));
}

TEST(Tasks, shouldSendCommandsAsTheManualHasThem) {
    AnsweringPrinter printer{{{"^0?RS", "^0=RS2\t5\t0\t0\t9\t0\r"},
                              {"^0?CC", "^0=CC5\t10\t99\r"},
                              {"^0?PR1", "^0=PR1\t700\r"},
                              {"^0?AC", "^0=AC2\t1\t0\t5\t1\t0\t6\r"}}};
    EXPECT_EQ(printer.run("counters set", {{"product", 5}, {"stop_after", 10}}).value()["total"], 99);
    EXPECT_EQ(printer.run("counters set", {{"stop_after", 11}}).error().kind, FailureKind::stopped);
    EXPECT_TRUE(printer.run("outputs take"));
    EXPECT_TRUE(printer.run("outputs set", {{"output", 3}, {"state", "on"}}));
    EXPECT_TRUE(printer.run("outputs give-back"));
    EXPECT_TRUE(printer.run("counter limit", {{"counter", 2}, {"limit", "end"}, {"value", 9'999'999'999}}));
    EXPECT_TRUE(printer.run("counter reset", {{"counter", 0}}));
    EXPECT_THAT(printer.run("counter limit", {{"counter", 3}, {"limit", "end"}, {"value", 9}}).error().message,
                HasSubstr("the job has 2 counters"));
    EXPECT_EQ(printer.run("counter limit", {{"counter", 0}, {"limit", "end"}, {"value", 9}}).error().kind,
              FailureKind::usage);
    EXPECT_EQ(printer.run("counter reset", {{"counter", 3}}).error().kind, FailureKind::stopped);
    EXPECT_TRUE(printer.run("parameter set", {{"type", "delay"}, {"value", 700}}));
    const std::string heard = printer.heard();
    for (const char* frame :
         {"^0=CC5\t10\n", "^0=CO0\t1\n", "^0=CO3\t1\n", "^0=CO0\t0\n", "^0=CP2\t2\t9999999999\n", "^0=PR1\t700\n"}) {
        EXPECT_THAT(heard, HasSubstr(frame));
    }
}

TEST(Tasks, shouldNotPretendWhereTheFirmwareKnowsNoSuchCommand) {
    const Json limit{{"counter", 1}, {"limit", "end"}, {"value", 5}};
    AnsweringPrinter printer{{{"^0?RS", "^0=RS2\t5\t0\t0\t9\t0\r"}}, "jet2neo"};
    EXPECT_THAT(printer.run("outputs take").error().message, HasSubstr("jet2neo knows no =CO"));
    EXPECT_THAT(printer.run("outputs set", {{"output", 1}, {"state", "on"}}).error().message, HasSubstr("=CO"));
    EXPECT_THAT(printer.run("counter limit", limit).error().message, HasSubstr("counter-limits=on"));
    EXPECT_THAT(printer.heard(), Not(HasSubstr("=C")));
    AnsweringPrinter own{{{"^0?RS", "^0=RS2\t5\t0\t0\t9\t0\r"}}, "jet2neo,output-control=on,counter-limits=on"};
    EXPECT_TRUE(own.run("outputs take"));
    EXPECT_TRUE(own.run("counter limit", limit));
}

TEST(Arguments, shouldRefuseWhatATaskDoesNotTake) {
    const auto wrong = [](std::string_view task, const Json& json) {
        const auto read = Arguments::read(find_task(task)->arguments, json);
        EXPECT_FALSE(read) << json;
        return read ? std::string{} : read.error().message;
    };
    EXPECT_THAT(wrong("outputs set", {{"output", 9}, {"state", "on"}}), HasSubstr("from 1 to 8"));
    EXPECT_THAT(wrong("outputs set", {{"output", -1}, {"state", "on"}}), HasSubstr("from 1 to 8"));
    EXPECT_THAT(wrong("outputs set", {{"output", "1"}, {"state", "on"}}), HasSubstr("whole number"));
    EXPECT_THAT(wrong("outputs set", {{"output", 1}}), HasSubstr("\"state\" is missing"));
    EXPECT_THAT(wrong("status", {{"x", 1}}), HasSubstr("it takes none"));
    EXPECT_THAT(wrong("send", {{"frame", 1}}), HasSubstr("a text"));
    EXPECT_THAT(wrong("send", {{"frame", "?RS"}, {"crc", 1}}), HasSubstr("true or false"));
    EXPECT_FALSE(Arguments::parse({}, "[]"));
    EXPECT_FALSE(Arguments::parse({}, "{"));
    EXPECT_TRUE(Arguments::parse({}, ""));
}

} // namespace
} // namespace linefeed::printer
