// What the doctor finds, and what it advises.
#include "canned_service.hpp"
#include "client/doctor_checks.hpp"
#include "client/doctor_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace linefeed::client {
namespace {

using testing::HasSubstr;

std::string severity(const Json& finding) {
    EXPECT_EQ(text(finding, "severity") == "ok", text(finding, "advice").empty()) << finding;
    return text(finding, "severity");
}

TEST(DoctorChecks, shouldWarnOfTwoVersions) {
    EXPECT_EQ(severity(check_version("1.0", "1.0")), "ok");
    EXPECT_EQ(severity(check_version("1.0", "1.1")), "warning");
}

TEST(DoctorChecks, shouldLookAtTheDiskOfTheSpool) {
    constexpr std::uint64_t gib = 1ULL << 30U;
    EXPECT_EQ(severity(check_disk("/s/spool.db", DiskFacts{50 * gib, 100 * gib, "", false})), "ok");
    EXPECT_EQ(severity(check_disk("/s/spool.db", DiskFacts{1 * gib, 100 * gib, "", false})), "warning");
    EXPECT_EQ(severity(check_disk("/s/spool.db", DiskFacts{gib / 10, 100 * gib, "", false})), "problem");
    EXPECT_EQ(severity(check_disk("/s/spool.db", DiskFacts{50 * gib, 100 * gib, "NFS", false})), "problem");
    EXPECT_EQ(severity(check_disk("/s/spool.db", DiskFacts{50 * gib, 100 * gib, "", true})), "problem");
    EXPECT_EQ(severity(check_disk("/s/spool.db", std::nullopt)), "warning");
}

TEST(DoctorChecks, shouldKnowTheDiskThatThisTestRunsOn) {
    const auto facts = disk_facts(std::filesystem::current_path());
    ASSERT_TRUE(facts);
    EXPECT_GT(facts->all_bytes, facts->free_bytes);
    EXPECT_FALSE(disk_facts("/nowhere"));
    EXPECT_FALSE(disk_facts("/etc/passwd"));
}

TEST(DoctorChecks, shouldLookAtTheClock) {
    EXPECT_EQ(severity(check_clock({1795376750123000000, true})), "ok");
    EXPECT_EQ(severity(check_clock({1795376750123000000, false})), "warning");
    EXPECT_EQ(severity(check_clock({1000, true})), "problem");
}

TEST(DoctorChecks, shouldReadWhatTheFeedThreadWasGranted) {
    EXPECT_EQ(severity(check_real_time("feed thread: SCHED_FIFO priority 50 granted", 950000)), "ok");
    EXPECT_EQ(severity(check_real_time("feed thread: locked memory refused (…; raise LimitMEMLOCK)", 950000)),
              "warning");
    EXPECT_EQ(severity(check_real_time("", 950000)), "warning");
    EXPECT_EQ(severity(check_real_time("feed thread: SCHED_FIFO priority 50 granted", 0)), "problem");
    EXPECT_EQ(severity(check_real_time("feed thread: SCHED_FIFO priority 50 granted", -1)), "ok");
}

class Doctor : public testing::Test {
protected:
    Doctor() {
        service.answer("GET /version", {{"version", "1.0"}, {"api", "v1"}});
        service.answer("GET /api/v1/status", {{"version", "1.0"}, {"real_time", "feed thread: SCHED_FIFO granted"}});
    }
    [[nodiscard]] std::filesystem::path config(const std::string& text) const {
        std::ofstream{service.directory() / "linefeed.yaml"} << text;
        return service.directory() / "linefeed.yaml";
    }
    [[nodiscard]] std::filesystem::path good_config() const {
        return config("spool: " + std::filesystem::current_path().string() +
                      "/spool.db\ncontrol: {socket: " + service.socket().string() + "}\n");
    }
    std::pair<ExitCode, Json> run(const std::filesystem::path& config) {
        testing::internal::CaptureStdout();
        const ExitCode code = run_doctor({{{service.socket(), "", ""}, true}, config, "1.0"});
        return {code, Json::parse(testing::internal::GetCapturedStdout())};
    }
    static std::string of(const Json& report, const std::string& check) {
        for (const Json& finding : items(report)) {
            if (text(finding, "check") == check) {
                return severity(finding);
            }
        }
        return "not checked";
    }

    CannedService service;
};

TEST_F(Doctor, shouldTellWhatTheServiceFindsToo) {
    service.answer(
        "GET /api/v1/doctor",
        {{"ok", false}, {"items", {{{"check", "storage"}, {"severity", "problem"}, {"words", "x"}, {"advice", "y"}}}}});
    const auto [code, report] = run(good_config());
    EXPECT_EQ(code, ExitCode::other);
    EXPECT_EQ(report["ok"], false);
    EXPECT_EQ(of(report, "storage"), "problem");
    EXPECT_EQ(of(report, "socket"), "ok");
    EXPECT_EQ(of(report, "version"), "ok");
    EXPECT_EQ(of(report, "configuration"), "ok");
}

TEST_F(Doctor, shouldEndWellWhereNothingIsWrong) {
    service.answer("GET /api/v1/doctor", {{"ok", true}, {"items", Json::array()}});
    const auto [code, report] = run(good_config());
    if (of(report, "spool disk") == "problem") {
        GTEST_SKIP() << "the disk of this machine is full, or no disk";
    }
    EXPECT_EQ(code, ExitCode::done) << report;
    EXPECT_EQ(report["ok"], true);
}

TEST_F(Doctor, shouldFindAConfigurationThatIsWrongOrOfAnotherService) {
    service.answer("GET /api/v1/doctor", {{"ok", true}, {"items", Json::array()}});
    const auto [code, report] = run(config("htp: {}\n"));
    EXPECT_EQ(code, ExitCode::other);
    EXPECT_EQ(of(report, "configuration"), "problem");
    EXPECT_EQ(of(run(config("control: {socket: /other}\n")).second, "configuration"), "warning");
    EXPECT_EQ(of(run("/nowhere.yaml").second, "configuration"), "problem");
}

TEST_F(Doctor, shouldSayOnceThatThereIsNoService) {
    testing::internal::CaptureStdout();
    const ExitCode code = run_doctor({{{service.directory() / "none", "", ""}, true}, good_config(), "1.0"});
    const Json report = Json::parse(testing::internal::GetCapturedStdout());
    EXPECT_EQ(code, ExitCode::unreachable);
    EXPECT_EQ(of(report, "socket"), "problem");
    EXPECT_EQ(of(report, "service"), "not checked");
}

} // namespace
} // namespace linefeed::client
