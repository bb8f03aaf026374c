// The effective settings, read again, are the same settings.
#include "config/effective.hpp"
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace linefeed::config {
namespace {

using testing::HasSubstr;

Settings settings_of(const std::string& text) {
    auto settings = parse_settings(text, "/e/f.yaml", {});
    EXPECT_TRUE(settings) << text << testing::PrintToString(lines_of(settings.error()));
    return settings ? *settings : Settings{};
}

TEST(EffectiveSettings, shouldShowDefaultsToo) {
    const std::string text = effective_yaml(settings_of(with_printer("http: {port: 80}\n")));
    EXPECT_THAT(text, testing::StartsWith("spool: /var/lib/linefeed/spool.db\nreal_time:\n  lock_memory: false\n"));
    EXPECT_THAT(text, HasSubstr("  port: 80\n"));
    EXPECT_THAT(text, HasSubstr("  max_body: 16 MiB\n"));
    EXPECT_THAT(text, HasSubstr("  hosts: []\n"));
    EXPECT_THAT(text, HasSubstr("  levels: {}\n"));
    EXPECT_THAT(text, HasSubstr("printers:\n  line1:\n    address: \"tcp://h:3000\"\n    profile: jet3up\n"));
    EXPECT_THAT(text, HasSubstr("    poll_max: 250 ms\n"));
    EXPECT_THAT(text, testing::EndsWith("folders: {}\n"));
}

TEST(EffectiveSettings, shouldGiveTheSameSettingsWhenReadAgain) {
    std::ifstream example{std::filesystem::path{LINEFEED_SOURCE_DIR} / "config" / "linefeed.yaml"};
    const std::string example_text{std::istreambuf_iterator<char>{example}, {}};
    for (const std::string& text :
         {with_printer({}), example_text,
          std::string{
              "spool: \"/a b/\\\"ü: #\"\nlayouts: {\"1\": {columns: ['yes', 'a, b', '010', \"x\\ty\"], delimiter: "
              "'\\', "
              "orientation: 90, column_encodings: {'yes': latin1}}, yes: {query: 'a: [b'}}\n"
              "printers: {no: {address: 'tcp://[::1]:1', errors: {5: stop, 1223: report}, job_file: \"FALSE\"}}\n"
              "logging: {levels: {api: error}}\nreal_time: {priority: 3}\n"}}) {
        const Settings settings = settings_of(text);
        EXPECT_EQ(effective_yaml(settings_of(effective_yaml(settings))), effective_yaml(settings));
        EXPECT_EQ(effective_json(settings_of(effective_json(settings))), effective_json(settings)) << "JSON is YAML";
    }
}

TEST(EffectiveSettings, shouldBeJsonForMachines) {
    const auto json = nlohmann::json::parse(effective_json(settings_of(with_printer({}))));
    EXPECT_EQ(json["printers"]["line1"]["address"], "tcp://h:3000");
    EXPECT_EQ(json["http"]["port"], 8631);
    EXPECT_EQ(json["printers"]["line1"]["queue"]["autostart"], false);
}

} // namespace
} // namespace linefeed::config
