// The table of commands for people.
#include "protocol/command_help.hpp"

#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

TEST(CommandHelp, shouldSayDirectionAndRiskInWords) {
    EXPECT_EQ(to_string(Direction::to_printer), "host to printer");
    EXPECT_EQ(to_string(Direction::to_host), "printer to host");
    EXPECT_EQ(to_string(Direction::both), "both ways");
    EXPECT_EQ(to_string(Risk::none), "");
    EXPECT_EQ(to_string(Risk::line), "disturbs the line");
    EXPECT_EQ(to_string(Risk::destructive), "loses what is in the printer");
}

TEST(CommandHelp, shouldHaveOneRowForEachCommandBelowTheTitleOfItsSection) {
    const std::string page = commands_as_markdown();
    std::size_t rows = 0;
    for (std::size_t at = page.find("\n| `^0"); at != std::string::npos; at = page.find("\n| `^0", at + 1)) {
        ++rows;
    }
    EXPECT_EQ(rows, command_table.size());
    std::size_t last = 0;
    for (const char* const part :
         {"\n## Actions\n",
          "\n| `^0!FF` | host to printer | flush the mailing FIFO |  | loses what is in the printer |",
          "\n## Inquiries\n", "\n| `^0?RS` | host to printer | machine state |  |  |", "\n## Parameter transfers\n",
          "\n| `^0=CM` | host to printer | mailing configuration: stop at | stop-at record number (0 off) | disturbs "
          "the line |",
          "\n## Scripts\n", "\n| `^0*…` | both ways | line of a script | the line | disturbs the line |",
          "\n## Files and directories\n", "\n| `^0$FA` | both ways |"}) {
        const std::size_t found = page.find(part);
        ASSERT_NE(found, std::string::npos) << part;
        EXPECT_GT(found, last) << part;
        last = found;
    }
}

} // namespace
} // namespace linefeed::protocol
