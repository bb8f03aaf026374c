// What must fit together.
#include "config/checks.hpp"
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::config {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Checks, shouldRefuseReferencesToNothing) {
    EXPECT_THAT(
        refusals_of(with_printer("folders: {f: {path: /d, layout: nmaes, printer: other}}\n")),
        ElementsAre("f.yaml:3:33: folders.f.layout: there is no layout \"nmaes\"; did you mean \"names\"? there is: "
                    "names",
                    "f.yaml:3:49: folders.f.printer: there is no printer \"other\"; there is: line1"));
    EXPECT_THAT(refusals_of("layouts: {a: {}}\nfolders: {f: {path: /d, layout: a, printer: p}}\n"),
                ElementsAre("f.yaml:2:45: folders.f.printer: there is no printer \"p\"; none is configured"));
    EXPECT_THAT(refusals_of(with_printer("folders: {f: {path: /d, layout: [], printer: line1}}\n")),
                ElementsAre("f.yaml:3:33: folders.f.layout: expected a text of 1 to 64 bytes, found a list"))
        << "what could not be read is not judged again";
}

TEST(Checks, shouldRefuseAFolderWhoseAutostartDoesNothing) {
    const std::string folder = "folders: {f: {path: /d, layout: names, printer: line1, autostart: true}}\n";
    EXPECT_THAT(
        refusals_of(with_printer(folder)),
        ElementsAre("f.yaml:3:67: folders.f.autostart: has no effect: printers.line1.queue.autostart is false; both "
                    "must be true for jobs to start by themselves"));
    EXPECT_THAT(
        refusals_of("layouts: {names: {}}\nprinters: {line1: {address: tcp://h, queue: {autostart: true}}}\n" + folder),
        IsEmpty());
}

TEST(Checks, shouldRefuseFoldersInEachOther) {
    const auto folders = [](const std::string& one, const std::string& other) {
        return refusals_of(with_printer("folders:\n  a: {path: " + one +
                                        ", layout: names, printer: line1}\n  b: {path: " + other +
                                        ", layout: names, printer: line1}\n"));
    };
    EXPECT_THAT(folders("/d/a", "/d/ab"), IsEmpty());
    EXPECT_THAT(folders("/d/a", "/d/x/../a/"),
                ElementsAre("f.yaml:5:13: folders.b.path: is the path of folder a already"));
    EXPECT_THAT(folders("/d", "/d/a"),
                ElementsAre("f.yaml:5:13: folders.b.path: it and that of folder a lie in each other: keep them apart"));
    EXPECT_THAT(folders("/d/a", "/d"),
                ElementsAre("f.yaml:5:13: folders.b.path: it and that of folder a lie in each other: keep them apart"));
}

TEST(Checks, shouldRefuseFilesOfTheServiceInAFolder) {
    const auto refused = [](const std::string& more) {
        return refusals_of(with_printer("folders: {f: {path: /d, layout: names, printer: line1}}\n" + more));
    };
    EXPECT_THAT(refused("spool: /d2/s\nerrors: /e\nhttp: {tokens_file: /t}\ncontrol: {socket: /s}\n"), IsEmpty());
    EXPECT_THAT(refused("spool: /d/s\n"), ElementsAre("f.yaml:4:8: spool: \"/d/s\" lies in folder f: keep it apart"));
    EXPECT_THAT(refused("errors: /d/x/../e\n"),
                ElementsAre("f.yaml:4:9: errors: \"/d/e\" lies in folder f: keep it apart"));
    EXPECT_THAT(refused("http: {tokens_file: /d/t}\n"),
                ElementsAre(testing::HasSubstr("http.tokens_file: \"/d/t\" lies in folder f")));
    EXPECT_THAT(refused("control: {socket: /d/done/s}\n"),
                ElementsAre(testing::HasSubstr("control.socket: \"/d/done/s\" lies in folder f")));
    EXPECT_THAT(refusals_of(with_printer("folders: {f: {path: /var/lib/linefeed, layout: names, printer: line1}}\n")),
                ElementsAre("f.yaml:3:21: folders.f.path: \"/var/lib/linefeed/spool.db\" lies in folder f: keep it "
                            "apart"))
        << "where it is without being set, too";
}

TEST(Checks, shouldRefuseTwoPrintersAtOneAddress) {
    EXPECT_THAT(refusals_of("printers: {a: {address: tcp://h}, b: {address: \"tcp://h:3000/\"}}\n"),
                ElementsAre("f.yaml:1:48: printers.b.address: is the address of printer a already"));
}

TEST(Checks, shouldRefusePollBoundsInTheWrongOrder) {
    EXPECT_THAT(refusals_of("printers: {p: {address: tcp://h, poll_min: 3 ms, poll_max: 2 ms}}\n"),
                ElementsAre("f.yaml:1:44: printers.p.poll_min: poll_min must not be longer than poll_max"));
}

TEST(Checks, shouldRefuseLayoutOptionsThatExcludeEachOther) {
    EXPECT_THAT(refusals_of("layouts: {l: {table: a, query: b}}\n"),
                ElementsAre("f.yaml:1:32: layouts.l.query: table and query exclude each other"));
    EXPECT_THAT(refusals_of("layouts: {l: {table: a, header: false}}\n"),
                ElementsAre("f.yaml:1:33: layouts.l.header: is for CSV files, table for SQLite databases: they "
                            "exclude each other"));
    EXPECT_THAT(refusals_of("layouts: {l: {delimiter: tab, query: a}}\n"),
                ElementsAre("f.yaml:1:26: layouts.l.delimiter: is for CSV files, query for SQLite databases: they "
                            "exclude each other"));
    EXPECT_THAT(refusals_of("layouts: {l: {columns: [a], column_encodings: {b: latin1}}}\n"),
                ElementsAre("f.yaml:1:47: layouts.l.column_encodings: column \"b\" is not among columns"));
}

TEST(Checks, shouldRefuseHttpForOthersWithoutTokens) {
    EXPECT_THAT(refusals_of("http: {listen: 0.0.0.0}\n"),
                ElementsAre("f.yaml:1:16: http.listen: \"0.0.0.0\" is reached from other machines: that needs "
                            "http.tokens_file"));
    EXPECT_THAT(refusals_of("http: {listen: 0.0.0.0, tokens_file: t}\n"), IsEmpty());
    EXPECT_THAT(
        refusals_of("http: {listen: localhost}\n"),
        ElementsAre("f.yaml:1:16: http.listen: expected a numeric IPv4 or IPv6 address such as 127.0.0.1 or ::1, "
                    "found \"localhost\""));
    EXPECT_TRUE(is_loopback("127.9.9.9"));
    EXPECT_TRUE(is_loopback("::1"));
    EXPECT_FALSE(is_loopback("::"));
    EXPECT_FALSE(is_loopback("::ffff:127.0.0.1"));
    EXPECT_FALSE(is_loopback("128.0.0.1"));
    EXPECT_FALSE(is_loopback("localhost"));
}

TEST(Checks, shouldRefuseHostsOriginsGroupsAndPatternsOfTheWrongForm) {
    const auto refused = [](const std::string& text) { return !refusals_of(text).empty(); };
    for (const char* host : {"a b", "http://a", "a:", "a:1234567", "a:x", "[::1", "[x]", "-a", ":80", "a_b"}) {
        EXPECT_TRUE(refused("http: {hosts: [\"" + std::string{host} + "\"]}\n")) << host;
    }
    for (const char* host : {"a.b-c", "a:80", "10.0.0.1", "[::1]", "[::1]:80"}) {
        EXPECT_FALSE(refused("http: {hosts: [\"" + std::string{host} + "\"]}\n")) << host;
    }
    EXPECT_THAT(
        refusals_of("http: {hosts: [\"a/b\"]}\n"),
        ElementsAre("f.yaml:1:16: http.hosts[1]: expected a host name as browsers send it, HOST or HOST:PORT, found "
                    "the text \"a/b\""));
    EXPECT_THAT(
        refusals_of("http: {origins: [\"*\", \"https://a/\"]}\n"),
        ElementsAre("f.yaml:1:18: http.origins[1]: expected an origin, http://HOST[:PORT] or https://HOST[:PORT], "
                    "without a path, found the text \"*\"",
                    testing::HasSubstr("found the text \"https://a/\"")));
    EXPECT_THAT(refusals_of("control: {group: a b}\n"),
                ElementsAre("f.yaml:1:18: control.group: expected the name of a group of users, found \"a b\""));
    EXPECT_THAT(
        refusals_of(with_printer("folders: {f: {path: /d, layout: names, printer: line1, pattern: a/b}}\n")),
        ElementsAre("f.yaml:3:65: folders.f.pattern: expected a pattern for file names, without /, found \"a/b\""));
    EXPECT_THAT(
        refusals_of(with_printer("folders: {f: {path: /d, layout: names, printer: line1, pattern: \"*.done\"}}\n")),
        ElementsAre(testing::HasSubstr("expected a pattern that does not end in .done")));
}

TEST(Checks, shouldRefuseMoreAcknowledgedNumbersThanTheFeederTakes) {
    std::string errors;
    for (int number = 1; number <= 17; ++number) {
        errors += std::to_string(number) + ": acknowledge, ";
    }
    EXPECT_THAT(refusals_of("printers: {p: {address: tcp://h, errors: {" + errors + "}}}\n"),
                ElementsAre("f.yaml:1:42: printers.p.errors: with the table of error numbers, 17 numbers would be "
                            "acknowledged; at most 16"));
}

} // namespace
} // namespace linefeed::config
