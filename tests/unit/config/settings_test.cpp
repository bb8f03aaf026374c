// Sections, names and defaults; and the example that a plant starts from.
#include "config/settings.hpp"
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::config {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(SettingsFile, shouldGiveTheDefaultsForWhatIsLeftOut) {
    const auto settings = parse_settings(with_printer({}), "f.yaml", {});
    ASSERT_TRUE(settings);
    EXPECT_EQ(settings->spool, "/var/lib/linefeed/spool.db");
    EXPECT_EQ(settings->http.listen, "127.0.0.1");
    EXPECT_EQ(settings->http.max_body, 16U * 1024 * 1024);
    EXPECT_EQ(settings->logging.level_of(LogComponent::store), LogLevel::info);
    ASSERT_EQ(settings->printers.size(), 1U);
    const PrinterSettings& printer = settings->printers.front();
    EXPECT_EQ(printer.name, "line1");
    EXPECT_EQ(printer.profile.name, "jet3up");
    EXPECT_EQ(printer.pacing.poll_min, 1ms);
    EXPECT_EQ(printer.pacing.poll_max, 250ms);
    EXPECT_FALSE(printer.queue.autostart);
    EXPECT_EQ(printer.queue.chain, Chain::stop);
    EXPECT_EQ(settings->printer("line2"), nullptr);
    EXPECT_NE(settings->layout("names"), nullptr);
}

TEST(SettingsFile, shouldReadEverySetting) {
    const auto settings = parse_settings(R"(
spool: /s/spool.db
errors: e.yaml
real_time: {priority: 99, processor: 0, lock_memory: true}
control: {socket: /run/x.sock, group: print_ers}
http: {listen: "::1", port: 80, tokens_file: t, hosts: [a.example, "[::1]:8080"], origins: ["https://b.example:81"],
       max_body: 1 GiB, max_header: 2 KiB, max_connections: 7, request_timeout: 1 min}
logging: {level: error, target: stderr, levels: {service: trace, printer: debug, store: info, intake: warning, folder: error, api: info}}
layouts:
  a: {columns: [x, 2], delimiter: tab, header: false, skip_bad: true, encoding: unicode-hex, column_encodings: {x: latin1},
      base: 4294967295, mirrored: true, orientation: 180}
  b: {query: SELECT 1}
printers:
  p: {address: "tcp://10.0.0.1:3002", profile: "jet2neo,escapes=off", job_file: 'FFSDISK\JOBS\a.job', open_nozzle: true, errors: {5043: report},
      poll_min: 400 us, poll_max: 1 s, expected_rate: 30, connect_timeout: 1 s, reply_timeout: 500 ms, watch_interval: 1 min,
      queue: {autostart: true, chain: seamless}}
folders:
  f: {path: /d, layout: a, printer: p, pattern: "*.csv", autostart: true, watch: poll, settle: done-companion, poll_interval: 1 h,
      grown_files: print}
)",
                                         "/etc/f.yaml", {});
    ASSERT_TRUE(settings) << testing::PrintToString(lines_of(settings.error()));
    EXPECT_EQ(settings->errors_file, "/etc/e.yaml");
    EXPECT_EQ(settings->real_time, (RealTimeSettings{99, 0, true}));
    EXPECT_EQ(settings->control.group, "print_ers");
    EXPECT_THAT(settings->http.hosts, ElementsAre("a.example", "[::1]:8080"));
    EXPECT_EQ(settings->http.tokens_file, "/etc/t");
    EXPECT_EQ(settings->http.max_body, 1U << 30U);
    EXPECT_EQ(settings->http.request_timeout, 60s);
    EXPECT_EQ(settings->logging.target, LogTarget::standard_error);
    EXPECT_EQ(settings->logging.level_of(LogComponent::printer), LogLevel::debug);
    const LayoutSettings& layout = *settings->layout("a");
    EXPECT_THAT(layout.columns, ElementsAre("x", "2"));
    EXPECT_EQ(layout.delimiter, '\t');
    EXPECT_EQ(layout.base, 4294967295U);
    EXPECT_EQ(layout.column_encodings.at("x"), protocol::Charset::latin1);
    EXPECT_EQ(layout.properties(),
              (protocol::RecordProperties{true, protocol::Orientation::degrees_180, std::nullopt}));
    const PrinterSettings& printer = *settings->printer("p");
    EXPECT_EQ(printer.address, (link::PrinterAddress{link::TcpAddress{"10.0.0.1", 3002}}));
    EXPECT_EQ(printer.job_file, "FFSDISK\\JOBS\\a.job");
    EXPECT_EQ(printer.pacing.poll_min, 400us);
    EXPECT_EQ(printer.reply_timeout, 500ms);
    EXPECT_EQ(printer.watch_interval, 1min);
    EXPECT_EQ(printer.queue.chain, Chain::seamless);
    EXPECT_EQ(printer.errors.at(5043), ErrorPolicy::report);
    const FolderSettings& folder = settings->folders.front();
    EXPECT_EQ(folder.watch, Watch::poll);
    EXPECT_EQ(folder.settle, Settle::done_companion);
    EXPECT_EQ(folder.poll_interval, 1h);
    EXPECT_EQ(folder.grown_files, GrownFiles::print);
}

TEST(SettingsFile, shouldTellAllProblemsInTheOrderOfTheFile) {
    EXPECT_THAT(
        refusals_of("htpp: {}\nhttp:\n  port: 0\n  prot: 1\nprinters:\n  p: {adress: tcp://h}\n"),
        ElementsAre("f.yaml:1:1: htpp: unknown key; did you mean \"http\"? allowed here: spool, errors, real_time, "
                    "control, http, logging, layouts, printers or folders",
                    "f.yaml:3:9: http.port: expected a whole number from 1 to 65535, found \"0\"",
                    "f.yaml:4:3: http.prot: unknown key; did you mean \"port\"? allowed here: listen, port, "
                    "tokens_file, hosts, origins, max_body, max_header, max_connections or request_timeout",
                    "f.yaml:6:6: printers.p.address: missing: this key must be there",
                    "f.yaml:6:7: printers.p.adress: unknown key; did you mean \"address\"? allowed here: address, "
                    "profile, job_file, open_nozzle, errors, poll_min, poll_max, expected_rate, connect_timeout, "
                    "reply_timeout, "
                    "watch_interval or queue"));
    EXPECT_THAT(
        refusals_of("real_time: {colour: red}\n"),
        ElementsAre("f.yaml:1:13: real_time.colour: unknown key; allowed here: priority, processor or lock_memory"));
}

TEST(SettingsFile, shouldKnowThatAPrinterIsNotWatched) {
    const auto text = [](const std::string& interval) {
        return "printers:\n  p: {address: tcp://h, watch_interval: " + interval + "}\n";
    };
    EXPECT_THAT(refusals_of(text("0 s")), IsEmpty());
    EXPECT_THAT(refusals_of(text("1 s")), IsEmpty());
    EXPECT_THAT(refusals_of(text("999 ms")),
                ElementsAre("f.yaml:2:41: printers.p.watch_interval: must be 0 s (never), or 1 s at least"));
}

TEST(SettingsFile, shouldTakeTheFirstOfADoubledKeyAndSaySo) {
    EXPECT_THAT(refusals_of("http: {port: 80}\nhttp: {port: 0}\n"),
                ElementsAre("f.yaml:2:1: http: doubled key: it stands in line 1 already"));
    EXPECT_THAT(refusals_of("printers:\n  p: {address: tcp://a}\n  p: {address: tcp://b}\n"),
                ElementsAre("f.yaml:3:3: printers.p: doubled key: it stands in line 2 already"));
}

TEST(SettingsFile, shouldRefuseSectionsThatAreNoMapping) {
    EXPECT_THAT(refusals_of(""), ElementsAre("f.yaml: the file is empty"));
    EXPECT_THAT(refusals_of("- a\n"), ElementsAre("f.yaml:1:1: expected a mapping, found a list"));
    EXPECT_THAT(refusals_of("http: 8080\n"), ElementsAre("f.yaml:1:7: http: expected a mapping, found \"8080\""));
    EXPECT_THAT(
        refusals_of("http:\n"),
        ElementsAre("f.yaml:1:1: http: expected a mapping, found nothing; write {} for none, or leave the key out"));
    EXPECT_THAT(refusals_of("folders:\n"),
                ElementsAre("f.yaml:1:1: folders: expected a mapping, found nothing; write {} for none"));
    EXPECT_THAT(refusals_of("folders: {}\nprinters: {}\n"), IsEmpty());
    EXPECT_THAT(refusals_of("http: &a {port: 80}\n"),
                ElementsAre("f.yaml:1:7: http: anchors (&name) are not supported: write each value out"));
}

TEST(SettingsFile, shouldRefuseNamesThatCannotBeToldApartOrShown) {
    EXPECT_THAT(refusals_of("layouts: {line-1: {}, Line_1: {}}\n"),
                ElementsAre("f.yaml:1:23: layouts.Line_1: differs from an earlier name only in case or punctuation"));
    const std::string expected =
        "expected a name of at most 64 letters, digits, - and _ that begins with a letter or digit, "
        "found ";
    EXPECT_THAT(refusals_of("layouts: {\"a/b\": {}, -a: {}, \"\": {}, " + std::string(65, 'a') + ": {}}\n"),
                ElementsAre("f.yaml:1:11: layouts.a/b: " + expected + "\"a/b\"",
                            "f.yaml:1:22: layouts.-a: " + expected + "\"-a\"",
                            "f.yaml:1:30: layouts.: " + expected + "\"\"", testing::HasSubstr(expected)));
}

TEST(SettingsFile, shouldBeRefusedAboveAThousandElements) {
    std::string text = "layouts:\n";
    for (int i = 0; i <= 1000; ++i) {
        text += "  l" + std::to_string(i) + ": {}\n";
    }
    EXPECT_THAT(refusals_of(text), ElementsAre("f.yaml:2:3: layouts: more than 1000 entries"));
}

TEST(SettingsFile, shouldThrowTheFirstRefusalWhereAValueIsDemanded) {
    const auto refused = parse_settings("x: 1\n", "f.yaml", {});
    try {
        (void)refused.value();
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), testing::StartsWith("f.yaml:1:1: x: unknown key"));
    }
}

TEST(Example, shouldBeAcceptedAndMeanWhatItsCommentsSay) {
    const std::filesystem::path file = std::filesystem::path{LINEFEED_SOURCE_DIR} / "config" / "linefeed.yaml";
    const auto settings = load(file, {});
    ASSERT_TRUE(settings) << testing::PrintToString(lines_of(settings.error()));
    EXPECT_EQ(settings->printers.size(), 2U);
    EXPECT_EQ(settings->folders.front().pattern, "*.csv");
    EXPECT_EQ(settings->errors.entries.size(), 17U);
    EXPECT_EQ(settings->errors_file, file.parent_path() / "errors.yaml");
    // The printer's own policy goes before the table's, the table's before the one for unlisted numbers.
    const PrinterSettings& line1 = *settings->printer("line1");
    const PrinterSettings& line2 = *settings->printer("line2");
    EXPECT_EQ(settings->policy(line1, {51001}), ErrorPolicy::stop);
    EXPECT_EQ(settings->policy(line2, {51001}), ErrorPolicy::report);
    EXPECT_EQ(settings->policy(line2, {5043}), ErrorPolicy::stop);
    EXPECT_EQ(settings->policy(line2, {77}), ErrorPolicy::report);
    for (const PrinterSettings* const line : {&line1, &line2}) {
        ASSERT_EQ(settings->acknowledged(*line).size(), 1U) << "nothing but the end of a job";
        EXPECT_EQ(settings->acknowledged(*line)[0], 1223U);
    }
}

TEST(Acknowledged, shouldBeWhatThePrinterSaysAndTheTableWhereItSaysNothing) {
    Settings settings;
    settings.errors.entries = {{1223, "m", "a", ErrorPolicy::acknowledge}, {7, "m", "a", ErrorPolicy::acknowledge}};
    const PrinterSettings printer{
        .name = "p", .address = {}, .errors = {{7, ErrorPolicy::stop}, {10202, ErrorPolicy::acknowledge}}};
    const auto numbers = settings.acknowledged(printer);
    EXPECT_THAT((std::vector<std::uint32_t>{numbers.begin(), numbers.end()}), ElementsAre(1223U, 10202U));
}

} // namespace
} // namespace linefeed::config
