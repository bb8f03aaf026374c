// Variables of the environment go before the file; those that only look like settings are refused.
#include "config/environment.hpp"
#include "config/keys.hpp"
#include "config/names.hpp"
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace linefeed::config {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Settings settings_with(const std::string& text, const Environment& environment) {
    auto settings = parse_settings(text, "/e/f.yaml", environment);
    EXPECT_TRUE(settings) << testing::PrintToString(lines_of(settings.error()));
    return settings ? *settings : Settings{};
}

TEST(Environment, shouldGoBeforeTheFile) {
    const Settings settings = settings_with("spool: /a\nhttp: {port: 80}\nprinters: {line-1: {address: tcp://h}}\n",
                                            {{"LINEFEED_HTTP_PORT", "81"},
                                             {"LINEFEED_LOGGING_LEVELS_STORE", "debug"},
                                             {"LINEFEED_PRINTERS_LINE_1_ADDRESS", "tcp://other:3001"},
                                             {"LINEFEED_PRINTERS_LINE_1_QUEUE_AUTOSTART", "true"},
                                             {"LINEFEED_SPOOL", "b"},
                                             {"LINEFEED_HTTP_HOSTS", "a.example,b.example:80"}});
    EXPECT_EQ(settings.http.port, 81);
    EXPECT_EQ(settings.spool, "/e/b");
    EXPECT_EQ(settings.logging.level_of(LogComponent::store), LogLevel::debug);
    EXPECT_EQ(settings.printers.front().address, (link::PrinterAddress{link::TcpAddress{"other", 3001}}));
    EXPECT_TRUE(settings.printers.front().queue.autostart);
    EXPECT_THAT(settings.http.hosts, ElementsAre("a.example", "b.example:80"));
}

TEST(Environment, shouldNeedNoQuotesAndMayEmptyAList) {
    const Settings settings = settings_with("layouts: {l: {table: a, columns: [b]}}\n",
                                            {{"LINEFEED_LAYOUTS_L_TABLE", "010"}, {"LINEFEED_LAYOUTS_L_COLUMNS", ""}});
    EXPECT_EQ(settings.layouts.front().table, "010");
    EXPECT_THAT(settings.layouts.front().columns, IsEmpty());
}

TEST(Environment, shouldMendAMissingOrWrongValueOfTheFile) {
    EXPECT_THAT(refusals_of("printers: {p: {}}\nhttp: {port: x}\n",
                            {{"LINEFEED_PRINTERS_P_ADDRESS", "tcp://h"}, {"LINEFEED_HTTP_PORT", "80"}}),
                IsEmpty());
}

TEST(Environment, shouldBeRefusedByNameOfTheVariable) {
    EXPECT_THAT(
        refusals_of("x: 1\n",
                    {{"LINEFEED_HTTP_PORT", "080"}, {"LINEFEED_SPOOL", ""}, {"LINEFEED_HTTP_LISTEN", "\xFF"}}),
        ElementsAre(testing::StartsWith("f.yaml:1:1: x: unknown key"), "LINEFEED_HTTP_LISTEN: not UTF-8",
                    "LINEFEED_SPOOL: spool: expected a path of 1 to 4095 bytes, found \"\"",
                    "LINEFEED_HTTP_PORT: http.port: expected a whole number from 1 to 65535, found \"080\"; leave "
                    "leading zeros out"));
}

TEST(Environment, shouldRefuseWhatOnlyLooksLikeASetting) {
    EXPECT_THAT(refusals_of("spool: /a\n", {{"LINEFEED_HTTP_PROT", "1"}}),
                ElementsAre("LINEFEED_HTTP_PROT: no setting has this name; did you mean \"LINEFEED_HTTP_PORT\"?"));
    EXPECT_THAT(refusals_of("spool: /a\n", {{"LINEFEED_SPOOLL", "1"}}),
                ElementsAre("LINEFEED_SPOOLL: no setting has this name; did you mean \"LINEFEED_SPOOL\"?"));
    EXPECT_THAT(
        refusals_of("spool: /a\n", {{"LINEFEED_PRINTERS_LINE9_ADDRESS", "tcp://h"}}),
        ElementsAre("LINEFEED_PRINTERS_LINE9_ADDRESS: no setting has this name; it is LINEFEED_ and the key path in "
                    "capitals, with _ in between"));
    EXPECT_THAT(refusals_of("spool: /a\n", {{"LINEFEED_BIN_DIR", "x"},
                                            {"LINEFEED_LONG_TESTS", "1"},
                                            {"LINEFEED_SOCKET", "/s"},
                                            {"LINEFEED_VERSION", "1"},
                                            {"HOME", "/"}}),
                IsEmpty());
}

TEST(Environment, shouldNotHideWhatIsWrongWithTheFile) {
    EXPECT_THAT(refusals_of("http: 5\n", {{"LINEFEED_HTTP_PORT", "80"}}),
                ElementsAre("f.yaml:1:7: http: expected a mapping, found \"5\""));
    EXPECT_THAT(refusals_of("a: [\n", {{"LINEFEED_HTTP_PORT", "80"}}),
                ElementsAre(testing::HasSubstr("not valid YAML")));
}

TEST(Environment, shouldNameOneSettingOnlyWhateverTheNamesOfElements) {
    for (const KeyInfo& one : known_keys()) {
        for (const KeyInfo& other : known_keys()) {
            const std::size_t star = one.path.find(".*.");
            const bool together =
                star != std::string::npos && one.path.compare(0, star + 3, other.path, 0, star + 3) == 0;
            EXPECT_FALSE(together &&
                         variable_word(one.path).ends_with('_' + variable_word(other.path.substr(star + 3))) &&
                         one.path != other.path)
                << one.path << " of one name could be " << other.path << " of another";
        }
    }
}

TEST(Environment, shouldBeReadFromTheProcess) {
    const std::array<const char*, 5> variables{"LINEFEED_SPOOL=/a=b", "HOME=/", "LINEFEED_HTTP_PORT=1", "LINEFEED_X",
                                               nullptr};
    EXPECT_THAT(read_environment(variables.data()),
                ElementsAre(std::pair{std::string{"LINEFEED_HTTP_PORT"}, std::string{"1"}},
                            std::pair{std::string{"LINEFEED_SPOOL"}, std::string{"/a=b"}}));
    EXPECT_THAT(read_environment(nullptr), IsEmpty());
}

} // namespace
} // namespace linefeed::config
