// Jobs, printers, findings and events as people read them, from JSON of the shapes of openapi.yaml.
#include "canned_service.hpp"
#include "client/job_text.hpp"
#include "client/printer_text.hpp"
#include "client/service_text.hpp"
#include "client/watch_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>

namespace linefeed::client {
namespace {

using testing::HasSubstr;
using testing::Not;

const Screen paper{};

class Texts : public testing::Test {
protected:
    Texts() {
        ::setenv("TZ", "CET-1", 1);
        ::tzset();
    }
};

Json printing_printer() {
    Json printer = printer_json("line1");
    printer["phase"] = "printing";
    printer["job"] = 12;
    printer["queue"] = {12, 13, 14};
    printer["figures"] = {{"fifo_depth", 256},    {"fifo_entries", 243}, {"credit", 13},
                          {"rate_per_s", 812.4},  {"lead_time_s", 0.25}, {"time_to_empty_s", 0.299},
                          {"data_left_s", 3723.0}};
    return printer;
}

TEST_F(Texts, shouldListJobsInLocalTime) {
    Json queued = job_json(13, "queued");
    queued["place"] = 2;
    EXPECT_EQ(jobs_text({queued, job_json(12, "printing", 500)}, paper),
              "JOB  STATE     PRINTER      PRINTED  CREATED              NAME\n"
              " 13  queued    line1      0 of 1000  2026-11-22 20:45:50  names.csv  place 2 in the queue\n"
              " 12  printing  line1    500 of 1000  2026-11-22 20:45:50  names.csv\n");
}

TEST_F(Texts, shouldHaveAColumnForDoubtWhereThereIsAny) {
    EXPECT_THAT(jobs_text({job_json(12, "in_doubt", 500, 3)}, paper), HasSubstr("IN DOUBT"));
    EXPECT_THAT(jobs_text({job_json(12, "stopped", 500)}, paper), Not(HasSubstr("IN DOUBT")));
}

TEST_F(Texts, shouldSayOfAJobWhatIsNext) {
    EXPECT_EQ(job_line(job_json(12, "stopped", 500)),
              "job 12 (names.csv): stopped, 500 of 1000 records printed, next 501");
    EXPECT_EQ(job_line(job_json(12, "in_doubt", 500, 3)),
              "job 12 (names.csv): in doubt, 500 of 1000 records printed, 3 in doubt, next 501");
    EXPECT_THAT(job_text(job_json(12, "stopped", 500), paper), HasSubstr("next to print  501-1000\n"));
}

TEST_F(Texts, shouldTellHowDoubtIsSettledByTheLastProductOnlyWhereThatTells) {
    Json doubt{{"count", 3}, {"records", {{{"number", 501}, {"fields", {"Müller", "\x1B[2J"}}}}}, {"hole", nullptr}};
    const std::string text = doubt_text(doubt, 12, paper);
    EXPECT_THAT(text, HasSubstr("     501  Müller | \\x1B[2J\n"));
    EXPECT_THAT(text, HasSubstr("and 2 more: linefeed ledger 12\n"));
    EXPECT_THAT(text, HasSubstr("linefeed settle 12 --last-printed NUMBER"));
    doubt["hole"] = "the panel was used";
    EXPECT_THAT(doubt_text(doubt, 12, paper), HasSubstr("linefeed settle 12 --printed N-M,N"));
    EXPECT_THAT(doubt_text(doubt, 12, paper), Not(HasSubstr("--last-printed")));
}

TEST_F(Texts, shouldListPrintersWithWhatIsWrongBelow) {
    Json broken = printer_json("line2");
    broken["error"] = {{"code", 10202},
                       {"raw", 1},
                       {"words", "10202 (battery low), message from FEP"},
                       {"meaning", "battery low"},
                       {"advice", "replace it"}};
    broken["warnings"] = {"data for 3 min"};
    Json lost = printing_printer();
    lost["name"] = "line3";
    lost["link"] = "down";
    lost["figures"] = nullptr;
    Json idle = printer_json("line4");
    idle["link"] = "down"; // as it is between jobs, where nobody looks
    idle["watched"] = false;
    Json gone = printer_json("line6");
    gone["link"] = "down";
    Json open = printer_json("line7");
    open["cover_open"] = true;
    Json held = printer_json("line5");
    held["held"] = true;
    EXPECT_EQ(printers_text({printing_printer(), broken, lost, idle, held, gone, open}, paper),
              "PRINTER  STATE              JOB  QUEUE   RATE        FIFO  DATA LEFT  ADDRESS\n"
              "line1    printing            12      2  812/s  243 of 256    1:02:03  tcp://192.168.1.20:3000\n"
              "line2    error                                                        tcp://192.168.1.20:3000\n"
              "line3    printing, no link   12      2                                tcp://192.168.1.20:3000\n"
              "line4    idle                                                         tcp://192.168.1.20:3000\n"
              "line5    stopped                                                      tcp://192.168.1.20:3000\n"
              "line6    idle, no link                                                tcp://192.168.1.20:3000\n"
              "line7    idle, cover open                                             tcp://192.168.1.20:3000\n"
              "line2: error 10202 (battery low), message from FEP; replace it\n"
              "line2: data for 3 min\n");
}

TEST_F(Texts, shouldTellAllThatIsKnownOfAPrinter) {
    const std::string text = printer_text(printing_printer(), paper);
    EXPECT_THAT(text, HasSubstr("lead time         250 ms\n"));
    EXPECT_THAT(text, HasSubstr("FIFO lasts        299 ms\n"));
    EXPECT_THAT(text, HasSubstr("queue             13, 14\n"));
    EXPECT_EQ(printer_line(printing_printer()), "line1: printing, job 12, 812/s, FIFO 243 of 256, 1:02:03 left");
}

TEST_F(Texts, shouldReadWhatAnotherVersionSendsWithoutEnding) {
    for (const Json& odd :
         {Json::object(), Json(nullptr), Json::array({1}),
          Json{{"id", "12"}, {"records", 5}, {"phase", nullptr}, {"figures", "x"}, {"queue", 3}, {"error", 7}}}) {
        EXPECT_FALSE(jobs_text({odd}, paper).empty());
        EXPECT_FALSE(job_line(odd).empty());
        EXPECT_FALSE(job_text(odd, paper).empty());
        EXPECT_FALSE(printers_text({odd}, paper).empty());
        EXPECT_FALSE(printer_text(odd, paper).empty());
        EXPECT_FALSE(event_text(odd, paper).empty());
        EXPECT_FALSE(folders_text({odd}, paper).empty());
        EXPECT_FALSE(audit_text({odd}, paper).empty());
        EXPECT_FALSE(status_text(odd, paper).empty());
    }
}

TEST_F(Texts, shouldShowFramesWithTheirDirection) {
    const Json frame{{"time", ""},          {"time_ns", 1795376750123000000},
                     {"direction", "sent"}, {"text", "^0?RS\\x0D"},
                     {"hex", ""},           {"size", 6}};
    EXPECT_EQ(frames_text({frame}, paper), "TIME              BYTES  FRAME\n"
                                           "20:45:50.123  ->      6  ^0?RS\\x0D\n");
}

TEST_F(Texts, shouldPutAdviceBelowFindings) {
    const Json findings{{{"check", "cover"}, {"severity", "problem"}, {"words", "open"}, {"advice", "close it"}},
                        {{"check", "ready"}, {"severity", "ok"}, {"words", "yes"}, {"advice", ""}}};
    EXPECT_EQ(findings_text(findings, paper), "problem  cover  open\n"
                                              "                -> close it\n"
                                              "ok       ready  yes\n");
}

TEST_F(Texts, shouldShowAnEventOnOneLine) {
    EXPECT_EQ(event_text(event_json(1, "job.stopped", "the line\nstands"), paper),
              "2026-11-22 20:45:50  job.stopped  line1, job 12  the line\\x0Astands\n");
}

TEST_F(Texts, shouldShowOfTheServiceOnlyChecksThatAreNotWell) {
    const Json status{
        {"version", "0.1.0"},
        {"started_ns", 1795376750123000000},
        {"ready", false},
        {"checks",
         {{{"check", "storage"}, {"severity", "problem"}, {"words", "disk full"}, {"advice", "make room"}},
          {{"check", "folders"}, {"severity", "ok"}, {"words", "fine"}, {"advice", ""}}}},
        {"real_time", "SCHED_FIFO 50"}};
    const std::string text = status_text(status, paper);
    EXPECT_THAT(text, HasSubstr("not ready"));
    EXPECT_THAT(text, HasSubstr("disk full"));
    EXPECT_THAT(text, Not(HasSubstr("folders")));
}

WatchPicture picture() {
    WatchPicture picture;
    picture.service = "/run/linefeed/linefeed.sock";
    picture.now_ns = 1795376750123000000;
    picture.printers = {printing_printer()};
    picture.jobs.emplace(12, job_json(12, "printing", 500));
    for (int i = 1; i <= 50; ++i) {
        picture.events.push_back(event_json(i, "printer.notice", std::to_string(i) + std::string(100, 'x')));
    }
    return picture;
}

TEST_F(Texts, shouldFitTheScreenWithTheNewestEventsLast) {
    const std::string text = watch_text(picture(), {.columns = 60, .rows = 12});
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11);
    EXPECT_THAT(text, HasSubstr("50.0 % of 1000"));
    const std::string last = text.substr(text.rfind('\n') + 1);
    EXPECT_THAT(last, HasSubstr("  50xxx"));
    EXPECT_EQ(display_width(last), 60U);
    const std::string low = watch_text(picture(), {.columns = 60, .rows = 2});
    EXPECT_EQ(std::count(low.begin(), low.end(), '\n'), 1);
}

TEST_F(Texts, shouldSayWhyAPictureIsOld) {
    WatchPicture old = picture();
    old.trouble = "there is no service";
    EXPECT_THAT(watch_text(old, {.columns = 80, .rows = 12}), HasSubstr("\nthere is no service\n"));
}

TEST_F(Texts, shouldGiveALineForEachPrinterWithoutATerminal) {
    EXPECT_EQ(watch_lines(picture()),
              std::vector<std::string>{
                  "line1: printing, job 12, 812/s, FIFO 243 of 256, 1:02:03 left, printed 50.0 % of 1000"});
    EXPECT_EQ(watch_json(picture())["jobs"][0]["id"], 12);
}

} // namespace
} // namespace linefeed::client
