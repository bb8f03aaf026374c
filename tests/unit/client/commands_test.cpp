// What the subcommands ask of the service, what they say, and with which exit code they end.
#include "canned_service.hpp"
#include "client/events_command.hpp"
#include "client/import_command.hpp"
#include "client/job_commands.hpp"
#include "client/printer_commands.hpp"
#include "client/service_commands.hpp"
#include "client/start_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace linefeed::client {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Said {
    ExitCode code = ExitCode::other;
    std::string out;
    std::string err;
};

template <typename Run, typename Options>
Said run(Run command, const Options& options) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Said said;
    said.code = command(options);
    said.out = testing::internal::GetCapturedStdout();
    said.err = testing::internal::GetCapturedStderr();
    return said;
}

class Commands : public testing::Test {
protected:
    [[nodiscard]] CommonOptions common(bool json = false) const { return {{service.socket(), "", ""}, json}; }
    [[nodiscard]] StartOptions start_of(std::int64_t job, bool wait = false) const { return {common(), job, "", wait}; }
    std::filesystem::path write(const std::string& name, const std::string& content) const {
        std::ofstream{service.directory() / name} << content;
        return service.directory() / name;
    }
    /// The bodies of the requests with this line.
    std::vector<Json> bodies(const std::string& line) {
        std::vector<Json> found;
        for (const AskedRequest& request : service.asked()) {
            if (request.line == line) {
                found.push_back(request.body.empty() ? Json(nullptr) : Json::parse(request.body));
            }
        }
        return found;
    }
    void answer_job(const Json& job) { service.answer("GET /api/v1/jobs/12", job); }

    CannedService service;
};

TEST_F(Commands, shouldEndWithTheCodeOfTheProblemsKind) {
    const std::vector<std::pair<std::string, ExitCode>> codes{
        {"usage", ExitCode::usage},          {"unreachable", ExitCode::unreachable}, {"stopped", ExitCode::stopped},
        {"input", ExitCode::input_rejected}, {"in_doubt", ExitCode::in_doubt},       {"storage", ExitCode::other},
        {"internal", ExitCode::other}};
    for (const auto& [kind, code] : codes) {
        CannedService other;
        other.problem("GET /api/v1/jobs/12", 409, kind, "what it is\x1B", {{"advice", "what to do"}});
        const Said said = run(run_job, JobOptions{{{other.socket(), "", ""}, false}, 12});
        EXPECT_EQ(said.code, code) << kind;
        EXPECT_EQ(said.err, "linefeed: what it is\\x1B: what to do\n");
        EXPECT_EQ(said.out, "");
    }
}

TEST_F(Commands, shouldTellAFailureAsJsonOnStdoutToo) {
    service.problem("GET /api/v1/jobs/12", 404, "usage", "there is no job 12");
    const Said said = run(run_job, JobOptions{common(true), 12});
    EXPECT_EQ(Json::parse(said.out), (Json{{"result", "usage"}, {"message", "there is no job 12"}, {"exit_code", 2}}));
}

TEST_F(Commands, shouldSayWhatToDoWithoutAService) {
    const std::filesystem::path nowhere = service.directory() / "none";
    const Said said = run(run_status, CommonOptions{{nowhere, "", ""}, false});
    EXPECT_EQ(said.code, ExitCode::unreachable);
    EXPECT_EQ(said.err, "linefeed: there is no service at " + nowhere.string() +
                            ": is linefeedd running? (systemctl status linefeedd)\n");
}

TEST_F(Commands, shouldNotBlameTheServiceForAPrinterThatIsAway) {
    service.problem("POST /api/v1/printers/line1/preflight", 502, "unreachable", "line1 does not answer");
    const Said said = run(run_preflight, PrinterOptions{common(), "line1"});
    EXPECT_EQ(said.code, ExitCode::unreachable);
    EXPECT_EQ(said.err, "linefeed: line1 does not answer\n");
}

TEST_F(Commands, shouldStartWithAKeyAndShowWhereTheJobStands) {
    service.answer("POST /api/v1/jobs/12/start", {{"job", 12}}, 202);
    answer_job(job_json(12, "arming"));
    const Said said = run(run_start, start_of(12));
    EXPECT_EQ(said.code, ExitCode::done);
    EXPECT_EQ(said.out, "job 12 (names.csv): arming, 0 of 1000 records printed, next 1\n");
    EXPECT_EQ(service.asked().front().fields["idempotency-key"].size(), 32U);
}

TEST_F(Commands, shouldRepeatAStartWithTheSameKeyWhenTheAnswerIsLost) {
    service.hang_up("POST /api/v1/jobs/12/start");
    service.answer("POST /api/v1/jobs/12/start", {{"job", 12}}, 202);
    answer_job(job_json(12, "arming"));
    EXPECT_EQ(run(run_start, start_of(12)).code, ExitCode::done);
    const auto asked = service.asked();
    ASSERT_GE(asked.size(), 2U);
    EXPECT_EQ(asked[0].line, asked[1].line);
    EXPECT_EQ(asked[0].fields.at("idempotency-key"), asked[1].fields.at("idempotency-key"));
}

TEST_F(Commands, shouldStartTheNextJobOfAPrinter) {
    service.answer("POST /api/v1/printers/line%201/start", {{"job", 12}}, 202);
    answer_job(job_json(12, "arming"));
    EXPECT_EQ(run(run_start, StartOptions{common(), std::nullopt, "line 1", false}).code, ExitCode::done);
    EXPECT_THAT(bodies("POST /api/v1/printers/line%201/start"), ElementsAre(Json(nullptr)));
}

TEST_F(Commands, shouldStartAJobOnTheNamedPrinter) {
    service.answer("POST /api/v1/printers/line1/start", {{"job", 12}}, 202);
    answer_job(job_json(12, "arming"));
    EXPECT_EQ(run(run_start, StartOptions{common(), 12, "line1", false}).code, ExitCode::done);
    EXPECT_THAT(bodies("POST /api/v1/printers/line1/start"), ElementsAre(Json{{"job", 12}}));
}

TEST_F(Commands, shouldShowTheRecordsInDoubtWhenTheyKeepAJobFromStarting) {
    service.problem("POST /api/v1/jobs/12/start", 409, "in_doubt", "3 records are in doubt");
    service.answer("GET /api/v1/jobs/12/doubt",
                   {{"count", 1}, {"records", {{{"number", 501}, {"fields", {"Müller"}}}}}, {"hole", nullptr}});
    const Said said = run(run_start, start_of(12));
    EXPECT_EQ(said.code, ExitCode::in_doubt);
    EXPECT_THAT(said.out, HasSubstr("501  Müller\n"));
    EXPECT_THAT(said.out, HasSubstr("linefeed settle 12 --last-printed"));
}

TEST_F(Commands, shouldWaitUntilTheJobStands) {
    const std::vector<std::pair<std::string, ExitCode>> ends{{"finished", ExitCode::done},
                                                             {"stopped", ExitCode::stopped},
                                                             {"in_doubt", ExitCode::in_doubt},
                                                             {"failed", ExitCode::input_rejected},
                                                             {"cancelled", ExitCode::other}};
    for (const auto& [phase, code] : ends) {
        CannedService other;
        other.answer("POST /api/v1/jobs/12/start", {{"job", 12}}, 202);
        other.answer("GET /api/v1/jobs/12", job_json(12, "arming"));
        other.answer("GET /api/v1/jobs/12", job_json(12, "printing", 500));
        other.answer("GET /api/v1/jobs/12", job_json(12, phase, 700));
        Json printer = printer_json("line1");
        other.answer("GET /api/v1/printers/line1", printer);
        printer["heard_ns"] = 1795376750123000001;
        other.answer("GET /api/v1/printers/line1", printer);
        const Said said = run(run_start, StartOptions{{{other.socket(), "", ""}, false}, 12, "", true});
        EXPECT_EQ(said.code, code) << phase << said.err;
        EXPECT_THAT(said.out, HasSubstr("700 of 1000")) << phase;
    }
}

TEST_F(Commands, shouldTellAPrinterThatWasNeverReachedFromAJobThatStopped) {
    for (const auto& [heard_later, code] : {std::pair{false, ExitCode::unreachable}, {true, ExitCode::stopped}}) {
        CannedService other;
        other.answer("POST /api/v1/jobs/12/start", {{"job", 12}}, 202);
        other.answer("GET /api/v1/jobs/12", job_json(12, "queued", 300));
        other.answer("GET /api/v1/jobs/12", job_json(12, "stopped", 300));
        Json printer = printer_json("line1");
        other.answer("GET /api/v1/printers/line1", printer);
        printer["heard_ns"] = printer["heard_ns"].get<std::int64_t>() + (heard_later ? 1 : 0);
        other.answer("GET /api/v1/printers/line1", printer);
        EXPECT_EQ(run(run_start, StartOptions{{{other.socket(), "", ""}, false}, 12, "", true}).code, code);
    }
}

TEST_F(Commands, shouldGoOnWaitingWhenTheServiceIsAwayForAMoment) {
    service.answer("POST /api/v1/jobs/12/start", {{"job", 12}}, 202);
    answer_job(job_json(12, "queued"));
    answer_job(job_json(12, "arming"));
    for (int i = 0; i < 2; ++i) { // the question is asked twice before the connection counts as lost
        service.hang_up("GET /api/v1/jobs/12");
    }
    answer_job(job_json(12, "finished", 1000));
    service.answer("GET /api/v1/printers/line1", printer_json("line1"));
    const Said said = run(run_start, start_of(12, true));
    EXPECT_EQ(said.code, ExitCode::done);
    EXPECT_THAT(said.err, HasSubstr("waiting for it"));
    EXPECT_THAT(said.err, HasSubstr("there again"));
}

TEST_F(Commands, shouldSettleBeforeResuming) {
    service.answer("POST /api/v1/jobs/12/settle", {{"job", 12}});
    service.answer("POST /api/v1/jobs/12/resume", {{"job", 12}}, 202);
    answer_job(job_json(12, "arming", 500));
    ResumeOptions options{common(), 12, {}, false};
    options.word.last_printed = "500";
    EXPECT_EQ(run(run_resume, options).code, ExitCode::done);
    EXPECT_THAT(service.lines(),
                ElementsAre("POST /api/v1/jobs/12/settle", "POST /api/v1/jobs/12/resume", "GET /api/v1/jobs/12"));
    EXPECT_THAT(bodies("POST /api/v1/jobs/12/settle"), ElementsAre(Json{{"last_printed", "500"}}));
}

TEST_F(Commands, shouldNotResumeOnAWordThatIsRefused) {
    service.problem("POST /api/v1/jobs/12/settle", 422, "usage", "500 is not in doubt");
    ResumeOptions options{common(), 12, {}, false};
    options.word.printed = "500";
    EXPECT_EQ(run(run_resume, options).code, ExitCode::usage);
    EXPECT_THAT(service.lines(), ElementsAre("POST /api/v1/jobs/12/settle"));
}

TEST(SettleRequest, shouldHaveExactlyWhatWasSaid) {
    daemon::OperatorWord word;
    word.policy = daemon::InDoubtPolicy::skip;
    EXPECT_EQ(settle_request(word), (Json{{"in_doubt", "skip"}}));
    word.policy = daemon::InDoubtPolicy::reprint;
    EXPECT_EQ(settle_request(word), (Json{{"in_doubt", "reprint"}}));
    word = {};
    word.printed = "none";
    EXPECT_EQ(settle_request(word), (Json{{"printed", "none"}}));
}

TEST_F(Commands, shouldShowDoubtAndSettleNothingWithoutAWord) {
    service.answer("GET /api/v1/jobs/12/doubt",
                   {{"count", 1}, {"records", {{{"number", 501}, {"fields", {"x"}}}}}, {"hole", nullptr}});
    const Said said = run(run_settle, SettleOptions{common(), 12, {}});
    EXPECT_EQ(said.code, ExitCode::in_doubt);
    EXPECT_THAT(said.out, HasSubstr("501  x\n"));
    EXPECT_THAT(service.lines(), ElementsAre("GET /api/v1/jobs/12/doubt"));
}

TEST_F(Commands, shouldDoNoHarmWithoutAYesWhereNobodyCanBeAsked) {
    answer_job(job_json(12, "stopped", 500));
    EXPECT_EQ(run(run_cancel, CancelOptions{common(), 12, false}).code, ExitCode::usage);
    const Said said = run(run_reprint, ReprintOptions{common(), 12, "7-9,3", "smeared", false});
    EXPECT_EQ(said.code, ExitCode::usage);
    EXPECT_EQ(said.err, "linefeed: print 4 records once more (3, 7-9) of job 12 (names.csv), 500 of 1000 records "
                        "printed? Nobody can be asked here: say --yes\n");
    EXPECT_THAT(service.lines(), ElementsAre("GET /api/v1/jobs/12", "GET /api/v1/jobs/12"));
}

TEST_F(Commands, shouldReprintWithAReason) {
    answer_job(job_json(12, "stopped", 500));
    service.answer("POST /api/v1/jobs/12/reprint", {{"job", 12}});
    EXPECT_EQ(run(run_reprint, ReprintOptions{common(), 12, "7-9,3", "smeared", true}).code, ExitCode::done);
    EXPECT_THAT(bodies("POST /api/v1/jobs/12/reprint"), ElementsAre(Json{{"records", "7-9,3"}, {"reason", "smeared"}}));
}

TEST_F(Commands, shouldRefuseRecordsThatAreNoneBeforeAnythingIsAsked) {
    for (const char* records : {"x", "9-7", "3,3", "none", ""}) {
        EXPECT_EQ(run(run_reprint, ReprintOptions{common(), 12, records, "smeared", true}).code, ExitCode::usage)
            << records;
    }
    EXPECT_THAT(service.lines(), IsEmpty());
}

TEST_F(Commands, shouldStopTheNamedPrinterAtOnce) {
    service.answer("POST /api/v1/printers/line1/stop", {{"printer", "line1"}});
    service.answer("GET /api/v1/jobs?printer=line1&phase=stopped,in_doubt&limit=10",
                   page({job_json(12, "stopped", 500)}));
    const Said said = run(run_stop, StopOptions{common(), "line1", false});
    EXPECT_EQ(said.code, ExitCode::done);
    EXPECT_EQ(said.out, "line1: stopped\n  job 12 (names.csv): stopped, 500 of 1000 records printed, next 501\n");
    EXPECT_EQ(service.lines().front(), "POST /api/v1/printers/line1/stop");
    EXPECT_EQ(service.asked().front().fields.count("idempotency-key"), 0U);
}

TEST_F(Commands, shouldSayThatAStopHasLeftDoubt) {
    service.answer("POST /api/v1/printers/line1/stop", {{"printer", "line1"}});
    service.answer("GET /api/v1/jobs?printer=line1&phase=stopped,in_doubt&limit=10",
                   page({job_json(12, "in_doubt", 500, 2)}));
    EXPECT_EQ(run(run_stop, StopOptions{common(), "line1", false}).code, ExitCode::in_doubt);
}

TEST_F(Commands, shouldNotGuessWhichOfSeveralPrintersToStop) {
    Json one = printer_json("line1");
    Json two = printer_json("line2");
    one["phase"] = two["phase"] = "printing";
    service.answer("GET /api/v1/printers", page({one, two, printer_json("line3")}));
    service.answer("POST /api/v1/printers/line1/stop", {{"printer", "line1"}});
    service.problem("POST /api/v1/printers/line2/stop", 502, "unreachable", "line2 does not answer");
    service.answer("GET /api/v1/jobs?printer=line1&phase=stopped,in_doubt&limit=10", page({}));
    const Said said = run(run_stop, StopOptions{common(), "", false});
    EXPECT_EQ(said.code, ExitCode::usage);
    EXPECT_THAT(said.err, HasSubstr("line1, line2"));
    const Said all = run(run_stop, StopOptions{common(), "", true});
    EXPECT_EQ(all.code, ExitCode::unreachable);
    EXPECT_EQ(all.out, "line1: stopped\n");
    EXPECT_THAT(all.err, HasSubstr("line2 does not answer"));
    EXPECT_THAT(service.lines(), testing::Contains("POST /api/v1/printers/line1/stop"));
    EXPECT_THAT(service.lines(), testing::Contains("POST /api/v1/printers/line2/stop"));
}

TEST_F(Commands, shouldNameTheFileToTheServiceByItsWholePath) {
    const auto file = write("names.csv", "name\nMüller\n");
    service.answer(
        "POST /api/v1/jobs",
        {{"job", 12}, {"duplicate", false}, {"report", {{"records", 1}, {"bad_rows", 0}, {"reported", Json::array()}}}},
        201);
    ImportOptions options{common(), file, "", "", "line1", true, false, false};
    const Said said = run(run_import, options);
    EXPECT_EQ(said.code, ExitCode::done);
    EXPECT_EQ(said.out, "imported 1 records as job 12, in the queue of line1\n");
    EXPECT_THAT(bodies("POST /api/v1/jobs"),
                ElementsAre(Json{{"file", file.string()}, {"printer", "line1"}, {"autostart", true}}));
}

TEST_F(Commands, shouldSayThatAFileWasThereAlready) {
    service.answer("POST /api/v1/jobs", {{"job", 7}, {"duplicate", true}, {"report", nullptr}});
    const Said said = run(run_import, ImportOptions{common(), write("a.csv", "x\n"), "", "", "", false, false, false});
    EXPECT_EQ(said.code, ExitCode::done);
    EXPECT_THAT(said.out, HasSubstr("job 7 already"));
}

TEST_F(Commands, shouldNameEveryBadRowOfARejectedFile) {
    const auto file = write("names.csv", "name\n\x01\n");
    service.problem(
        "POST /api/v1/jobs", 422, "input", "1 of 1 rows cannot be printed",
        {{"report",
          {{"bad_rows", 2}, {"reported", {{{"line", 2}, {"column", "name"}, {"reason", "\x01 cannot be printed"}}}}}}});
    const Said said = run(run_import, ImportOptions{common(), file, "", "", "", false, false, false});
    EXPECT_EQ(said.code, ExitCode::input_rejected);
    EXPECT_EQ(said.err, "linefeed: " + file.string() + ": line 2, column name: \\x01 cannot be printed\n" +
                            "linefeed: " + file.string() + ": and 1 more bad rows\n" +
                            "linefeed: 1 of 1 rows cannot be printed\n");
}

TEST_F(Commands, shouldUploadWithItsNameAndType) {
    const auto file = write("a b.csv", "x\ny\n");
    service.answer("POST /api/v1/jobs?name=a%20b.csv&layout=names",
                   {{"job", 12}, {"duplicate", false}, {"report", nullptr}}, 201);
    EXPECT_EQ(run(run_import, ImportOptions{common(), file, "", "names", "", false, false, true}).code, ExitCode::done);
    EXPECT_EQ(service.asked().front().body, "x\ny\n");
    EXPECT_EQ(service.asked().front().fields["content-type"], "text/csv");
}

TEST_F(Commands, shouldNotUploadADatabaseOfWhichAPartLiesBesideIt) {
    const auto file = write("names.db", std::string("SQLite format 3\0....", 20));
    write("names.db-wal", "frames");
    const Said said = run(run_import, ImportOptions{common(), file, "", "", "", false, false, true});
    EXPECT_EQ(said.code, ExitCode::input_rejected);
    EXPECT_THAT(said.err, HasSubstr("names.db-wal"));
    EXPECT_THAT(service.lines(), IsEmpty());
}

TEST_F(Commands, shouldRefuseAFileThatIsNotThereByItself) {
    EXPECT_EQ(run(run_import, ImportOptions{common(), "/nowhere/x.csv", "", "", "", false, false, false}).code,
              ExitCode::input_rejected);
    EXPECT_EQ(run(run_import, ImportOptions{common(), service.directory(), "", "", "", false, false, false}).code,
              ExitCode::input_rejected);
    EXPECT_THAT(service.lines(), IsEmpty());
}

TEST_F(Commands, shouldEndAPreflightThatFindsAProblemAsStopped) {
    service.answer(
        "POST /api/v1/printers/line1/preflight",
        {{"ok", false},
         {"items", {{{"check", "cover"}, {"severity", "problem"}, {"words", "open"}, {"advice", "close it"}}}}});
    EXPECT_EQ(run(run_preflight, PrinterOptions{common(), "line1"}).code, ExitCode::stopped);
}

std::string streamed(const Json& event) {
    return "id: " + std::to_string(event["id"].get<int>()) + "\nevent: " + event["kind"].get<std::string>() +
           "\ndata: " + event.dump() + "\n\n";
}

TEST_F(Commands, shouldShowEachEventOnceOverALostConnection) {
    Json first = page({event_json(7, "job.started", "seven")});
    first["last_id"] = 7;
    service.answer("GET /api/v1/events?limit=1", first);
    service.answer("GET /api/v1/events?limit=1000&after=0", first);
    service.stream("GET /api/v1/events/stream", ": heartbeat\n\n" + streamed(event_json(8, "job.printing", "eight")));
    service.stream("GET /api/v1/events/stream",
                   streamed(event_json(8, "job.printing", "eight")) + streamed(event_json(9, "job.finished", "nine")));
    service.problem("GET /api/v1/events/stream", 401, "usage", "enough");
    EventsOptions options;
    options.common = common(true);
    options.follow = true;
    const Said said = run(run_events, options);
    EXPECT_EQ(said.code, ExitCode::usage);
    std::vector<std::string> messages;
    std::istringstream lines{said.out};
    for (std::string line; std::getline(lines, line) && line.find("\"id\"") != std::string::npos;) {
        messages.push_back(Json::parse(line)["message"]);
    }
    EXPECT_THAT(messages, ElementsAre("seven", "eight", "nine"));
    std::vector<std::string> asked;
    for (const AskedRequest& request : service.asked()) {
        if (request.line == "GET /api/v1/events/stream") {
            asked.push_back(request.fields.at("last-event-id"));
        }
    }
    EXPECT_THAT(asked, ElementsAre("7", "8", "9"));
}

TEST_F(Commands, shouldSayWhichEventsAreNotKeptAnyMore) {
    service.answer("GET /api/v1/events?limit=1000&after=3", page({event_json(7, "job.started", "seven")}));
    service.stream("GET /api/v1/events/stream", streamed(event_json(10, "job.printing", "ten")));
    service.problem("GET /api/v1/events/stream", 401, "usage", "enough");
    EventsOptions options;
    options.common = common();
    options.after = 3;
    options.follow = true;
    const Said said = run(run_events, options);
    EXPECT_THAT(said.err, HasSubstr("the events 4 to 6 are not kept any more"));
    EXPECT_THAT(said.err, HasSubstr("the events 8 to 9 are not kept any more"));
}

TEST_F(Commands, shouldShowOnlyEventsThatAreAskedFor) {
    Json other = event_json(2, "job.started", "other");
    other["printer"] = "line2";
    Json all = page({event_json(1, "job.started", "mine"), other});
    all["last_id"] = 2;
    service.answer("GET /api/v1/events?limit=1", all);
    service.answer("GET /api/v1/events?limit=1000&after=0", all);
    EventsOptions options;
    options.common = common();
    options.printer = "line1";
    EXPECT_THAT(run(run_events, options).out, HasSubstr("mine\n"));
    EXPECT_THAT(run(run_events, options).out, testing::Not(HasSubstr("other")));
}

TEST_F(Commands, shouldShowTheNewestOfTheAuditLog) {
    Json first = page({});
    first["last_id"] = 7;
    service.answer("GET /api/v1/audit?limit=1", first);
    const Json entry{{"id", 6},        {"time_ns", 1},  {"who", "anna"},
                     {"what", "stop"}, {"object", "x"}, {"detail", Json::object()},
                     {"done", true}};
    service.answer("GET /api/v1/audit?limit=1000&after=5", page({entry}));
    const Said said = run(run_audit, AuditOptions{common(true), 2});
    EXPECT_EQ(said.code, ExitCode::done);
    EXPECT_EQ(Json::parse(said.out), Json::array({entry}));
}

TEST_F(Commands, shouldSayWhatAReloadHasChanged) {
    service.answer("POST /api/v1/reload", {{"changes", {"logging.level: info -> debug"}}});
    EXPECT_EQ(run(run_reload, common()).out, "logging.level: info -> debug\n");
    CannedService other;
    other.problem("POST /api/v1/reload", 422, "usage", "linefeed.yaml:3:7: http.port: 1 to 65535");
    EXPECT_EQ(run(run_reload, CommonOptions{{other.socket(), "", ""}, false}).code, ExitCode::usage);
}

} // namespace
} // namespace linefeed::client
