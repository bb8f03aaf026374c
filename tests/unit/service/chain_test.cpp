// Jobs that follow each other without a stop: which one is claimed, what may be done with it meanwhile, and that it
// waits again when it does not come to that.
#include "service_fixture.hpp"

namespace linefeed::service {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class ChainTest : public ServiceTest {
protected:
    void SetUp() override {
        ServiceTest::SetUp();
        std::filesystem::create_directory(folder());
    }
    [[nodiscard]] std::filesystem::path folder() const { return directory_ / "in"; }
    [[nodiscard]] std::string settings(const SimulatedPrinter& printer, const std::string& chain = "seamless") const {
        return settings_text({printer.address()}, ", queue: {autostart: true, chain: " + chain + "}");
    }
    [[nodiscard]] spool::JobId import_waiting(std::uint32_t count, std::uint32_t first) {
        return import(count, first, "line1", true);
    }
    /// A job that prints, and `count` records that are claimed to follow it.
    void print_with_follower(std::uint32_t count) {
        first_ = import_waiting(400, 1);
        ASSERT_TRUE(comes_to(first_, JobPhase::printing));
        follower_ = import_waiting(count, 401);
        ASSERT_TRUE(comes_to(follower_, JobPhase::arming));
        ASSERT_EQ(view(first_).phase, JobPhase::printing);
    }
    [[nodiscard]] spool::Ticket ticket(spool::JobId job) const {
        auto spool = spool::Spool::open_for_reading(directory_ / "spool.db", {}).value();
        return spool.ticket(job).value().value();
    }
    /// Longer than the line waits until it looks for a follower once more.
    static void wait_for_a_look() { std::this_thread::sleep_for(std::chrono::milliseconds{1300}); }

    spool::JobId first_{};
    spool::JobId follower_{};
};

TEST_F(ChainTest, shouldPrintEveryRecordOfJobsThatFollowEachOther) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings(printer));
    print_with_follower(200);
    const spool::JobId last = import_waiting(100, 601);
    ASSERT_TRUE(comes_to(first_, JobPhase::finished));
    ASSERT_TRUE(comes_to(follower_, JobPhase::finished));
    ASSERT_TRUE(comes_to(last, JobPhase::finished));
    EXPECT_THAT(event_kinds(), Not(Contains("job.stopped")));
    const auto kinds = event_kinds();
    for (const char* kind : {"job.started", "job.printing", "job.finished"}) {
        EXPECT_EQ(std::ranges::count(kinds, kind), 3) << kind;
    }
    EXPECT_FALSE(ticket(first_).place || ticket(follower_).place) << "out of the queue";
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 700));
}

TEST_F(ChainTest, shouldHaveAClaimedJobOnTheLineForAllWhoLook) {
    SimulatedPrinter printer{directory_ / "tape.csv", 100};
    open(settings(printer));
    print_with_follower(200);
    EXPECT_TRUE(ticket(follower_).begun) << "a crash must not let it start by itself";
    EXPECT_THAT(ticket(follower_).message, HasSubstr("the service ended"));
    EXPECT_EQ(service_->printer("line1")->job, first_);
    EXPECT_GT(service_->printer("line1")->figures.data_left_s.value_or(0), 2.5) << "of both";
    for (const auto& listed : service_->jobs({.limit = 10}).value()) {
        EXPECT_EQ(listed.phase, listed.id == follower_ ? JobPhase::arming : JobPhase::printing);
    }
    EXPECT_THAT(service_->start(anna, follower_).error().message, HasSubstr("on the line already"));
    EXPECT_THAT(service_->cancel(anna, follower_).error().message, HasSubstr("on the line"));
    EXPECT_THAT(service_->enqueue(anna, follower_, "line1").error().message, HasSubstr("on the line"));
    EXPECT_THAT(service_->settle(anna, follower_, {.printed = "none"}).error().message, HasSubstr("on the line"));
    EXPECT_THAT(service_->reprint(anna, follower_, {.records = "1", .reason = "torn"}).error().message,
                HasSubstr("on the line"));
    const auto audit = service_->audit(0, 100).value();
    EXPECT_TRUE(std::ranges::any_of(audit, [this](const daemon::AuditView& entry) {
        return entry.who == "linefeedd" && entry.what == "start" && entry.object == daemon::name_of(follower_) &&
               entry.detail.find(daemon::name_of(first_)) != std::string::npos && entry.done;
    }));
}

TEST_F(ChainTest, shouldLetTheFollowerWaitAgainWhenAnOperatorStopsTheLine) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings(printer));
    print_with_follower(50);
    ASSERT_TRUE(service_->stop(anna, "line1"));
    EXPECT_EQ(view(first_).phase, JobPhase::stopped);
    EXPECT_EQ(view(follower_).phase, JobPhase::queued);
    EXPECT_FALSE(ticket(follower_).begun);
    EXPECT_EQ(ticket(follower_).message, "");
    EXPECT_EQ(view(follower_).place, 2U) << "behind the job that stands";
    wait_for_a_look();
    EXPECT_EQ(view(follower_).phase, JobPhase::queued);
    ASSERT_TRUE(service_->start(anna, first_));
    ASSERT_TRUE(comes_to(follower_, JobPhase::finished)) << "by itself, behind the first";
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 450));
}

TEST_F(ChainTest, shouldComeBackStandingWhenTheServiceEndsInBetween) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings(printer));
    print_with_follower(50);
    service_.reset();
    open(settings(printer));
    EXPECT_EQ(view(first_).phase, JobPhase::stopped);
    EXPECT_EQ(view(follower_).phase, JobPhase::queued);
    wait_for_a_look();
    EXPECT_EQ(view(follower_).phase, JobPhase::queued);
    ASSERT_TRUE(service_->start_next(anna, "line1"));
    ASSERT_TRUE(comes_to(follower_, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 450));
}

TEST_F(ChainTest, shouldStandStillAfterACrashWithAClaimedFollower) {
    SimulatedPrinter printer{directory_ / "tape.csv", 300};
    open(settings(printer));
    const spool::JobId job = import_waiting(10, 1);
    ASSERT_TRUE(comes_to(job, JobPhase::finished));
    const spool::JobId claimed = import(20, 11, "line1", false);
    service_.reset();
    {
        auto spool = spool::Spool::open(directory_ / "spool.db", {}).value();
        spool::Ticket ticket = spool.ticket(claimed).value().value();
        ticket.autostart = ticket.begun = true;
        ticket.message = interrupted_words;
        ASSERT_TRUE(spool.write_ticket(ticket));
    }
    open(settings(printer));
    EXPECT_EQ(view(claimed).phase, JobPhase::stopped);
    EXPECT_THAT(view(claimed).message, HasSubstr("the service ended"));
    ASSERT_TRUE(service_->start(anna, claimed));
    ASSERT_TRUE(comes_to(claimed, JobPhase::finished));
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 30));
}

TEST_F(ChainTest, shouldClaimNothingThatMayNotStartByItselfNorWhatStandsBehindIt) {
    SimulatedPrinter printer{directory_ / "tape.csv", 100};
    open(settings(printer));
    const spool::JobId job = import_waiting(400, 1);
    ASSERT_TRUE(comes_to(job, JobPhase::printing));
    const spool::JobId asked = import(10, 401, "line1", false);
    const spool::JobId behind = import_waiting(10, 411);
    wait_for_a_look();
    EXPECT_EQ(view(asked).phase, JobPhase::queued);
    EXPECT_EQ(view(behind).phase, JobPhase::queued);
}

TEST_F(ChainTest, shouldClaimNothingWhileAnotherJobOfThePrinterStands) {
    SimulatedPrinter printer{directory_ / "tape.csv", 100};
    open(settings(printer));
    const spool::JobId stands = import_waiting(400, 1);
    ASSERT_TRUE(prints_through(stands, 5));
    ASSERT_TRUE(service_->stop(anna, "line1"));
    const spool::JobId other = import_waiting(300, 401);
    const spool::JobId waits = import_waiting(10, 701);
    ASSERT_TRUE(service_->start(anna, other));
    ASSERT_TRUE(comes_to(other, JobPhase::printing));
    wait_for_a_look();
    EXPECT_EQ(view(other).phase, JobPhase::printing);
    EXPECT_EQ(view(waits).phase, JobPhase::queued);
}

TEST_F(ChainTest, shouldClaimNothingWhereTheLineStopsBetweenJobs) {
    SimulatedPrinter printer{directory_ / "tape.csv", 100};
    open(settings(printer, "stop"));
    const spool::JobId job = import_waiting(600, 1);
    ASSERT_TRUE(comes_to(job, JobPhase::printing));
    const spool::JobId next = import_waiting(10, 601);
    wait_for_a_look();
    EXPECT_EQ(view(next).phase, JobPhase::queued);
    text_ = settings(printer, "seamless");
    ASSERT_TRUE(service_->reload(anna));
    EXPECT_TRUE(comes_to(next, JobPhase::arming)) << "as soon as the settings allow it";
    EXPECT_EQ(view(job).phase, JobPhase::printing);
}

/// What lies in a folder when the service is started waits for a person, and with it the queue.
TEST_F(ChainTest, shouldClaimNothingWhileThePrinterIsHeld) {
    SimulatedPrinter printer{directory_ / "tape.csv", 100};
    std::filesystem::rename(file("old.csv", 10, 401), folder() / "old.csv");
    std::this_thread::sleep_for(std::chrono::milliseconds{30}); // the time of files stands still for a tick
    open(settings(printer));
    first_ = import_waiting(400, 1);
    ASSERT_TRUE(comes_to(first_, JobPhase::printing));
    text_ = settings(printer) + "folders:\n  in: {path: " + folder().string() +
            ", layout: serials, printer: line1, autostart: true, settle: rename}\n";
    ASSERT_TRUE(service_->reload(anna));
    ASSERT_TRUE(wait_until([&] { return service_->printer("line1")->held; }));
    const spool::JobId next = import_waiting(10, 411);
    wait_for_a_look();
    EXPECT_EQ(view(next).phase, JobPhase::queued);
    EXPECT_EQ(service_->printer("line1")->queue.size(), 3U);
    EXPECT_EQ(view(first_).phase, JobPhase::printing) << "what is on the line goes on";
}

/// Whatever happens to the claim, all that is asked of the service meanwhile is answered.
TEST_F(ChainTest, shouldNotStandInTheWayOfReloadsAndQueues) {
    SimulatedPrinter printer{directory_ / "tape.csv", 1000};
    open(settings(printer));
    std::atomic<bool> done{false};
    std::thread busy{[&] {
        while (!done) {
            EXPECT_TRUE(service_->reload(anna));
            EXPECT_TRUE(service_->jobs({.limit = 10}));
        }
    }};
    spool::JobId last{};
    for (std::uint32_t i = 0; i < 8; ++i) {
        last = import_waiting(100, 1 + 100 * i);
    }
    EXPECT_TRUE(comes_to(last, JobPhase::finished));
    done = true;
    busy.join();
    service_.reset();
    EXPECT_EQ(printer.products(), serials(1, 800));
}

} // namespace
} // namespace linefeed::service
