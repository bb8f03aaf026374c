// Every command of the reference is implemented: each row of the table of commands has a frame here that becomes a
// typed message, and the message written again is the same frame. The table itself is held against the manual in
// commands_test.cpp.
#include "parsing.hpp"
#include "protocol/command_table.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace linefeed::protocol {
namespace {

/// A frame for each row but the actions and inquiries, whose frames are their codes. Those of section 8 have escapes.
const std::vector<std::string_view> frames{
    "^0=AC2\t1\t0\t17\t3\t2\t1410065407\r",
    "^0=CC17\t500\t123456\r",
    "^0=CM100000\r",
    "^0=CO3\t1\r",
    "^0=CP2\t1\t4\r",
    "^0=DL2015\t10\t1\t26\t7\t45\t23\r",
    "^0=DS24576\r",
    "^0=EL33\t34\t2\t24-05-06 07:08:09/00005043\t24-12-31 23:59:59/00010202\r",
    "^0=ETHallo\t(8 3 FF81FF)\\\\\\^\r",
    "^0=EV1\t1\t1\t24-05-06 07:08:09/30/2/11/40/2400/1000/7100/6\r",
    "^0=EX300\t131585\t1800\t1\t\t1\t0\t0\t0\r",
    "^0=FC3957421711\r",
    "^0=FL2048\r",
    "^0=GWPPABAC\r",
    "^0=HS7100\t2400\t35\t1000\t0\tx\r",
    "^0=IC0\t1\t3\t4\t12\t10\r",
    "^0=JLFFSDISK\\\\JOBS\\\\TESTPRINT.JOB\r",
    "^0=MC1\t2\t0\t0\t0\t7100\t2400\t0\t-3\t66\t70000\t600\t2200\r",
    "^0=MR17\tMiss\tJane\tMiller\t{ho2}\r",
    "^0=MS1\t1\t0\t1\t0\t0\t1\t0\t2\t1\t0\r",
    "^0=NR3560773416\r",
    "^0=OC1\t2\t3\t4\t5\t6\t12\t13\r",
    "^0=PR2\t31000\r",
    "^0=RC2\t9999999999\r",
    "^0=RS2\t6\t-1711274809\t0\t9\t0\r",
    "^0=SC2000\t365\r",
    "^0=SH1234\t1000\t1570672640\r",
    "^0=SM256\t253\t22119\t100000\t1\r",
    "^0=SW120\r",
    "^0=VSf\tr\ts\tfe\tk\tJET3up\tl\tfo\tV62.0.7.0\tt\t4711\r",
    "^0*BEGINLJSCRIPT\r",
    "^0*ENDLJSCRIPT\r",
    "^0*OBJ (x) \\^\\\\\r",
    "^0$RDFFSDISK\\\\Jobs*\r",
    "^0$DI1\t02\t!Jobs\tLJ24 Test.job\r",
    "^0$DFFFSDISK\\\\Jobs\\\\a.job\r",
    "^0$RFFFSDISK\\\\Jobs\\\\MyJob1.job\r",
    "^0$FHFFSDISK\\\\Jobs\\\\MyJob1.job\t2\r",
    "^0$FT2\t131\tIBAC\r",
    "^0$FA2\t1\r",
};

/// The frame of a row; empty if this test has none.
std::string frame_of(const Command& row) {
    const std::string head = std::string{"^0"} + static_cast<char>(row.group) + std::string{row.code};
    if (row.group == Group::action || row.group == Group::inquiry) {
        return head + "\r";
    }
    const auto found = std::ranges::find_if(frames, [&](std::string_view frame) {
        return row.code.empty() ? frame.starts_with("^0*OBJ") : frame.starts_with(head);
    });
    return found == frames.end() ? std::string{} : std::string{*found};
}

TEST(EveryCommand, shouldBecomeATypedMessageAndTheSameFrameAgain) {
    for (const Command& row : command_table) {
        const std::string frame = frame_of(row);
        ASSERT_FALSE(frame.empty()) << "no frame for " << static_cast<char>(row.group) << row.code;
        const Message message = parsed(frame);
        EXPECT_FALSE(std::holds_alternative<UnknownMessage>(message)) << frame;
        EXPECT_FALSE(std::holds_alternative<MalformedMessage>(message)) << frame;
        EXPECT_EQ(encoded(message), frame);
        EXPECT_EQ(parsed(encoded(message)), message) << frame;
    }
}

TEST(EveryCommand, shouldHaveATypeOfItsOwn) {
    std::vector<std::size_t> alternatives;
    for (const std::string_view frame : frames) {
        alternatives.push_back(parsed(frame).index());
    }
    std::ranges::sort(alternatives);
    const auto repeated = std::ranges::unique(alternatives);
    EXPECT_EQ(repeated.size(), 2U) << "only the three kinds of script lines share one";
    EXPECT_EQ(alternatives.size() - repeated.size() + 4, std::variant_size_v<Message>)
        << "besides actions, inquiries, unknown and malformed";
}

TEST(EveryCommand, shouldTolerateExcessParameters) {
    for (const std::string_view frame : frames) {
        if (frame.starts_with("^0=MR") || frame.starts_with("^0=ET") || frame.starts_with("^0*")) {
            continue; // there a TAB belongs to the text
        }
        // What newer firmware may append: behind an optional last parameter the excess must not be taken for it.
        const std::string longer =
            std::string{frame.substr(0, frame.size() - 1)} + (frame.starts_with("^0=SM") ? "\t\t99" : "\t") + "\tnew\r";
        EXPECT_EQ(parsed(longer), parsed(frame)) << longer;
    }
}

/// Parameters that carry nothing, by code and place from 1 (protocol, section 4).
const std::set<std::pair<std::string, std::size_t>> reserved{{"EX", 7}, {"EX", 8}, {"EX", 9}, {"MC", 3},
                                                             {"MC", 4}, {"MC", 5}, {"MC", 8}, {"MS", 11}};

/// The frame with another text from `begin` to `end`, one that can be read and says something else; empty if there is
/// none.
std::string with_another_value(std::string_view frame, std::size_t begin, std::size_t end) {
    const Message message = parsed(frame);
    const std::string own{frame.substr(begin, end - begin)};
    for (const std::string& other : {std::string{"0"}, std::string{"1"}, std::string{"2"}, own + "1", own + "a",
                                     own + "AB", std::string{"25-01-02 03:04:05"}}) {
        const std::string changed = std::string{frame.substr(0, begin)} + other + std::string{frame.substr(end)};
        const Message other_message = parsed(changed);
        if (other_message.index() == message.index() && other_message != message) {
            EXPECT_EQ(parsed(encoded(other_message)), other_message) << changed;
            return changed;
        }
    }
    return {};
}

TEST(EveryCommand, shouldKeepEachParameterInAFieldOfItsOwn) {
    for (const std::string_view frame : frames) {
        const std::string code{frame.substr(3, 2)};
        const bool of_entries = frame.starts_with("^0=EL") || frame.starts_with("^0=EV");
        const std::string_view separators = frame[2] == '*' ? "\r" : of_entries ? "\t/\r" : "\t\r";
        std::size_t place = 1;
        for (std::size_t begin = frame[2] == '*' ? 3 : 5; begin < frame.size(); ++place) {
            const std::size_t end = frame.find_first_of(separators, begin);
            const std::string changed = with_another_value(frame, begin, end);
            EXPECT_EQ(changed.empty(), reserved.contains({code, place})) << frame << " parameter " << place;
            begin = end + 1;
        }
    }
}

TEST(EveryCommand, shouldNotBreakOnAnEmptyParameterList) {
    for (const Command& row : command_table) {
        const std::string head = std::string{"^0"} + static_cast<char>(row.group) + std::string{row.code} + "\r";
        const Message message = parsed(head);
        EXPECT_FALSE(std::holds_alternative<UnknownMessage>(message)) << head;
        if (const auto* const malformed = std::get_if<MalformedMessage>(&message)) {
            EXPECT_EQ(encoded(message), head) << "carried as it came";
            EXPECT_NE(malformed->reason.find("missing"), std::string::npos) << malformed->reason;
        }
    }
}

} // namespace
} // namespace linefeed::protocol
