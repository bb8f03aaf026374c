// Tables for people: what lines up, what is cut, and what texts of files and printers cannot do to a terminal.
#include "client/table.hpp"

#include <gtest/gtest.h>

namespace linefeed::client {
namespace {

const Screen paper{};

Table names() {
    return Table{{{"ID", true, false}, {"NAME", false, true}, {"STATE"}}};
}

TEST(Table, shouldAlignColumnsAndLeaveNoBlanksAtTheEnd) {
    Table table = names();
    table.add({{"1"}, {"a"}, {""}});
    table.add({{"100"}, {"Müller"}, {"ready"}});
    EXPECT_EQ(table.text(paper), " ID  NAME    STATE\n"
                                 "  1  a\n"
                                 "100  Müller  ready\n");
}

TEST(Table, shouldCountColumnsAndNotBytes) {
    Table table = names();
    table.add({{"1"}, {"日本"}, {"x"}});      // two columns each
    table.add({{"2"}, {"e\xCC\x81"}, {"y"}}); // an accent that stands on the letter before it
    EXPECT_EQ(table.text(paper), "ID  NAME  STATE\n"
                                 " 1  日本  x\n"
                                 " 2  e\xCC\x81     y\n");
}

TEST(Table, shouldCutOnATerminalOnlyWhatMayBeCut) {
    Table table = names();
    table.add({{"1234567890"}, {"a name that is far too long"}, {"printing"}});
    EXPECT_EQ(table.text({.columns = 40}), "        ID  NAME                STATE\n"
                                           "1234567890  a name that is fa…  printing\n");
    EXPECT_EQ(table.text(paper), "        ID  NAME                         STATE\n"
                                 "1234567890  a name that is far too long  printing\n");
}

TEST(Table, shouldNotCutBelowTheShortestWidth) {
    Table table = names();
    table.add({{"1234567890"}, {"a name that is far too long"}, {"printing"}});
    EXPECT_EQ(table.text({.columns = 5}), "        ID  NAME      STATE\n"
                                          "1234567890  a name …  printing\n");
}

TEST(Table, shouldEscapeWhatCommandsATerminal) {
    Table table = names();
    table.add({{"1"}, {"\x1B[2J\xE2\x80\xAE\xFFx\n"}, {"y"}});
    const std::string text = table.text({.colours = true, .columns = 80});
    EXPECT_NE(text.find("\\x1B[2J\\xE2\\x80\\xAE\\xFFx\\x0A"), std::string::npos) << text;
}

TEST(Table, shouldColourOnlyWhereColoursAre) {
    Table table{{{""}, {""}}};
    table.add({{"bad", Colour::bad}, {"plain"}});
    EXPECT_EQ(table.text(paper), "bad  plain\n");
    EXPECT_EQ(table.text({.colours = true}), "\033[31mbad\033[0m  plain\n");
}

TEST(Facts, shouldLeaveOutWhatIsNotKnownAndCutNothing) {
    Facts facts;
    facts.add("name", {std::string(100, 'x')});
    facts.add("printer", {""});
    facts.add("a", {"b"});
    EXPECT_EQ(facts.text({.columns = 20}), "name  " + std::string(100, 'x') + "\na     b\n");
}

TEST(Cut, shouldNotTearACharacterApart) {
    EXPECT_EQ(cut("日本語", 5), "日本…");
    EXPECT_EQ(cut("日本語", 4), "日…");
    EXPECT_EQ(cut("日本語", 6), "日本語");
    EXPECT_EQ(cut("日本語", 1), "…");
}

} // namespace
} // namespace linefeed::client
