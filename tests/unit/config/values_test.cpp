// Every kind of value: what it takes, and each refusal with its text.
#include "link/printer_address.hpp"
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::config {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The refusal of `value` for a key, without its place.
std::string refusal_of(const std::string& section, const std::string& key, const std::string& value) {
    std::string text = section + ":\n  " + key + ": " + value + "\n";
    if (section == "printers") {
        text = "printers:\n  p:\n    " + std::string{key == "address" ? "" : "address: tcp://h\n    "} + key + ": " +
               value + "\n";
    } else if (section == "layouts") {
        text = "layouts:\n  l:\n    " + key + ": " + value + "\n";
    }
    const auto refusals = refusals_of(text);
    EXPECT_LE(refusals.size(), 1U) << testing::PrintToString(refusals);
    if (refusals.empty()) {
        return {};
    }
    const std::size_t begin = refusals.front().find(key + ": ");
    return begin == std::string::npos ? refusals.front() : refusals.front().substr(begin + key.size() + 2);
}

TEST(WholeNumber, shouldBeDecimalDigitsWithoutQuotes) {
    const auto port = [](const std::string& value) { return refusal_of("http", "port", value); };
    EXPECT_EQ(port("1"), "");
    EXPECT_EQ(port("65535"), "");
    const std::string expected = "expected a whole number from 1 to 65535, found ";
    EXPECT_EQ(port("0"), expected + "\"0\"");
    EXPECT_EQ(port("65536"), expected + "\"65536\"");
    EXPECT_EQ(port("99999999999999999999"), expected + "\"99999999999999999999\"");
    EXPECT_EQ(port("010"), expected + "\"010\"; leave leading zeros out");
    EXPECT_EQ(port("1e3"), expected + "\"1e3\"; write digits only");
    EXPECT_EQ(port("0x50"), expected + "\"0x50\"; write digits only");
    EXPECT_EQ(port("-1"), expected + "\"-1\"; write digits only");
    EXPECT_EQ(port("+1"), expected + "\"+1\"; write digits only");
    EXPECT_EQ(port("80.0"), expected + "\"80.0\"; write digits only");
    EXPECT_EQ(port("8_0"), expected + "\"8_0\"; write digits only");
    EXPECT_EQ(port("\"80\""), expected + "the text \"80\"; leave the quotes out");
    EXPECT_EQ(port(""), expected + "nothing");
    EXPECT_EQ(port("[80]"), expected + "a list");
    EXPECT_EQ(port("{a: 80}"), expected + "a mapping");
}

TEST(FlagText, shouldBeTrueOrFalse) {
    const auto flag = [](const std::string& value) { return refusal_of("layouts", "mirrored", value); };
    EXPECT_EQ(flag("true"), "");
    EXPECT_EQ(flag("false"), "");
    for (const char* value : {"yes", "no", "on", "off", "y", "True", "FALSE", "1", "0"}) {
        EXPECT_EQ(flag(value), "expected true or false, found \"" + std::string{value} + "\"");
    }
    EXPECT_EQ(flag("\"true\""), "expected true or false, found the text \"true\"");
    EXPECT_EQ(flag("~"), "expected true or false, found nothing");
}

TEST(DurationText, shouldHaveAUnit) {
    const auto duration = [](const std::string& value) { return refusal_of("printers", "poll_max", value); };
    for (const char* good : {"1 ms", "250 ms", "250ms", "\"250 ms\"", "1 s", "1000000 us"}) {
        EXPECT_EQ(duration(good), "") << good;
    }
    const std::string expected = "expected a duration from 1 ms to 1 s, found ";
    EXPECT_EQ(duration("250"), expected + "\"250\"; a unit is missing: us, ms, s, min or h");
    EXPECT_EQ(duration("1 sec"), expected + "\"1 sec\"; the units are us, ms, s, min or h");
    EXPECT_EQ(duration("1  ms"), expected + "\"1  ms\"; the units are us, ms, s, min or h");
    EXPECT_EQ(duration("0.5 s"), expected + "\"0.5 s\"; write a whole number and a smaller unit");
    EXPECT_EQ(duration("010 ms"), expected + "\"010 ms\"; leave leading zeros out");
    EXPECT_EQ(duration("ms"), expected + "\"ms\"; write a whole number and a unit");
    EXPECT_EQ(duration("-1 ms"), expected + "\"-1 ms\"; write a whole number and a unit");
    EXPECT_EQ(duration("999 us"), expected + "\"999 us\"");
    EXPECT_EQ(duration("2 s"), expected + "\"2 s\"");
    EXPECT_EQ(duration("18446744073709551615 h"), expected + "\"18446744073709551615 h\"");
    EXPECT_EQ(duration("18446744073709551616 h"), expected + "\"18446744073709551616 h\"");
    EXPECT_EQ(duration("[]"), expected + "a list");
}

TEST(SizeText, shouldHaveAUnit) {
    const auto size = [](const std::string& value) { return refusal_of("http", "max_header", value); };
    EXPECT_EQ(size("1 KiB"), "");
    EXPECT_EQ(size("1MiB"), "");
    EXPECT_EQ(size("2000 B"), "");
    EXPECT_EQ(size("16384"),
              "expected a size from 1 KiB to 1 MiB, found \"16384\"; a unit is missing: B, KiB, MiB or GiB");
    EXPECT_EQ(size("16 kB"), "expected a size from 1 KiB to 1 MiB, found \"16 kB\"; the units are B, KiB, MiB or GiB");
    EXPECT_EQ(size("2 MiB"), "expected a size from 1 KiB to 1 MiB, found \"2 MiB\"");
    EXPECT_EQ(size("1023 B"), "expected a size from 1 KiB to 1 MiB, found \"1023 B\"");
}

TEST(TextSetting, shouldNeedQuotesWhereYamlMightReadSomethingElse) {
    const auto text = [](const std::string& value) { return refusal_of("layouts", "table", value); };
    for (const char* good : {"names", "\"010\"", "'yes'", "a1", "10.0.0.1", "names 2024"}) {
        EXPECT_EQ(text(good), "") << good;
    }
    for (const char* bad : {"yes", "No", "ON", "off", "y", "true", "1", "010", "1e3", "0x1F", "1_000", "1.5", ".5",
                            ".inf", "2024-01-01", "12:30", "-1"}) {
        EXPECT_EQ(text(bad), "expected a text of 1 to 1000 bytes, found \"" + std::string{bad} +
                                 "\"; put it in quotes if this text is meant");
    }
    EXPECT_EQ(text("\"\""), "expected a text of 1 to 1000 bytes, found the text \"\"");
    EXPECT_EQ(text("null"), "expected a text of 1 to 1000 bytes, found nothing");
    EXPECT_EQ(text("\"a\\0b\""), "expected a text of 1 to 1000 bytes, found the text \"a\\x00b\"");
    EXPECT_EQ(text("[a]"), "expected a text of 1 to 1000 bytes, found a list");
    EXPECT_EQ(text(std::string(1001, 'a')),
              "expected a text of 1 to 1000 bytes, found \"" + std::string(60, 'a') + "...\" (1001 bytes)");
}

TEST(ChoiceText, shouldNameTheWordsAndTheNearest) {
    const auto charset = [](const std::string& value) { return refusal_of("layouts", "encoding", value); };
    EXPECT_EQ(charset("unicode-hex"), "");
    EXPECT_EQ(charset("\"latin1\""), "");
    EXPECT_EQ(charset("latin2"),
              "expected latin1, windows-1252 or unicode-hex, found \"latin2\"; did you mean \"latin1\"?");
    EXPECT_EQ(charset("utf-8"), "expected latin1, windows-1252 or unicode-hex, found \"utf-8\"");
    EXPECT_EQ(charset("[latin1]"), "expected latin1, windows-1252 or unicode-hex, found a list");
    EXPECT_EQ(refusal_of("printers", "profile", "jet3-up"),
              "there is no firmware profile \"jet3-up\"; there are: jet3up, jet3, jet2neo, jet2neo-v71, auto");
    EXPECT_EQ(refusal_of("printers", "profile", "\"jet3,escapes=yes\""), "escapes is on or off, not \"yes\"");
    EXPECT_EQ(refusal_of("printers", "profile", "[jet3]"), "expected a firmware profile, found a list");
    EXPECT_EQ(refusal_of("printers", "profile", "\"jet3,escapes=on\""), "");
    EXPECT_EQ(refusal_of("layouts", "orientation", "45"), "expected 0, 90, 180 or 270, found \"45\"");
    EXPECT_EQ(refusal_of("layouts", "orientation", "270"), "");
}

TEST(AddressText, shouldBeAPrintersAddress) {
    const auto address = [](const std::string& value) { return refusal_of("printers", "address", value); };
    for (const char* good : {"tcp://printer", "tcp://10.0.0.1:3002", "\"tcp://[::1]:3000\"", "serial:///dev/ttyUSB0",
                             "\"serial:///dev/ttyUSB0?baud=9600&crc=on\""}) {
        EXPECT_EQ(address(good), "") << good;
    }
    const std::string expected = "expected a printer address, " + std::string{link::printer_address_forms} + ", found ";
    EXPECT_EQ(address("192.168.1.20:3000"), expected + "\"192.168.1.20:3000\"");
    EXPECT_EQ(address("serial:///dev/ttyUSB0?baud=7"), expected + "\"serial:///dev/ttyUSB0?baud=7\"");
    EXPECT_EQ(address("tcp://h:0"), expected + "\"tcp://h:0\"");
    EXPECT_EQ(address("tcp://h:65536"), expected + "\"tcp://h:65536\"");
    EXPECT_EQ(address("tcp://"), expected + "\"tcp://\"");
    EXPECT_EQ(address("{}"), expected + "a mapping");
    EXPECT_EQ(address("serial:/dev/ttyUSB0"), expected + "\"serial:/dev/ttyUSB0\"");
    EXPECT_EQ(address("/dev/ttyUSB0"), expected + "\"/dev/ttyUSB0\"");
}

TEST(DelimiterText, shouldBeOneCharacter) {
    const auto delimiter = [](const std::string& value) { return refusal_of("layouts", "delimiter", value); };
    for (const char* good : {"\";\"", "tab", "\"\\t\"", "\"|\"", "\",\""}) {
        EXPECT_EQ(delimiter(good), "") << good;
    }
    for (const char* bad : {"ab", "ü", "'\"'", "\"\""}) {
        EXPECT_THAT(delimiter(bad),
                    testing::StartsWith("expected one ASCII character other than a quote, or tab, found "))
            << bad;
    }
}

TEST(PathText, shouldBeRelativeToTheFile) {
    const auto settings = parse_settings("spool: data/../spool.db\nerrors: /etc/e.yaml\n", "/etc/linefeed/l.yaml", {});
    ASSERT_TRUE(settings);
    EXPECT_EQ(settings->spool, "/etc/linefeed/spool.db");
    EXPECT_EQ(settings->errors_file, "/etc/e.yaml");
    EXPECT_THAT(refusals_of("spool: ''\n"),
                ElementsAre("f.yaml:1:8: spool: expected a path of 1 to 4095 bytes, found the text \"\""));
    EXPECT_THAT(refusals_of("spool: \"a\\nb\"\n"),
                ElementsAre("f.yaml:1:8: spool: expected a path without line breaks, found the text \"a\\x0Ab\""));
    EXPECT_THAT(refusals_of("control: {socket: /" + std::string(107, 's') + "}\n"),
                ElementsAre(testing::EndsWith("(108 bytes)")));
}

TEST(ListSetting, shouldHoldEachItemOnce) {
    EXPECT_THAT(refusals_of("layouts: {l: {columns: [a, 1, \"010\"]}}\n"), IsEmpty());
    EXPECT_THAT(refusals_of("layouts: {l: {columns: a}}\n"),
                ElementsAre("f.yaml:1:24: layouts.l.columns: expected a list, found \"a\""));
    EXPECT_THAT(refusals_of("layouts:\n  l:\n    columns:\n"),
                ElementsAre("f.yaml:3:5: layouts.l.columns: expected a list, found nothing; write [] for none"));
    EXPECT_THAT(
        refusals_of("layouts: {l: {columns: [a, yes, {b: 1}, a]}}\n"),
        ElementsAre("f.yaml:1:28: layouts.l.columns[2]: expected a text of 1 to 1000 bytes, found \"yes\"; put it "
                    "in quotes if this text is meant",
                    "f.yaml:1:33: layouts.l.columns[3]: expected a text of 1 to 1000 bytes, found a mapping",
                    "f.yaml:1:41: layouts.l.columns[4]: \"a\" is in the list already"));
    std::string many;
    for (int i = 0; i < 256; ++i) {
        many += "c" + std::to_string(i) + ", ";
    }
    EXPECT_THAT(refusals_of("layouts: {l: {columns: [" + many + "]}}\n"),
                ElementsAre("f.yaml:1:24: layouts.l.columns: more than 255 items"));
}

TEST(MappingSetting, shouldCheckKeysAndValues) {
    EXPECT_THAT(
        refusals_of("printers: {p: {address: tcp://h, errors: {0: stop, 010: stop, x: stop, 33554432: stop, 5: "
                    "stopp}}}\n"),
        ElementsAre("f.yaml:1:43: printers.p.errors.0: expected an error number from 1 to 33554431 as key, found "
                    "\"0\"",
                    "f.yaml:1:52: printers.p.errors.010: expected an error number from 1 to 33554431 as key, "
                    "found \"010\"",
                    "f.yaml:1:63: printers.p.errors.x: expected an error number from 1 to 33554431 as key, found "
                    "\"x\"",
                    "f.yaml:1:72: printers.p.errors.33554432: expected an error number from 1 to 33554431 as "
                    "key, found \"33554432\"",
                    "f.yaml:1:91: printers.p.errors.5: expected report, acknowledge or stop, found \"stopp\"; did "
                    "you mean \"stop\"?"));
    EXPECT_THAT(refusals_of("printers: {p: {address: tcp://h, errors: [5043]}}\n"),
                ElementsAre("f.yaml:1:42: printers.p.errors: expected a mapping, found a list"));
    EXPECT_THAT(
        refusals_of("layouts: {l: {column_encodings: {\"\": latin1}}}\n"),
        ElementsAre("f.yaml:1:34: layouts.l.column_encodings.: expected the name or number of a column as key"));
    std::string many;
    for (int i = 0; i < 256; ++i) {
        many += "c" + std::to_string(i) + ": latin1, ";
    }
    EXPECT_THAT(refusals_of("layouts: {l: {column_encodings: {" + many + "}}}\n"),
                ElementsAre("f.yaml:1:33: layouts.l.column_encodings: more than 255 entries"));
}

} // namespace
} // namespace linefeed::config
