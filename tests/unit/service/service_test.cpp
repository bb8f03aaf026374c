// What the operator can do with jobs and printers, with a real spool and a printer whose products are the judge.
#include "service_fixture.hpp"
#include "support/peer.hpp"

#include <regex>

namespace linefeed::service {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::SizeIs;

TEST_F(ServiceTest, shouldPrintWhatIsStartedAndNothingElse) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings_text({printer.address()}));
    const spool::JobId first = import(300);
    const spool::JobId second = import(100, 1001);
    EXPECT_EQ(view(first).phase, JobPhase::queued);
    EXPECT_EQ(view(first).place, 1U);
    EXPECT_EQ(view(second).place, 2U);
    EXPECT_EQ(view(first).created_by, "anna (uid 1000)");

    ASSERT_TRUE(service_->start(anna, first));
    ASSERT_TRUE(comes_to(first, JobPhase::finished));
    EXPECT_EQ(view(first).place, std::nullopt);
    EXPECT_EQ(view(first).printed, RecordCount{300});
    EXPECT_EQ(view(first).last_printed, RecordNumber{300});
    EXPECT_EQ(view(second).phase, JobPhase::queued) << "nobody started it";
    EXPECT_EQ(view(second).place, 1U);

    service_->shut_down();
    EXPECT_THAT(event_kinds(), IsSupersetOf({"service.started", "job.imported", "job.queued", "job.started",
                                             "job.printing", "job.finished", "service.stopping"}));
    EXPECT_EQ(service_->verify_ledger().has_value(), true);
    EXPECT_EQ(printer.products(), serials(1, 300));
}

TEST_F(ServiceTest, shouldStopAndResumeWithoutLosingOrDoublingAProduct) {
    SimulatedPrinter printer{directory_ / "tape.csv", 400};
    open(settings_text({printer.address()}));
    const spool::JobId job = import(600);
    ASSERT_TRUE(service_->start(anna, job));
    for (const std::uint32_t reached : {50U, 200U}) {
        ASSERT_TRUE(prints_through(job, reached));
        const auto printing = service_->printer("line1").value();
        EXPECT_EQ(printing.phase, daemon::PrinterPhase::printing);
        EXPECT_EQ(printing.job, job);
        EXPECT_EQ(printing.figures.fifo_depth, 256U);
        EXPECT_TRUE(printing.figures.data_left_s.has_value());
        ASSERT_TRUE(service_->stop(anna, "line1"));
        EXPECT_EQ(view(job).phase, JobPhase::stopped);
        EXPECT_THAT(view(job).message, HasSubstr("stopped on request"));
        EXPECT_EQ(view(job).open, RecordCount{0}) << "the truth is in the ledger";
        EXPECT_EQ(service_->printer("line1")->phase, daemon::PrinterPhase::idle);
        EXPECT_EQ(service_->start_next(anna, "line1").value(), job);
    }
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    EXPECT_TRUE(service_->stop(anna, "line1")) << "nothing to stop is no failure";
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 600));
}

TEST_F(ServiceTest, shouldRefuseWhatDoesNotFitTheMoment) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings_text({printer.address(), "127.0.0.1:1"}));
    const spool::JobId job = import(2000);
    const spool::JobId other = import(10, 5001);
    const spool::JobId nowhere = import(10, 6001, "");
    EXPECT_EQ(view(nowhere).phase, JobPhase::ready);
    EXPECT_THAT(service_->start(anna, nowhere).error().message, HasSubstr("belongs to no printer"));
    EXPECT_THAT(service_->start(anna, spool::JobId{99}).error().message, HasSubstr("there is no job 99"));
    EXPECT_THAT(service_->start_next(anna, "line9").error().message, HasSubstr("there is: line1, line2"));
    EXPECT_THAT(service_->start_next(anna, "line2").error().message, HasSubstr("is empty"));

    ASSERT_TRUE(service_->start(anna, job));
    EXPECT_EQ(service_->start(anna, job).error().kind, FailureKind::stopped) << "twice";
    EXPECT_EQ(service_->start(anna, other).error().kind, FailureKind::stopped) << "the line is busy";
    EXPECT_EQ(service_->cancel(anna, job).error().kind, FailureKind::stopped);
    EXPECT_EQ(service_->enqueue(anna, job, "line2").error().kind, FailureKind::stopped);
    EXPECT_EQ(service_->reprint(anna, job, {"1", "smudged"}).error().kind, FailureKind::stopped);
    ASSERT_TRUE(prints_through(job, 20));
    ASSERT_TRUE(service_->stop(anna, "line1"));
    EXPECT_THAT(service_->enqueue(anna, job, "line2").error().message, HasSubstr("belongs to that printer"));
    EXPECT_THAT(service_->settle(anna, job, {.last_printed = "1"}).error().message, HasSubstr("no record"));
    EXPECT_TRUE(service_->enqueue(anna, other, "line2")) << "it has not printed yet";

    const auto audit = service_->audit(0, 100).value();
    EXPECT_THAT(audit, SizeIs(17));
    const auto refused = std::ranges::count(audit, false, &daemon::AuditView::done);
    EXPECT_EQ(refused, 11);
    service_.reset();
    const auto products = printer.products();
    EXPECT_EQ(products, serials(1, static_cast<std::uint32_t>(products.size())));
}

/// Neither while it is written down that it is begun, nor when that is done.
TEST_F(ServiceTest, shouldShowNoJobAsStoppedThatHasJustBeenStarted) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings_text({printer.address()}));
    for (std::uint32_t first = 1; first < 200; first += 10) {
        const spool::JobId job = import(10, first);
        std::atomic<bool> over{false};
        std::atomic<int> stopped{0};
        std::thread looks{[&] {
            while (!over) {
                stopped += view(job).phase == JobPhase::stopped ? 1 : 0;
            }
        }};
        EXPECT_TRUE(service_->start(anna, job));
        EXPECT_TRUE(comes_to(job, JobPhase::finished));
        over = true;
        looks.join();
        EXPECT_EQ(stopped, 0) << first;
    }
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 200));
}

/// A long task that keeps the printer for itself: the job waits for its end, a stop does not.
TEST_F(ServiceTest, shouldStopAJobThatWaitsForALongTask) {
    printer::Peer printer{[](std::string_view frame) {
        return printer::Peer::Reaction{frame.starts_with("^0$RD") ? "^0$DI1\t00\r" : ""};
    }};
    open(settings_text({printer.settings().address.substr(6)}, ", watch_interval: 0 s"));
    std::ofstream{directory_ / "file.job"} << "content";
    std::thread writer{[this] {
        EXPECT_FALSE(service_->write_file(anna, "line1", {"FFSDISK\\Jobs\\a.job", directory_ / "file.job", true}));
    }};
    ASSERT_TRUE(wait_until([&] { return printer.heard().find("^0$FT") != std::string::npos; }));
    const spool::JobId job = import(10);
    ASSERT_TRUE(service_->start(anna, job));
    const auto begun = std::chrono::steady_clock::now();
    ASSERT_TRUE(service_->stop(anna, "line1"));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds{5});
    EXPECT_EQ(view(job).phase, JobPhase::stopped);
    EXPECT_THAT(view(job).message, HasSubstr("stopped on request"));
    printer.cut();
    writer.join();
}

TEST_F(ServiceTest, shouldKeepSomeOfAFloodOfRefusalsAndAllThatWasDone) {
    open(settings_text({"127.0.0.1:1"}));
    const spool::JobId job = import(10, 1, "");
    const auto before = service_->audit(0, 1000)->size();
    for (int k = 0; k < 300; ++k) {
        EXPECT_FALSE(service_->start(anna, spool::JobId{99}));
    }
    EXPECT_FALSE(service_->start({"bob"}, spool::JobId{99}));
    EXPECT_TRUE(service_->cancel(anna, job));
    const auto audit = service_->audit(0, 1000).value();
    EXPECT_EQ(audit.size() - before, 20U + 1 + 1);
    EXPECT_EQ(audit[audit.size() - 2].who, "bob");
    EXPECT_TRUE(audit.back().done);
}

TEST_F(ServiceTest, shouldStopWhileItArms) {
    simulator::SimulatorSettings slow;
    slow.server.reply_delay = std::chrono::milliseconds{100};
    SimulatedPrinter printer{directory_ / "tape.csv", 200, "0", slow};
    open(settings_text({printer.address()}));
    const spool::JobId job = import(100);
    for (const int after_ms : {0, 50, 350}) {
        ASSERT_TRUE(service_->start(anna, job));
        std::this_thread::sleep_for(std::chrono::milliseconds{after_ms});
        ASSERT_TRUE(service_->stop(anna, "line1"));
        EXPECT_EQ(view(job).phase, JobPhase::stopped);
    }
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 100));
}

TEST_F(ServiceTest, shouldCancelWhatWaitsAndQueueItAgain) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings_text({printer.address()}));
    const spool::JobId job = import(20);
    ASSERT_TRUE(service_->cancel(anna, job));
    EXPECT_EQ(view(job).phase, JobPhase::cancelled);
    EXPECT_EQ(view(job).message, "cancelled by anna (uid 1000)");
    EXPECT_THAT(service_->printer("line1")->queue, IsEmpty());
    EXPECT_FALSE(service_->start(anna, job));
    ASSERT_TRUE(service_->enqueue(anna, job, "line1"));
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    EXPECT_FALSE(service_->cancel(anna, job));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 20));
}

TEST_F(ServiceTest, shouldPrintAgainWhatAnOperatorNamesWithReasonAndName) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings_text({printer.address()}));
    const spool::JobId job = import(10);
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    EXPECT_THAT(service_->reprint(anna, job, {"3", ""}).error().message, HasSubstr("why"));
    EXPECT_THAT(service_->reprint(anna, job, {"none", "x"}).error().message, HasSubstr("which records"));
    EXPECT_THAT(service_->reprint(anna, job, {"9-11", "x"}).error().message, HasSubstr("only 2 are printed"));
    EXPECT_EQ(view(job).phase, JobPhase::finished) << "nothing was written";

    // 10 is also the number that the printer still shows as the last.
    ASSERT_TRUE(service_->reprint(anna, job, {"10, 3-4", "smudged"}));
    EXPECT_EQ(view(job).phase, JobPhase::stopped);
    EXPECT_EQ(view(job).next, RecordRange::closed(RecordNumber{3}, RecordNumber{4}));
    EXPECT_THAT(view(job).message, HasSubstr("records 3-4, 10 are to be printed again: smudged"));
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::finished));

    std::vector<std::string> evidence;
    for (const spool::LedgerRow& row : service_->ledger(job, 0, 1000).value()) {
        if (row.entry.kind == spool::LedgerKind::reprint) {
            evidence.push_back(row.entry.evidence);
        }
    }
    EXPECT_THAT(evidence, ElementsAre(R"x({"operator":"anna (uid 1000)","reason":"smudged"})x",
                                      R"x({"operator":"anna (uid 1000)","reason":"smudged"})x"));
    EXPECT_TRUE(service_->verify_ledger());
    service_.reset();
    std::vector<std::string> expected = serials(1, 10);
    for (const char* again : {"SN-3", "SN-4", "SN-10"}) {
        expected.emplace_back(again);
    }
    EXPECT_EQ(printer.products(), expected);
}

TEST_F(ServiceTest, shouldStandAndSayWhyWhenThePrinterCannotBeReachedAndGoOnLater) {
    std::string port;
    {
        SimulatedPrinter gone{directory_ / "gone.csv", 1000};
        port = gone.port();
    }
    open(settings_text({"127.0.0.1:" + port}));
    const spool::JobId job = import(30);
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::stopped));
    EXPECT_THAT(view(job).message, HasSubstr("Connection refused. Look whether the printer is switched on"));
    SimulatedPrinter printer{directory_ / "tape.csv", 1000, port};
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 30));
}

TEST_F(ServiceTest, shouldReportTheSameContentInsteadOfPrintingItTwice) {
    open(settings_text({"127.0.0.1:1"}));
    const spool::JobId job = import(10);
    const auto copy =
        service_->import(anna, {.file = file("copy.csv", 10), .name = {}, .layout = "serials", .printer = "line1"});
    ASSERT_TRUE(copy);
    EXPECT_TRUE(copy->duplicate);
    EXPECT_EQ(copy->job, job);
    const auto again = service_->import(
        anna, {.file = file("copy.csv", 10), .name = "again", .layout = "serials", .printer = {}, .again = true});
    ASSERT_TRUE(again);
    EXPECT_FALSE(again->duplicate);
    EXPECT_NE(again->job, job);
    EXPECT_EQ(view(*again->job).name, "again");
    EXPECT_EQ(service_->metrics().intake_files_duplicate, 1U);
    EXPECT_EQ(service_->metrics().intake_records, 20U);

    std::vector<spool::JobId> newest;
    for (const daemon::JobView& listed : service_->jobs({}).value()) {
        newest.push_back(listed.id);
    }
    EXPECT_THAT(newest, ElementsAre(*again->job, job));
    EXPECT_THAT(service_->jobs({.printer = "line1"}).value(), SizeIs(1));
    EXPECT_THAT(service_->jobs({.phases = {JobPhase::ready}}).value(), SizeIs(1));
    EXPECT_THAT(service_->jobs({.after = *again->job}).value(), SizeIs(1));
    EXPECT_THAT(service_->jobs({.limit = 1}).value(), SizeIs(1));
}

/// The same file with other pictures gives other records.
TEST_F(ServiceTest, shouldReadAFileWithPicturesAnew) {
    const auto picture = [this](const char* rows) { std::ofstream{directory_ / "logo.pbm"} << "P1\n2 2\n" << rows; };
    const auto path = directory_ / "pictures.csv";
    std::ofstream{path} << "logo\nlogo.pbm\n";
    std::string text = settings_text({"127.0.0.1:1"});
    text.replace(text.find("{serials:"), 9, "{logos: {columns: [logo], graphics: [logo]}, serials:");
    open(text);
    const daemon::ImportRequest request{.file = path, .name = {}, .layout = "logos", .printer = "line1"};
    picture("1 0\n0 1\n");
    const auto first = service_->import(anna, request);
    ASSERT_TRUE(first && first->job) << (first ? first->report : first.error().message);
    const auto same = service_->import(anna, request);
    ASSERT_TRUE(same);
    EXPECT_TRUE(same->duplicate);
    EXPECT_EQ(same->job, first->job);
    picture("1 1\n1 1\n");
    const auto other = service_->import(anna, request);
    ASSERT_TRUE(other && other->job);
    EXPECT_FALSE(other->duplicate);
    EXPECT_NE(other->job, first->job);
}

TEST_F(ServiceTest, shouldRefuseAFileWithBadRowsAndKeepNothingOfIt) {
    open(settings_text({"127.0.0.1:1"}));
    const auto path = directory_ / "bad.csv";
    std::ofstream{path} << "serial\nok\n\xFF\xFE\nok too\n";
    const auto answer = service_->import(anna, {.file = path, .name = {}, .layout = "serials", .printer = "line1"});
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_EQ(answer->job, std::nullopt);
    EXPECT_THAT(answer->report, HasSubstr("\"bad_rows\":1"));
    EXPECT_THAT(service_->jobs({}).value(), IsEmpty());
    EXPECT_EQ(service_->import(anna, {.file = "x.csv"}).error().kind, FailureKind::usage);
    EXPECT_EQ(service_->import(anna, {.file = directory_ / "no.csv"}).error().kind, FailureKind::input);
    EXPECT_THAT(service_->import(anna, {.file = path, .name = {}, .layout = "other"}).error().message,
                HasSubstr("no layout"));
}

TEST_F(ServiceTest, shouldLetAnOperatorSettleADoubtAndGoOnBehindIt) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    const std::string text = settings_text({printer.address()});
    open(text);
    const spool::JobId job = import(10);
    service_.reset();
    { // a run of which nobody knows whether it has printed 3 to 5
        auto spool = spool::Spool::open(directory_ / "spool.db", {}).value();
        const auto records = [](std::uint32_t first, std::uint32_t last) {
            return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
        };
        const spool::RunId run =
            spool.begin_run(job, records(1, 10), R"({"printer":"tcp://x:1","last_printed_before":0})").value();
        const std::vector<spool::LedgerEntry> rows{{spool::LedgerKind::intent, run, records(1, 10), {}},
                                                   {spool::LedgerKind::printed, run, records(1, 2), {}},
                                                   {spool::LedgerKind::in_doubt, run, records(3, 5), "{}"},
                                                   {spool::LedgerKind::unused, run, records(6, 10), {}},
                                                   {spool::LedgerKind::run_ended, run, {}, {}}};
        ASSERT_TRUE(spool.append(job, rows));
    }
    open(text);
    EXPECT_EQ(view(job).phase, JobPhase::in_doubt);
    EXPECT_EQ(service_->start(anna, job).error().kind, FailureKind::in_doubt);
    EXPECT_THAT(service_->start_next(anna, "line1").error().message, HasSubstr("in doubt"));
    const auto doubt = service_->doubt(job).value();
    EXPECT_EQ(doubt.count, RecordCount{3});
    ASSERT_THAT(doubt.records, SizeIs(3));
    EXPECT_THAT(doubt.records.front().fields, ElementsAre("SN-3"));

    EXPECT_EQ(service_->settle(anna, job, {}).error().kind, FailureKind::usage);
    EXPECT_EQ(service_->settle(anna, job, {.last_printed = "9"}).error().kind, FailureKind::usage);
    EXPECT_EQ(service_->settle(anna, job, {.printed = "none", .as_of = doubt.as_of - 1}).error().kind,
              FailureKind::stopped)
        << "said of something else";
    ASSERT_TRUE(service_->settle(anna, job, {.last_printed = "SN-4", .as_of = doubt.as_of}));
    EXPECT_NE(service_->doubt(job)->as_of, doubt.as_of);
    EXPECT_EQ(view(job).phase, JobPhase::stopped);
    EXPECT_EQ(view(job).next.first(), RecordNumber{5});
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    const auto history = service_->history(job, RecordRange::closed(RecordNumber{4}, RecordNumber{5})).value();
    ASSERT_THAT(history, SizeIs(2));
    EXPECT_THAT(history.front().evidence, HasSubstr(R"x("operator":"anna (uid 1000)")x"));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(5, 10));
}

TEST_F(ServiceTest, shouldShowThatAHistoryGoesOnBehindALongPage) {
    const std::string text = settings_text({"127.0.0.1:1"});
    open(text);
    const spool::JobId job = import(1200);
    service_.reset();
    const auto records = [](std::uint32_t first, std::uint32_t last) {
        return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
    };
    { // each was told to be printed by an answer of its own
        auto spool = spool::Spool::open(directory_ / "spool.db", {}).value();
        const spool::RunId run =
            spool.begin_run(job, records(1, 1200), R"({"printer":"tcp://x:1","last_printed_before":0})").value();
        std::vector<spool::LedgerEntry> rows{{spool::LedgerKind::intent, run, records(1, 1200), {}}};
        for (std::uint32_t k = 1; k <= 1200; ++k) {
            rows.push_back({spool::LedgerKind::printed, run, records(k, k), "{\"k\":" + std::to_string(k) + "}"});
        }
        ASSERT_TRUE(spool.append(job, rows));
    }
    open(text);
    const auto first = service_->history(job, records(1, 1200)).value();
    ASSERT_THAT(first, SizeIs(1001)) << "more than the 1000 that the API shows at once";
    EXPECT_EQ(first.back().range, records(1001, 1001));
    EXPECT_THAT(service_->history(job, records(1001, 1200)).value(), SizeIs(200));
}

/// The queue must not wait for a job that is over already.
TEST_F(ServiceTest, shouldLetGoOfAJobThatThePrinterHasFinishedWhileNobodyAsked) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    const std::string text = settings_text({printer.address()});
    open(text);
    const spool::JobId job = import(10);
    ASSERT_TRUE(service_->start(anna, job));
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    const spool::JobId other = import(10, 11);
    service_.reset();
    { // as if the service had been killed before it heard of the end
        auto spool = spool::Spool::open(directory_ / "spool.db", {}).value();
        const RecordRange last = RecordRange::closed(RecordNumber{10}, RecordNumber{10});
        const auto before = spool.last_run(job).value();
        const spool::LedgerEntry again{spool::LedgerKind::reprint, before->started.entry.run, last, "{}"};
        ASSERT_TRUE(spool.append(job, {&again, 1}));
        const auto evidence = std::regex_replace(before->started.entry.evidence, std::regex{R"((_before":)0)"}, "$019");
        ASSERT_NE(evidence, before->started.entry.evidence) << "the printer had printed 9 of 10 then";
        const auto run = spool.begin_run(job, last, evidence).value();
        const spool::LedgerEntry intent{spool::LedgerKind::intent, run, last, {}};
        ASSERT_TRUE(spool.append(job, {&intent, 1}));
        auto ticket = spool.ticket(job).value().value();
        ticket.begun = true;
        ticket.place = spool.first_place("line1").value();
        ASSERT_TRUE(spool.write_ticket(ticket));
    }
    open(text);
    ASSERT_EQ(view(job).phase, JobPhase::stopped);
    ASSERT_TRUE(service_->start(anna, other));
    ASSERT_TRUE(comes_to(other, JobPhase::finished));
    EXPECT_EQ(view(job).phase, JobPhase::finished);
    EXPECT_THAT(service_->printer("line1")->queue, IsEmpty());
    EXPECT_THAT(service_->start_next(anna, "line1").error().message, HasSubstr("is empty"));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 20));
}

TEST_F(ServiceTest, shouldRememberAnswersOverARestart) {
    open(settings_text({"127.0.0.1:1"}));
    EXPECT_EQ(service_->remembered(anna, "k").value(), std::nullopt);
    ASSERT_TRUE(service_->remember(anna, "k", {"hash", 202, "{}"}));
    service_.reset();
    open(settings_text({"127.0.0.1:1"}));
    const auto answer = service_->remembered(anna, "k").value();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->request_hash, "hash");
    EXPECT_EQ(answer->status, 202);
    EXPECT_FALSE(service_->remembered({"otto"}, "k").value());
}

TEST_F(ServiceTest, shouldTellThoseWhoWatchOfEachEventOnceItIsDurable) {
    open(settings_text({"127.0.0.1:1"}));
    std::atomic<int> calls{0};
    const std::uint64_t subscription = service_->subscribe([&calls] { ++calls; });
    static_cast<void>(import(5));
    EXPECT_TRUE(wait_until([&] { return calls > 0; }));
    const auto events = service_->events(0, 100).value();
    service_->unsubscribe(subscription);
    ASSERT_FALSE(events.empty());
    service_.reset();
    open(settings_text({"127.0.0.1:1"}));
    EXPECT_TRUE(wait_until([&] { return !service_->events(events.back().id, 100)->empty(); }));
    EXPECT_GT(service_->events(events.back().id, 1)->front().id, events.back().id);
}

} // namespace
} // namespace linefeed::service
