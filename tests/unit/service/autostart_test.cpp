// What starts by itself, and what never does: only jobs that were never begun, where both the queue and the job allow
// it, and only while nothing else of the printer stands.
#include "service_fixture.hpp"

namespace linefeed::service {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

class AutostartTest : public ServiceTest {
protected:
    void SetUp() override {
        ServiceTest::SetUp();
        std::filesystem::create_directory(folder());
    }
    [[nodiscard]] std::filesystem::path folder() const { return directory_ / "in"; }
    [[nodiscard]] std::string settings(const std::string& address) const {
        return settings_text({address}, ", queue: {autostart: true}",
                             "folders:\n  in: {path: " + folder().string() +
                                 ", layout: serials, printer: line1, autostart: true, settle: rename}\n");
    }
    /// As a plant does it: written elsewhere, renamed into place.
    void drop(const std::string& name, std::uint32_t count, std::uint32_t first) const {
        std::filesystem::rename(file(name, count, first), folder() / name);
    }
    /// The job of that name, once all of its records are there.
    spool::JobId job_named(const std::string& name) {
        spool::JobId found{};
        EXPECT_TRUE(wait_until([&] {
            for (const daemon::JobView& job : service_->jobs({.limit = 1000}).value()) {
                found = job.name == name && job.phase != JobPhase::importing ? job.id : found;
            }
            return found != spool::JobId{};
        })) << name;
        return found;
    }
};

TEST_F(AutostartTest, shouldPrintWhatIsDroppedInTheOrderInWhichItCame) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings(printer.address()));
    for (std::uint32_t i = 0; i < 5; ++i) {
        const std::string name = "batch" + std::to_string(i) + ".csv";
        drop(name, 20, 1 + 20 * i);
        ASSERT_NE(job_named(name), spool::JobId{});
    }
    ASSERT_TRUE(comes_to(job_named("batch4.csv"), JobPhase::finished));
    EXPECT_EQ(view(job_named("batch0.csv")).created_by, "folder in");
    EXPECT_EQ(view(job_named("batch0.csv")).layout, "serials");
    const auto folders = service_->folders();
    ASSERT_THAT(folders, SizeIs(1));
    EXPECT_EQ(folders.front().imported, 5U);
    EXPECT_TRUE(folders.front().works);
    EXPECT_TRUE(std::filesystem::exists(folder() / "done" / "batch4.csv"));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 100));
}

TEST_F(AutostartTest, shouldHoldTheQueueBackWhileAJobOfThePrinterStands) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings(printer.address()));
    drop("a.csv", 400, 1);
    const spool::JobId a = job_named("a.csv");
    ASSERT_TRUE(prints_through(a, 30));
    drop("b.csv", 20, 401);
    const spool::JobId b = job_named("b.csv");
    ASSERT_TRUE(service_->stop(anna, "line1"));
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    EXPECT_EQ(view(a).phase, JobPhase::stopped);
    EXPECT_EQ(view(b).phase, JobPhase::queued);
    ASSERT_TRUE(service_->start(anna, a));
    ASSERT_TRUE(comes_to(b, JobPhase::finished)); // by itself, behind a
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 420));
}

TEST_F(AutostartTest, shouldGoOnWithTheQueueBehindACancelledJobWhenSomebodyStartsIt) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings(printer.address()));
    drop("a.csv", 1000, 1);
    const spool::JobId a = job_named("a.csv");
    ASSERT_TRUE(prints_through(a, 10));
    ASSERT_TRUE(service_->stop(anna, "line1"));
    const std::uint32_t printed = view(a).last_printed.value().value();
    drop("b.csv", 20, 2001);
    const spool::JobId b = job_named("b.csv");
    EXPECT_EQ(view(b).phase, JobPhase::queued);
    ASSERT_TRUE(service_->cancel(anna, a));
    std::this_thread::sleep_for(std::chrono::milliseconds{200});
    EXPECT_EQ(view(b).phase, JobPhase::queued) << "the line was stopped by an operator";
    drop("c.csv", 20, 2021);
    ASSERT_EQ(service_->start_next(anna, "line1").value(), b);
    ASSERT_TRUE(comes_to(job_named("c.csv"), JobPhase::finished)) << "from now on by itself again";
    service_.reset();
    std::vector<std::string> expected = serials(1, printed);
    for (const std::string& text : serials(2001, 2040)) {
        expected.push_back(text);
    }
    EXPECT_EQ(printer.products(), expected);
}

TEST_F(AutostartTest, shouldNotLetAJobThatMayNotStartByItselfBeOvertaken) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings(printer.address()));
    const spool::JobId asked = import(10, 1, "line1", false);
    drop("b.csv", 10, 11);
    const spool::JobId b = job_named("b.csv");
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    EXPECT_EQ(view(b).phase, JobPhase::queued);
    ASSERT_TRUE(service_->start(anna, asked));
    ASSERT_TRUE(comes_to(b, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 20));
}

TEST_F(AutostartTest, shouldNotStartWhatLayInTheFolderBeforeTheServiceWasStarted) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    drop("a.csv", 20, 1);
    std::this_thread::sleep_for(std::chrono::milliseconds{30}); // the time of files stands still for a tick
    open(settings(printer.address()));
    const spool::JobId a = job_named("a.csv");
    drop("b.csv", 20, 21);
    const spool::JobId b = job_named("b.csv");
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    EXPECT_EQ(view(a).phase, JobPhase::queued);
    EXPECT_EQ(view(b).phase, JobPhase::queued) << "nor what stands behind it";
    EXPECT_TRUE(service_->printer("line1")->held);
    EXPECT_THAT(event_kinds(), Contains("printer.notice"));
    ASSERT_EQ(service_->start_next(anna, "line1").value(), a);
    ASSERT_TRUE(comes_to(b, JobPhase::finished)) << "from now on by itself again";
    drop("c.csv", 20, 41);
    ASSERT_TRUE(comes_to(job_named("c.csv"), JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 60));
}

TEST_F(AutostartTest, shouldComeBackStandingAndPrintNothingByItself) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings(printer.address()));
    drop("a.csv", 500, 1);
    const spool::JobId a = job_named("a.csv");
    ASSERT_TRUE(prints_through(a, 50));
    drop("b.csv", 20, 501);
    const spool::JobId b = job_named("b.csv");
    service_.reset(); // in the middle
    open(settings(printer.address()));
    EXPECT_EQ(view(a).phase, JobPhase::stopped);
    EXPECT_EQ(view(a).open, RecordCount{0});
    const RecordCount printed = view(a).printed;
    std::this_thread::sleep_for(std::chrono::milliseconds{500});
    EXPECT_EQ(view(a).phase, JobPhase::stopped);
    EXPECT_EQ(view(a).printed, printed);
    EXPECT_EQ(view(b).phase, JobPhase::queued);
    ASSERT_TRUE(service_->start_next(anna, "line1"));
    ASSERT_TRUE(comes_to(b, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 520));
}

/// It was never begun, and may start by itself; but not because the service was started.
TEST_F(AutostartTest, shouldStartNothingThatWaitedBeforeTheServiceWasStarted) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings_text({printer.address()}, {},
                       "folders:\n  in: {path: " + folder().string() + ", layout: serials, printer: line1}\n"));
    const spool::JobId a = import(20, 1, "line1", true);
    EXPECT_EQ(view(a).phase, JobPhase::queued);
    service_.reset();
    open(settings(printer.address()));
    drop("b.csv", 20, 21);
    const spool::JobId b = job_named("b.csv");
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    EXPECT_EQ(view(a).phase, JobPhase::queued);
    EXPECT_EQ(view(b).phase, JobPhase::queued) << "it does not overtake";
    EXPECT_TRUE(service_->printer("line1")->held);
    EXPECT_THAT(event_kinds(), Contains("printer.notice"));
    ASSERT_EQ(service_->start_next(anna, "line1").value(), a);
    ASSERT_TRUE(comes_to(b, JobPhase::finished)) << "from then on by itself again";
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 40));
}

/// Nobody has to restart anything to let a queue start by itself.
TEST_F(AutostartTest, shouldStartWhatWaitsWhenTheSettingsBeginToAllowIt) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings_text({printer.address()}));
    const spool::JobId a = import(20, 1, "line1", true);
    service_.reset();
    open(settings_text({printer.address()}));
    EXPECT_FALSE(service_->printer("line1")->held);
    text_ = settings(printer.address());
    ASSERT_TRUE(service_->reload(anna));
    ASSERT_TRUE(comes_to(a, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 20));
}

TEST_F(AutostartTest, shouldStartNothingByItselfOnALineThatAnOperatorHasStopped) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings(printer.address()));
    ASSERT_TRUE(service_->stop(anna, "line1")) << "it stands, and is to stay so";
    EXPECT_TRUE(service_->printer("line1")->held);
    drop("a.csv", 10, 1);
    const spool::JobId a = job_named("a.csv");
    std::this_thread::sleep_for(std::chrono::milliseconds{200});
    EXPECT_EQ(view(a).phase, JobPhase::queued);
    ASSERT_TRUE(service_->reload(anna));
    service_.reset();
    open(settings(printer.address()));
    std::this_thread::sleep_for(std::chrono::milliseconds{200});
    EXPECT_EQ(view(a).phase, JobPhase::queued) << "not after a restart either";
    ASSERT_TRUE(service_->start(anna, a));
    ASSERT_TRUE(comes_to(a, JobPhase::finished));
    drop("b.csv", 10, 11);
    ASSERT_TRUE(comes_to(job_named("b.csv"), JobPhase::finished)) << "whoever starts a job lets the queue go on";
    EXPECT_FALSE(service_->printer("line1")->held);
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 20));
}

/// A run of the job on `printer` that has printed 1 to 2 and leaves 3 to 5 to be found out about.
void interrupt(const std::filesystem::path& file, spool::JobId job, const std::string& printer, std::uint32_t count) {
    auto spool = spool::Spool::open(file, {}).value();
    const auto records = [](std::uint32_t first, std::uint32_t last) {
        return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
    };
    const auto run = spool.begin_run(job, records(1, count), R"({"printer":"tcp://)" + printer + R"("})").value();
    const std::vector<spool::LedgerEntry> rows{{spool::LedgerKind::intent, run, records(1, 5), {}},
                                               {spool::LedgerKind::printed, run, records(1, 2), {}}};
    ASSERT_TRUE(spool.append(job, rows));
}

TEST_F(AutostartTest, shouldNotGoOnByItselfWithWhatWasPrintedFromTheCommandLine) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings("127.0.0.1:1"));
    ASSERT_TRUE(service_->stop(anna, "line1"));
    drop("a.csv", 10, 1);
    const spool::JobId a = job_named("a.csv");
    service_.reset();
    interrupt(directory_ / "spool.db", a, printer.address(), 10);
    ASSERT_TRUE(spool::Spool::open(directory_ / "spool.db", {}).value().hold_printer("line1", false));
    open(settings(printer.address()));
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    EXPECT_EQ(view(a).phase, JobPhase::stopped);
    EXPECT_THAT(view(a).message, HasSubstr("printed from the command line"));
    service_.reset();
    EXPECT_THAT(printer.products(), SizeIs(0));
}

TEST_F(AutostartTest, shouldNotTryAgainByItselfWhatCouldNotBeStarted) {
    std::string port;
    {
        SimulatedPrinter gone{directory_ / "gone.csv", 1000};
        port = gone.port();
    }
    open(settings("127.0.0.1:" + port));
    drop("a.csv", 10, 1);
    const spool::JobId a = job_named("a.csv");
    // Between the word that it has begun and its start it stands as after a crash.
    ASSERT_TRUE(wait_until([&] {
        return view(a).phase == JobPhase::stopped && view(a).message.find("the service ended") == std::string::npos;
    }));
    SimulatedPrinter printer{directory_ / "tape.csv", 1000, port};
    drop("b.csv", 10, 11);
    const spool::JobId b = job_named("b.csv");
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    EXPECT_EQ(view(a).phase, JobPhase::stopped);
    EXPECT_EQ(view(b).phase, JobPhase::queued);
    service_.reset();
    open(settings("127.0.0.1:" + port));
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    EXPECT_EQ(view(a).phase, JobPhase::stopped) << "not after a restart either";
    ASSERT_TRUE(service_->start(anna, a));
    ASSERT_TRUE(comes_to(b, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 20));
}

TEST_F(AutostartTest, shouldSayWhyAFolderCannotBeUsedAndTakeItUpWhenItCan) {
    std::filesystem::remove(folder());
    open(settings("127.0.0.1:1"));
    EXPECT_TRUE(wait_until([&] { return !service_->folders().front().works; }));
    EXPECT_THAT(service_->folders().front().message, HasSubstr(folder().string()));
    EXPECT_TRUE(wait_until([&] { return testing::Value(event_kinds(), Contains("folder.down")); }));
    EXPECT_TRUE(service_->status().ready) << "the lines go on";
}

TEST_F(AutostartTest, shouldReportADuplicateAndRejectABadFile) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings(printer.address()));
    drop("a.csv", 10, 1);
    ASSERT_TRUE(comes_to(job_named("a.csv"), JobPhase::finished));
    drop("copy.csv", 10, 1);
    std::ofstream{directory_ / "bad.csv"} << "name\nx\n";
    std::filesystem::rename(directory_ / "bad.csv", folder() / "bad.csv");
    EXPECT_TRUE(wait_until([&] {
        const auto view = service_->folders().front();
        return view.duplicates == 1 && view.failed == 1;
    }));
    EXPECT_TRUE(std::filesystem::exists(folder() / "failed" / "bad.csv"));
    EXPECT_THAT(service_->jobs({}).value(), SizeIs(1));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 10));
}

} // namespace
} // namespace linefeed::service
