// Where the service and the jobs are looked for, and that both sources of jobs give the same.
#include "canned_service.hpp"
#include "client/job_source.hpp"
#include "client/ledger_command.hpp"
#include "spool/spool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace linefeed::client {
namespace {

using testing::HasSubstr;

TEST(FindService, shouldPreferOptionsToTheVariableAndThatToTheDefault) {
    EXPECT_EQ(find_service({}, "")->address.socket, default_socket);
    EXPECT_FALSE(find_service({}, "")->chosen);
    EXPECT_EQ(find_service({}, "/x")->address.socket, "/x");
    EXPECT_TRUE(find_service({}, "/x")->chosen);
    EXPECT_EQ(find_service({"/y", "", ""}, "/x")->address.socket, "/y");
    const auto tcp = find_service({"", "http://print.example:8631/", ""}, "/x");
    ASSERT_TRUE(tcp);
    EXPECT_EQ(tcp->address.host, "print.example");
    EXPECT_EQ(tcp->address.port, 8631);
    EXPECT_TRUE(tcp->address.socket.empty());
    EXPECT_EQ(find_service({"", "http://[::1]:8631", ""}, "")->address.host, "::1");
    EXPECT_EQ(find_service({"", "http://a", ""}, "")->address.port, 8631);
}

TEST(FindService, shouldRefuseWhatContradictsItself) {
    for (const ServiceOptions& options :
         {ServiceOptions{"/y", "http://a:1", ""}, ServiceOptions{"", "https://a:1", ""}, ServiceOptions{"", "a:1", ""},
          ServiceOptions{"", "http://a:1/x", ""}, ServiceOptions{"", "", "/token"}}) {
        const auto place = find_service(options, "");
        ASSERT_FALSE(place) << options.url;
        EXPECT_EQ(place.error().kind, FailureKind::usage) << options.url;
    }
}

class TokenFile : public testing::Test {
protected:
    TokenFile() { std::ofstream{file} << "lf_secret \r\nmore\n"; }
    ~TokenFile() override { std::filesystem::remove(file); }
    TokenFile(const TokenFile&) = delete;
    TokenFile& operator=(const TokenFile&) = delete;

    std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("linefeed-token-" + std::to_string(::getpid()));
};

TEST_F(TokenFile, shouldGiveItsFirstLine) {
    EXPECT_EQ(find_service({"", "http://a:1", file}, "")->token, "lf_secret");
    std::ofstream{file} << "\n";
    EXPECT_EQ(find_service({"", "http://a:1", file}, "").error().kind, FailureKind::usage);
    EXPECT_EQ(find_service({"", "http://a:1", "/nowhere"}, "").error().kind, FailureKind::input);
}

TEST(SocketTrouble, shouldSayWhatIsWrongWithThePlace) {
    const CannedService service;
    EXPECT_EQ(socket_trouble(service.socket()).words, "");
    EXPECT_THAT(socket_trouble("/nowhere/at/all").words, HasSubstr("there is no service at /nowhere/at/all"));
    EXPECT_THAT(socket_trouble(service.directory()).words, HasSubstr("is no socket"));
}

class Sources : public testing::Test {
protected:
    Sources() {
        auto spool = spool::Spool::open(file, {[] { return std::int64_t{1795376750123000000}; }, {}}).value();
        spool::JobSpec spec;
        spec.source.path = "/data/names.csv";
        auto import = spool.begin_import(spec).value();
        RecordPage page{RecordNumber{1}, {}, {}};
        for (int k = 1; k <= 5; ++k) {
            page.frames += "^0=MR" + std::to_string(k) + "\tM\xFCller " + std::to_string(k) + "\r";
            page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
        }
        EXPECT_TRUE(import.add(page));
        job = import.commit({}).value();
    }

    /// A run over the whole job whose ledger says the rest.
    void run(spool::LedgerKind kind, std::uint32_t first, std::uint32_t last) {
        auto spool = spool::Spool::open(file, {[] { return std::int64_t{1795376750123000000}; }, {}}).value();
        const spool::RunId run = spool.begin_run(job.id, job.records, "{}").value();
        const std::vector<spool::LedgerEntry> entries{
            {spool::LedgerKind::intent, run, RecordRange::closed(RecordNumber{first}, RecordNumber{last}), ""},
            {kind, run, RecordRange::closed(RecordNumber{first}, RecordNumber{last}), "{}"}};
        ASSERT_TRUE(spool.append(job.id, entries));
    }
    std::string phase() {
        auto source = spool_source(file).value();
        return source->job(1).value()["phase"];
    }

    CannedService service;
    std::filesystem::path file = service.directory() / "spool.db";
    spool::Job job;
};

TEST_F(Sources, shouldGiveTheSameMembersOfAJob) {
    auto from_file = spool_source(file).value()->job(1).value();
    const Json from_service = job_json(1, "ready");
    for (const auto& [name, value] : from_service.items()) {
        EXPECT_TRUE(from_file.contains(name)) << name;
    }
    EXPECT_EQ(from_file.size(), from_service.size());
    EXPECT_EQ(from_file["name"], "names.csv");
    EXPECT_EQ(from_file["records"]["count"], 5);
}

TEST_F(Sources, shouldTellAJobsStateFromItsLedger) {
    EXPECT_EQ(phase(), "ready");
    run(spool::LedgerKind::printed, 1, 2);
    EXPECT_EQ(phase(), "stopped");
    run(spool::LedgerKind::printed, 3, 5);
    EXPECT_EQ(phase(), "finished");
}

TEST_F(Sources, shouldTellDoubtFromTheLedger) {
    run(spool::LedgerKind::in_doubt, 1, 2);
    EXPECT_EQ(phase(), "in_doubt");
}

TEST_F(Sources, shouldCutTheHistoryToTheRecordsThatAreWanted) {
    run(spool::LedgerKind::printed, 1, 4);
    auto source = spool_source(file).value();
    const auto history = source->history(1, RecordRange::closed(RecordNumber{3}, RecordNumber{9})).value();
    ASSERT_EQ(history.size(), 1U);
    EXPECT_EQ(history[0]["first"], 3);
    EXPECT_EQ(history[0]["last"], 4);
    EXPECT_EQ(history[0]["count"], 2);
    std::vector<std::string> texts;
    EXPECT_TRUE(source->records(1, RecordRange::closed(RecordNumber{3}, RecordNumber{4}), [&](const Json& record) {
        texts.push_back(record["fields"][0]);
        return true;
    }));
    EXPECT_EQ(texts, (std::vector<std::string>{"Müller 3", "Müller 4"}));
}

struct Said {
    cli::ExitCode code = cli::ExitCode::other;
    std::string out;
    std::string err;
};

Said run_captured(const JobsOptions& options) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Said said;
    said.code = run_jobs(options);
    said.out = testing::internal::GetCapturedStdout();
    said.err = testing::internal::GetCapturedStderr();
    return said;
}

TEST_F(Sources, shouldShowTheSameTableFromBoth) {
    Json one = job_json(1, "ready");
    one["printer"] = nullptr;
    one["records"] = {{"first", 1}, {"last", 5}, {"count", 5}};
    service.answer("GET /api/v1/jobs?limit=51", page({one}));
    const Said from_file = run_captured({{{}, file, ""}, {}, false});
    const Said from_service = run_captured({{{service.socket(), "", ""}, "", ""}, {}, false});
    EXPECT_EQ(from_file.code, cli::ExitCode::done);
    EXPECT_EQ(from_file.err, "");
    EXPECT_THAT(from_file.out, HasSubstr("names.csv"));
    EXPECT_EQ(from_file.out, from_service.out);
}

TEST_F(Sources, shouldSayWhichFileIsReadWithoutAService) {
    ::unsetenv("LINEFEED_SOCKET");
    if (std::filesystem::exists(default_socket)) {
        GTEST_SKIP() << "a service runs on this machine";
    }
    const Said said = run_captured({{{}, "", file}, {}, true});
    EXPECT_EQ(said.code, cli::ExitCode::done);
    EXPECT_THAT(said.err, HasSubstr("there is no service at"));
    EXPECT_THAT(said.err, HasSubstr(file.string()));
    EXPECT_EQ(Json::parse(said.out)[0]["id"], 1);
}

TEST_F(Sources, shouldNotReadTheFileWhereAServiceIsChosen) {
    const Said said = run_captured({{{service.directory() / "none", "", ""}, "", file}, {}, false});
    EXPECT_EQ(said.code, cli::ExitCode::unreachable);
    EXPECT_EQ(run_captured({{{service.socket(), "", ""}, file, ""}, {}, false}).code, cli::ExitCode::usage);
}

TEST_F(Sources, shouldSayThatThereAreMoreJobs) {
    service.answer("GET /api/v1/jobs?limit=2&printer=line1&phase=stopped,in_doubt",
                   page({job_json(3, "stopped"), job_json(2, "stopped")}));
    const Said said = run_captured({{{service.socket(), "", ""}, "", ""}, {"line1", {"stopped", "in_doubt"}, 1}, true});
    EXPECT_EQ(Json::parse(said.out).size(), 1U);
    EXPECT_THAT(said.err, HasSubstr("--limit"));
}

TEST_F(Sources, shouldRefuseAJobThatIsNotThere) {
    EXPECT_EQ(spool_source(file).value()->job(2).error().kind, FailureKind::usage);
    EXPECT_EQ(spool_source("/nowhere/spool.db").error().kind, FailureKind::usage);
}

} // namespace
} // namespace linefeed::client
