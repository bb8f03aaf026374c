// The simulator answers every command of the interface: each row of the table of commands has a scene here in which it
// shows that it was understood, or in which the printer sends it.
#include "../protocol/command_vectors.hpp"
#include "../protocol/parsing.hpp"
#include "printer/tasks.hpp"
#include "printer_fixture.hpp"
#include "protocol/command_help.hpp"
#include "protocol/command_table.hpp"
#include "protocol/crc32.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::simulator::test {
namespace {

using protocol::Command;
using protocol::Group;

PrinterSettings settings() {
    PrinterSettings settings;
    settings.counters = {{1, 9, 0}, {5, 7, 0}};
    settings.habits.tank_levels = true;
    return settings;
}

PrinterSettings with_closed_nozzle() {
    PrinterSettings made = settings();
    made.power_up = PowerUpState::nozzle_closed;
    return made;
}

PrinterSettings in_standby() {
    PrinterSettings made = settings();
    made.power_up = PowerUpState::standby;
    return made;
}

/// What `query` answers changes when `command` was sent and a second has passed.
bool changes(const std::string& command, const std::string& query, PrinterSettings with = settings()) {
    Printer printer{std::move(with)};
    printer.rs();
    const std::string before = printer.send(query);
    printer.send(command);
    printer.wait(seconds{1});
    return printer.send(query) != before;
}

/// The first answer to `asked` begins with `answer`.
bool answers(const std::string& asked, const std::string& answer) {
    Printer printer{settings()};
    return printer.send(asked).starts_with(answer);
}

bool stops() {
    Printer printer;
    printer.fill(1, 3);
    printer.send("^0!GO\r");
    const bool printed = printer.model.printing();
    printer.send("^0!ST\r");
    return printed && !printer.model.printing() && printer.sm() == "^0=SM256\t0\t0\t0\t1\r";
}

bool releases_the_panel() {
    Printer printer;
    printer.send("^0!US\r");
    const bool blocked = printer.model.panel_blocked();
    printer.send("^0!UR\r");
    return blocked && !printer.model.panel_blocked();
}

bool restarts() {
    Printer printer{in_standby()};
    printer.send("^0!RM\r");
    return !printer.others.empty() && std::holds_alternative<ConnectionsLost>(printer.others.back());
}

bool interrupts_for_the_fonts() {
    Printer printer;
    printer.fill(1, 3);
    printer.send("^0!GO\r^0!LF\r");
    const bool interrupted = printer.product() == PrintGoOutcome::not_printing;
    printer.wait(seconds{1});
    return interrupted && printer.product() == PrintGoOutcome::printed;
}

bool switches_the_display(bool on) {
    Printer printer;
    printer.send(on ? "^0!W0\r^0!W1\r" : "^0!W0\r");
    return printer.model.display_on() == on;
}

bool acknowledges() {
    Printer printer;
    printer.operate([](auto& model, Instant now) { model.raise_error(5043, now); });
    printer.send("^0!EQ\r");
    return printer.rs().starts_with("^0=RS2\t5\t0\t");
}

bool resets_length_and_echo() {
    Printer printer;
    printer.send("^0!LN\r^0!EM\r");
    const bool on = printer.send("^0!EQ\r").starts_with("^0000");
    printer.send("^0!FA\r");
    return on && printer.send("^0!EQ\r").empty();
}

/// Counters after two prints and `command`.
std::string counters_after(const std::string& command) {
    Printer printer{settings()};
    printer.fill(1, 2);
    printer.send("^0!GO\r");
    printer.products(2);
    printer.send(command);
    return printer.send("^0?AC\r");
}

/// Stops at the end of the record whose number was sent.
bool stops_at() {
    Printer printer;
    printer.fill(1, 3);
    printer.send("^0=CM2\r^0!GO\r");
    printer.products(2);
    return !printer.model.printing();
}

bool sets_outputs() {
    Printer printer;
    printer.send("^0=CO0\t1\r^0=CO3\t1\r");
    return printer.model.output(3) && !printer.model.output(1);
}

bool takes_a_script() {
    Printer printer;
    printer.send("^0*BEGINLJSCRIPT\r^0*OBJ (x)\r^0*ENDLJSCRIPT\r");
    printer.wait(seconds{1});
    return printer.send("^0?JL\r") == "^0=JLEXTERN\r" &&
           printer.send("^0?JB\r") == "^0*BEGINLJSCRIPT\r^0*OBJ (x)\r^0*ENDLJSCRIPT\r";
}

bool prints_a_record() {
    Printer printer;
    printer.send("^0=MR1\ta\r^0!GO\r");
    return printer.product() == PrintGoOutcome::printed && printer.tape.back().text == "a";
}

bool takes_a_file() {
    Printer printer;
    return printer.send("^0$FHFFSDISK\\Jobs\\new.job\t1\r^0$FT1\t131\tIBAC\r") == "^0$FA1\t1\r" &&
           printer.send("^0$RFFFSDISK\\Jobs\\new.job\r") == "^0$FHFFSDISK\\Jobs\\new.job\t1\r^0$FT1\t131\tIBAC\r";
}

bool deletes_a_file() {
    Printer printer;
    printer.send("^0$DFFFSDISK\\Jobs\\DM.JOB\r");
    return printer.send("^0$RDFFSDISK\\Jobs\\DM.JOB\r") == "^0$DI1\t00\r";
}

bool sends_again() {
    Printer printer;
    const std::string sent = printer.send("^0$RFFFSDISK\\Jobs\\DM.JOB\r");
    return sent.find("^0$FT1\t") != std::string::npos &&
           printer.send("^0$FA1\t0\r") == sent.substr(sent.find("^0$FT1\t"));
}

/// By group character and code.
const std::map<std::string, std::function<bool()>> scenes{
    {"!GO", [] { return changes("^0!GO\r", "^0?RS\r"); }},
    {"!ST", stops},
    {"!NO", [] { return changes("^0!NO\r", "^0?RS\r", with_closed_nozzle()); }},
    {"!NC", [] { return changes("^0!NC\r", "^0?RS\r"); }},
    {"!MO", [] { return changes("^0!MO\r", "^0?MS\r", with_closed_nozzle()); }},
    {"!MC", [] { return !changes("^0!MO\r^0!MC\r", "^0?MS\r", with_closed_nozzle()); }},
    {"!RC", [] { return counters_after("^0!RC\r") == "^0=AC2\t1\t0\t1\t1\t0\t5\r"; }},
    {"!FA", resets_length_and_echo},
    {"!LF", interrupts_for_the_fonts},
    {"!EQ", acknowledges},
    {"!US", releases_the_panel},
    {"!UR", releases_the_panel},
    {"!PO", [] { return changes("^0!PO\r", "^0?RS\r", in_standby()); }},
    {"!PF", [] { return changes("^0!PF\r", "^0?RS\r"); }},
    {"!RM", restarts},
    {"!FF",
     [] {
         return changes("^0=MR1\ta\r^0=MR2\tb\r", "^0?SM\r") && !changes("^0=MR1\ta\r^0=MR2\tb\r^0!FF\r", "^0?SM\r");
     }},
    {"!W0", [] { return switches_the_display(false); }},
    {"!W1", [] { return switches_the_display(true); }},
    {"!LN", resets_length_and_echo},
    {"!EM", resets_length_and_echo},
    {"!OK", [] { return answers("^0=NR3957421711\r^0?JL\r", "^0!OK\r"); }},
    {"!EN", [] { return Printer{settings()}.send("^0?GW\r").ends_with("\r^0!EN\r"); }},
    {"=AC", [] { return counters_after("") == "^0=AC2\t1\t0\t3\t1\t0\t7\r"; }},
    {"=CC", [] { return changes("^0=CC7\t8\r", "^0?CC\r"); }},
    {"=CM", stops_at},
    {"=CO", sets_outputs},
    {"=CP", [] { return !changes("^0=CP1\t2\t3\r", "^0?CP1\r") && answers("^0?CP2\t2\r", "^0=CP2\t2\t7\r"); }},
    {"=DL", [] { return changes("^0=DL2015\t10\t1\t26\t7\t45\t23\r", "^0?DL\r"); }},
    {"=DS", [] { return answers("^0?DS\r", "^0=DS24576\r"); }},
    {"=EL", [] { return answers("^0?EL\r", "^0=EL1\t0\t0\r"); }},
    {"=ET", [] { return changes("^0=ETHallo\r", "^0?ET\r"); }},
    {"=EV", [] { return answers("^0?EV\r", "^0=EV1\t1\t1\t24-01-01 00:00:01/30/1/4/12/2400/1000/7100/5\r"); }},
    {"=EX", [] { return answers("^0?EX\r", "^0=EX9\t0\t3000\t1\t0\t0\t0\t0\t0\r"); }},
    {"=FC", [] { return answers("^0=NR1\r^0?JL\r", "^0=FC3957421711\r"); }},
    {"=FL", [] { return changes("^0=FL100\r", "^0?JL\r"); }},
    {"=GW", [] { return answers("^0?GW\r", "^0=GW"); }},
    {"=HS", [] { return answers("^0?HS\r", "^0=HS7100\t2400\t35\t1000\t0\t0\r"); }},
    {"=IC", [] { return answers("^0?IC\r", "^0=IC0\t0\t0\t0\t0\t0\r"); }},
    {"=JL", [] { return changes("^0=JLFFSDISK\\Jobs\\DM.JOB\r", "^0?JL\r"); }},
    {"=MC", [] { return answers("^0?MC\r", "^0=MC0\t2\t0\t0\t0\t7100\t2400\t0\t100\t66\t70000\t0\t0\r"); }},
    {"=MR", prints_a_record},
    {"=MS", [] { return answers("^0?MS\r", "^0=MS1\t1\t1\t0\t0\t0\t1\t0\t2\t0\t0\r"); }},
    {"=NR", [] { return Printer{settings()}.send("^0=NR3957421711\r^0?JL\r").find("=NR") != std::string::npos; }},
    {"=OC", [] { return answers("^0?OC\r", "^0=OC1\t2\t3\t4\t0\t0\t0\t0\r"); }},
    {"=PR", [] { return changes("^0=PR4\t31\r", "^0?PR4\r"); }},
    {"=RC", [] { return counters_after("^0=RC2\t6\r") == "^0=AC2\t1\t0\t3\t1\t0\t6\r"; }},
    {"=RS", [] { return answers("^0?RS\r", "^0=RS2\t5\t0\t0\t9\t1\r"); }},
    {"=SC", [] { return answers("^0?SC\r", "^0=SC2000\t365\r"); }},
    {"=SH", [] { return answers("^0?SH\r", "^0=SH1234\t1000\t1570672640\r"); }},
    {"=SL", [] { return answers("^0?SL\r", "^0=SL19\t12\t0\t0\r"); }},
    {"=SM", [] { return answers("^0?SM\r", "^0=SM256\t0\t0\t0\t1\r"); }},
    {"=SW", [] { return changes("^0=SW5\r", "^0?GW\r"); }},
    {"=VS", [] { return answers("^0?VS\r", "^0=VSV3.14\t"); }},
    {"*BEGINLJSCRIPT", takes_a_script},
    {"*ENDLJSCRIPT", takes_a_script},
    {"*", takes_a_script},
    {"$RD", [] { return answers("^0$RDFFSDISK\\Jobs\r", "^0$DI1\t01\t!Jobs\r"); }},
    {"$DI", [] { return answers("^0$RDFFSDISK\\Jobis\r", "^0$DI1\t00\r"); }},
    {"$DF", deletes_a_file},
    {"$RF", [] { return answers("^0$RFFFSDISK\\Jobs\\no.job\r", "^0$FHFFSDISK\\Jobs\\no.job\t0\r"); }},
    {"$FH", takes_a_file},
    {"$FT", takes_a_file},
    {"$FA", sends_again},
};

/// What the simulator does with the command; empty if it shows nothing of it.
std::string shown_by_the_simulator(const Command& row) {
    const std::string name = static_cast<char>(row.group) + std::string{row.code};
    if (row.group == Group::inquiry) {
        Printer printer{settings()};
        const std::string asked = "^0" + name + (row.code == "PR" ? "3" : "") + "\r";
        const std::string expected = row.code == "JB" ? "^0*BEGINLJSCRIPT\r" : "^0=" + std::string{row.code};
        return printer.send(asked).starts_with(expected) ? "answers" : "";
    }
    const auto scene = scenes.find(name);
    if (scene == scenes.end() || !scene->second()) {
        return {};
    }
    return row.direction == protocol::Direction::to_host ? "sends" : "obeys";
}

TEST(EveryCommand, shouldBeAnsweredOrObeyedBySimulatedPrinters) {
    for (const Command& row : protocol::command_table) {
        EXPECT_NE(shown_by_the_simulator(row), "") << static_cast<char>(row.group) << row.code;
    }
}

// The page of the documentation: each cell is found out here, and none written by hand.

/// The name of the type that the message has; of a template with its arguments.
std::string type_of(const protocol::Message& message) {
    return std::visit(
        []<typename T>(const T&) {
            const std::string_view function = __PRETTY_FUNCTION__; // … [with T = linefeed::protocol::MailStatus; …]
            const std::size_t begin = function.find("T = ") + 4;
            std::string name{function.substr(begin, function.find_first_of(";]", begin) - begin)};
            constexpr std::string_view space = "linefeed::protocol::";
            for (std::size_t at = name.find(space); at != std::string::npos; at = name.find(space)) {
                name.erase(at, space.size());
            }
            return name;
        },
        message);
}

std::string typed(const Command& row) {
    std::string type;
    for (const std::string& frame : protocol::vectors_of(row)) {
        type = type_of(protocol::parsed(frame));
        if (type == "UnknownMessage" || type == "MalformedMessage") {
            return {};
        }
    }
    return type.empty() ? type : '`' + type + '`';
}

/// Every frame comes out as it was.
std::string is_encoded(const Command& row) {
    const auto frames = protocol::vectors_of(row);
    const bool same =
        std::ranges::all_of(frames, [](const auto& frame) { return protocol::rewritten(frame) == frame; });
    return same && !frames.empty() ? "yes" : "";
}

/// What is written of every frame is read as the same message.
std::string is_parsed(const Command& row) {
    const auto frames = protocol::vectors_of(row);
    const bool same = std::ranges::all_of(frames, [](const auto& frame) {
        const protocol::Message message = protocol::parsed(frame);
        return protocol::parsed(protocol::encoded(message)) == message;
    });
    return same && !frames.empty() ? "yes" : "";
}

/// What of `linefeed printer P` sends or reads it, and printing; `send` for what it takes as it is typed.
std::string reached_by(const Command& row) {
    std::vector<std::string_view> names;
    if (row.group == Group::parameter && row.code == "MR") {
        names.emplace_back("print");
    }
    std::ranges::copy(printer::tasks_using({row.group, row.code}), std::back_inserter(names));
    const printer::Task& send = *printer::find_task("send");
    const std::string frame = static_cast<char>(row.group) + (row.code.empty() ? "OBJ" : std::string{row.code});
    const auto arguments = printer::Arguments::read(send.arguments, {{"frame", frame}});
    const auto sent = arguments ? send.sends(*arguments) : arguments.error();
    const bool as_typed = sent && (row.group == Group::script || sent->code == row.code);
    if (as_typed && row.direction != protocol::Direction::to_host && std::ranges::find(names, "send") == names.end()) {
        names.emplace_back("send");
    }
    std::string text;
    for (const std::string_view name : names) {
        text += (text.empty() ? "" : ", ") + std::string{name};
    }
    return text;
}

/// How many frames of it are read and written, and its scene.
std::string is_tested(const Command& row) {
    const std::size_t frames = protocol::vectors_of(row).size();
    const bool scene = !shown_by_the_simulator(row).empty();
    return frames == 0 || !scene ? "" : std::to_string(frames) + (frames == 1 ? " frame" : " frames") + ", 1 scene";
}

TEST(EveryCommand, shouldHaveNoEmptyCellInThePageOfTheDocumentation) {
    const std::vector<protocol::CommandColumn> columns{{"typed", typed},
                                                       {"encoded", is_encoded},
                                                       {"parsed", is_parsed},
                                                       {"simulator", shown_by_the_simulator},
                                                       {"command line", reached_by},
                                                       {"tested", is_tested}};
    for (const Command& row : protocol::command_table) {
        for (const auto& column : columns) {
            EXPECT_NE(column.cell(row), "") << static_cast<char>(row.group) << row.code << ": " << column.title;
        }
    }
    const std::string page = protocol::commands_as_markdown(columns);
    const char* const file = LINEFEED_SOURCE_DIR "/deploy/doc/commands.md";
    if (std::getenv("LINEFEED_WRITE_PAGES") != nullptr) {
        std::ofstream{file} << page;
    }
    std::ifstream stream{file};
    const std::string written{std::istreambuf_iterator<char>{stream}, {}};
    EXPECT_EQ(written, page) << "run this test with LINEFEED_WRITE_PAGES=1";
}

} // namespace
} // namespace linefeed::simulator::test
