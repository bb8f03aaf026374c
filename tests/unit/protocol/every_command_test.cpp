// Every command of the reference is implemented: each row of the table of commands has a frame here that becomes a
// typed message, and the message written again is the same frame. The table itself is held against the manual in
// commands_test.cpp.
#include "command_vectors.hpp"
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

TEST(EveryCommand, shouldBecomeATypedMessageAndTheSameFrameAgain) {
    for (const Command& row : command_table) {
        const std::vector<std::string> vectors = vectors_of(row);
        ASSERT_FALSE(vectors.empty()) << "no frame for " << static_cast<char>(row.group) << row.code;
        for (const std::string& frame : vectors) {
            const Message message = parsed(frame);
            EXPECT_FALSE(std::holds_alternative<UnknownMessage>(message)) << frame;
            EXPECT_FALSE(std::holds_alternative<MalformedMessage>(message)) << frame;
            EXPECT_EQ(encoded(message), frame);
            EXPECT_EQ(parsed(encoded(message)), message) << frame;
        }
    }
}

TEST(EveryCommand, shouldHaveATypeOfItsOwn) {
    std::vector<std::size_t> alternatives;
    for (const Command& row : command_table) {
        if (row.group != Group::action && row.group != Group::inquiry) {
            alternatives.push_back(parsed(vectors_of(row).at(0)).index());
        }
    }
    std::ranges::sort(alternatives);
    const auto repeated = std::ranges::unique(alternatives);
    EXPECT_EQ(repeated.size(), 2U) << "only the three kinds of script lines share one";
    EXPECT_EQ(alternatives.size() - repeated.size() + 4, std::variant_size_v<Message>)
        << "besides actions, inquiries, unknown and malformed";
}

TEST(EveryCommand, shouldTolerateExcessParameters) {
    for (const std::string_view frame : command_vectors) {
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
    for (const Command& row : command_table) {
        if (row.group == Group::action || row.group == Group::inquiry) {
            continue; // they have none
        }
        const std::string frame = vectors_of(row).back(); // the one with the most parameters
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
