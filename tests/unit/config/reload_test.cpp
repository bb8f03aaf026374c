// What a reload changes, and what stands against it.
#include "config/effective.hpp"
#include "config/keys.hpp"
#include "config/reload.hpp"
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::config {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Settings settings_of(const std::string& text) {
    auto settings = parse_settings(text, "/e/f.yaml", {});
    EXPECT_TRUE(settings) << text << testing::PrintToString(lines_of(settings.error()));
    return settings ? *settings : Settings{};
}

std::vector<std::string> changes(const std::string& before, const std::string& after) {
    std::vector<std::string> lines;
    for (const Change& change : diff(settings_of(before), settings_of(after))) {
        lines.push_back(to_string(change));
    }
    return lines;
}

TEST(Reload, shouldFindNothingWhereNothingChanged) {
    EXPECT_THAT(changes("spool: /a\nhttp: {port: 80}\n", "http:\n    port: 80\nspool: /b/../a # the same\n"),
                IsEmpty());
}

TEST(Reload, shouldNameEachChangedKeyAndWhenItTakesEffect) {
    EXPECT_THAT(changes("spool: /a\nprinters: {p: {address: tcp://a, queue: {autostart: false}}}\n",
                        "spool: /b\nprinters: {p: {address: tcp://b, queue: {autostart: true}, job_file: j}}\n"),
                ElementsAre("spool: \"/a\" -> \"/b\" (when the service is started again)",
                            "printers.p.address: \"tcp://a:3000\" -> \"tcp://b:3000\" (not while p prints)",
                            "printers.p.queue.autostart: false -> true", "printers.p.job_file: new: \"j\""));
}

TEST(Reload, shouldNameElementsThatAreNewOrGoneAsAWhole) {
    const auto lines =
        changes("layouts: {a: {}}\nprinters: {p: {address: tcp://a}}\n", "printers: {q: {address: tcp://a}}\n");
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_THAT(lines[0], testing::StartsWith("layouts.a: gone; was {\"columns\":[],"));
    EXPECT_THAT(lines[1], testing::AllOf(testing::StartsWith("printers.p: gone; was {"),
                                         testing::EndsWith("} (not while p prints)")));
    EXPECT_THAT(lines[2], testing::AllOf(testing::StartsWith("printers.q: new: {"), testing::EndsWith("}")));
}

TEST(Reload, shouldSeeTheTableOfErrorNumbers) {
    Settings before;
    before.errors.entries = {{7, "m", "a", ErrorPolicy::report}};
    Settings after = before;
    after.errors.entries.front().policy = ErrorPolicy::stop;
    after.errors.unlisted = ErrorPolicy::stop;
    const auto found = diff(before, after);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(to_string(found[0]), "error_table.unlisted: \"report\" -> \"stop\"");
    EXPECT_EQ(to_string(found[1]), "error_table.errors.7.policy: \"report\" -> \"stop\"");
}

TEST(Reload, shouldBeBlockedByPrintersThatPrintOnly) {
    const auto found =
        diff(settings_of("spool: /a\nprinters: {p: {address: tcp://a}, q: {address: tcp://b}}\n"),
             settings_of("spool: /b\nprinters: {p: {address: tcp://c}, q: {address: tcp://b, profile: jet3}}\n"));
    ASSERT_EQ(found.size(), 3U);
    const auto blocked = blocking(found, [](std::string_view printer) { return printer == "q"; });
    ASSERT_EQ(blocked.size(), 1U);
    EXPECT_EQ(blocked.front().key, "printers.q.profile");
    EXPECT_THAT(blocking(found, [](std::string_view) { return false; }), IsEmpty());
}

TEST(Reload, shouldKeepWhatOnlyARestartChanges) {
    const Settings before = settings_of("spool: /a\nreal_time: {priority: 5}\nhttp: {port: 80, max_connections: 5}\n");
    const Settings after = settings_of("spool: /b\nhttp: {port: 81, max_connections: 6}\n");
    const Settings running = without_restart(before, after);
    EXPECT_EQ(running.spool, "/a");
    EXPECT_EQ(running.http.port, 80);
    EXPECT_EQ(running.http.max_connections, 6U);
    EXPECT_EQ(running.real_time.priority, 5);
    for (const Change& change : diff(running, after)) {
        EXPECT_EQ(change.applies, Applies::restart) << change.key;
    }
    for (const Change& change : diff(before, running)) {
        EXPECT_NE(change.applies, Applies::restart) << change.key;
    }
}

/// The address stays until a restart: so must what protects it.
TEST(Reload, shouldNotTakeTheTokensAwayFromAnAddressThatOthersReach) {
    const Settings before = settings_of("http: {listen: 0.0.0.0, tokens_file: t}\n");
    const Settings running = without_restart(before, settings_of("http: {listen: 127.0.0.1}\n"));
    EXPECT_EQ(running.http.listen, "0.0.0.0");
    EXPECT_EQ(running.http.tokens_file, "/e/t");
}

TEST(Reload, shouldKnowEveryKeyThatAPrinterCanHave) {
    EXPECT_EQ(with_wildcards("printers.line1.queue.chain"), "printers.*.queue.chain");
    EXPECT_EQ(with_wildcards("printers.line1"), "printers.*");
    EXPECT_EQ(with_wildcards("printers"), "printers");
    EXPECT_EQ(with_wildcards("http.port"), "http.port");
}

} // namespace
} // namespace linefeed::config
