// The names of the protocol, against lists written down from the manual by hand.
#include "protocol/command_table.hpp"
#include "protocol/commands.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <utility>

namespace linefeed::protocol {
namespace {

constexpr std::array<std::pair<Action, std::string_view>, 22> actions_of_the_manual{{
    {Action::start_print, "GO"},        {Action::stop_print, "ST"},    {Action::nozzle_open, "NO"},
    {Action::nozzle_close, "NC"},       {Action::motor_open, "MO"},    {Action::motor_close, "MC"},
    {Action::reset_counters, "RC"},     {Action::factory_reset, "FA"}, {Action::reload_fonts, "LF"},
    {Action::acknowledge_errors, "EQ"}, {Action::user_suspend, "US"},  {Action::user_resume, "UR"},
    {Action::power_on, "PO"},           {Action::power_off, "PF"},     {Action::restart, "RM"},
    {Action::flush_fifo, "FF"},         {Action::display_off, "W0"},   {Action::display_on, "W1"},
    {Action::length_on, "LN"},          {Action::echo_on, "EM"},       {Action::crc_ok, "OK"},
    {Action::end_of_data, "EN"},
}};

constexpr std::string_view parameters_of_the_manual =
    "AC CC CM CO CP DL DS EL ET EV EX FC FL GW HS IC JB JL MC MR MS NR OC PR RC RS SC SH SL SM SW VS";

TEST(Commands, shouldKnowEveryActionOfTheManualBothWays) {
    for (const auto& [action, letters] : actions_of_the_manual) {
        EXPECT_EQ(code(action), letters);
        EXPECT_EQ(action_from_code(letters), action) << letters;
    }
}

TEST(Commands, shouldKnowEveryParameterOfTheManualBothWays) {
    std::size_t index = 0;
    for (std::size_t at = 0; at < parameters_of_the_manual.size(); at += 3, ++index) {
        const std::string_view letters = parameters_of_the_manual.substr(at, 2);
        const auto parameter = parameter_from_code(letters);
        ASSERT_TRUE(parameter) << letters;
        EXPECT_EQ(static_cast<std::size_t>(*parameter), index) << letters;
        EXPECT_EQ(code(*parameter), letters);
    }
    EXPECT_EQ(index, 32U);
    EXPECT_EQ(parameter_from_code("RS"), Parameter::RS);
    EXPECT_EQ(parameter_from_code("VS"), Parameter::VS);
}

TEST(Commands, shouldKnowEveryFileCommandOfTheManualBothWays) {
    constexpr std::string_view all = "RD DI DF RF FH FT FA";
    std::size_t index = 0;
    for (std::size_t at = 0; at < all.size(); at += 3, ++index) {
        const std::string_view letters = all.substr(at, 2);
        const auto command = file_command_from_code(letters);
        ASSERT_TRUE(command) << letters;
        EXPECT_EQ(static_cast<std::size_t>(*command), index) << letters;
        EXPECT_EQ(code(*command), letters);
        EXPECT_FALSE(description(*command).empty());
    }
    EXPECT_EQ(index, 7U);
}

/// The group characters and codes of a kind of row, e.g. "!GO !ST …".
std::set<std::string> rows(Group group, bool (*wanted)(const Command&)) {
    std::set<std::string> codes;
    for (const Command& row : command_table) {
        if (row.group == group && wanted(row)) {
            codes.insert(std::string{row.code});
        }
    }
    return codes;
}

std::set<std::string> words(std::string_view list) {
    std::set<std::string> out;
    for (std::size_t at = 0; at < list.size(); at += 3) {
        out.insert(std::string{list.substr(at, 2)});
    }
    return out;
}

TEST(CommandTable, shouldHaveEveryInquiryOfTheManual) {
    EXPECT_EQ(rows(Group::inquiry, [](const Command&) { return true; }),
              words("AC CC CP DL DS EL ET EV EX GW HS IC JB JL MC MS OC PR RS SC SH SL SM VS"))
        << "CP as its description in section 4 says; SL from the field notes";
}

TEST(CommandTable, shouldSayWhoSendsEachParameter) {
    const auto sent = [](Direction direction) {
        static Direction wanted;
        wanted = direction;
        return rows(Group::parameter, [](const Command& row) { return row.direction == wanted; });
    };
    // ET and PR are host to printer in the manual's headings, and come back as the answers to ?ET and ?PR.
    EXPECT_EQ(sent(Direction::both), words("CC CP DL ET JL NR PR"));
    EXPECT_EQ(sent(Direction::to_printer), words("CM CO FL MR RC SW"));
    EXPECT_EQ(sent(Direction::to_host), words("AC DS EL EV EX FC GW HS IC MC MS OC RS SC SH SL SM VS"));
}

TEST(CommandTable, shouldNameWhatMustNotHappenWhileAJobPrints) {
    const auto destructive = [](const Command& row) { return row.risk == Risk::destructive; };
    EXPECT_EQ(rows(Group::action, destructive), words("FA FF PF RM"));
    EXPECT_EQ(rows(Group::file, destructive), words("DF"));
    EXPECT_TRUE(rows(Group::inquiry, [](const Command& row) { return row.risk != Risk::none; }).empty());
}

TEST(CommandTable, shouldDescribeEachRowAndFollowTheSections) {
    unsigned section = 0;
    for (const Command& row : command_table) {
        EXPECT_FALSE(row.description.empty()) << row.code;
        EXPECT_GE(section_of(row.group), section) << row.code;
        section = section_of(row.group);
    }
    EXPECT_EQ(section, 8U);
}

TEST(Commands, shouldNotKnowOtherCodes) {
    for (const char* const letters : {"", "G", "GOO", "go", "XX", "QQ", "0W", "W/", "W:", "G ", " G", "G\xE4"}) {
        EXPECT_EQ(action_from_code(letters), std::nullopt) << letters;
        EXPECT_EQ(parameter_from_code(letters), std::nullopt) << letters;
        EXPECT_EQ(file_command_from_code(letters), std::nullopt) << letters;
    }
    EXPECT_EQ(action_from_code("SM"), std::nullopt);
    EXPECT_EQ(parameter_from_code("GO"), std::nullopt);
}

TEST(Commands, shouldDescribeEachDifferently) {
    std::set<std::string_view> descriptions;
    for (const auto& [action, letters] : actions_of_the_manual) {
        descriptions.insert(description(action));
    }
    for (int parameter = 0; parameter <= static_cast<int>(Parameter::VS); ++parameter) {
        descriptions.insert(description(static_cast<Parameter>(parameter)));
    }
    EXPECT_EQ(descriptions.size(), 22U + 32U);
    EXPECT_FALSE(descriptions.contains(""));
    EXPECT_EQ(description(Parameter::SM), "mailing status");
    EXPECT_EQ(description(Action::flush_fifo), "flush the mailing FIFO");
}

} // namespace
} // namespace linefeed::protocol
