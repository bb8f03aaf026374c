// The feed thread in the steady state: refills, confirmations, intents, pages and polls go on, and the thread neither
// allocates nor frees, locks, sleeps or touches a file (design, section 3). The whole daemon::JobRun prints over
// loopback on the simulator, and every such call of its feed thread counts (watched_calls.hpp).
#include "daemon/job_run.hpp"
#include "link/printer_address.hpp"
#include "numbered_job.hpp"
#include "simulator/simulator.hpp"
#include "watched_calls.hpp"

#include <boost/asio/io_context.hpp>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace linefeed::realtime {
namespace {

constexpr std::uint32_t records = 8000;
constexpr double print_gos_per_s = 1000;
constexpr std::uint32_t warm_through = 1500; ///< several pages, intents and a `?RS`
constexpr std::uint32_t steady_through = 6500;

class FeedThreadTest : public testing::Test {
protected:
    void SetUp() override {
        job_ = directory_.import_job(records);
        simulator::SimulatorSettings line;
        line.port = "0";
        line.conveyor.rate = print_gos_per_s;
        line.printer.print_duration = std::chrono::microseconds{500};
        simulator_.emplace(line);
        address_ = "tcp://" + simulator_->open().value();
        store_.emplace(directory_.spool());
        static_cast<void>(feed_.start());
        line_ = std::thread{[this] {
            exempt_this_thread();
            simulator_->run().value();
        }};
    }
    void TearDown() override {
        watch(false);
        ::kill(::getpid(), SIGTERM); // the simulator serves until then
        line_.join();
        store_.reset();
    }

    [[nodiscard]] daemon::JobRunSettings settings() const {
        daemon::JobRunSettings settings;
        settings.printer = link::parse_printer_address(address_).value();
        settings.endpoints = link::resolve(settings.printer).value();
        // Five times as many polls and refills as this rate needs.
        settings.session.feeder.pacing.poll_max = std::chrono::milliseconds{5};
        return settings;
    }

    SpoolDirectory directory_;
    daemon::FeedThread feed_{{}};
    std::optional<store::StoreThread> store_;
    spool::Job job_;
    std::optional<simulator::Simulator> simulator_;
    std::string address_;
    std::thread line_;
};

/// Waits until the record is printed, or the run is over.
void wait_for(daemon::JobRun& run, std::uint32_t printed) {
    while (!run.finished() && run.progress().printed_through < RecordNumber{printed}) {
        run.wait(10);
    }
}

TEST_F(FeedThreadTest, shouldNeitherAllocateNorLockNorTouchAFileInTheSteadyState) {
    daemon::LineMeters meters;
    daemon::JobRunSettings watched = settings();
    watched.meters = &meters;
    daemon::FrameHistory frames;
    watched.frames = &frames;
    daemon::JobRun run{{feed_, *store_}, directory_.spool(), job_, job_.records, std::nullopt, watched};
    run.start();
    wait_for(run, warm_through);
    ASSERT_FALSE(run.finished());

    const auto begun = std::chrono::steady_clock::now();
    const RecordNumber sent_before = run.progress().sent_through;
    watch(true);
    wait_for(run, steady_through);
    watch(false);
    const CallCounts seen = counts();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    const RecordNumber sent_after = run.progress().sent_through;

    wait_for(run, records);
    run.join();
    EXPECT_EQ(run.outcome().code, feeder::OutcomeCode::finished);

    // It was measured all the while.
    EXPECT_EQ(meters.records_sent, records);
    EXPECT_EQ(meters.records_printed, records);
    EXPECT_EQ(meters.lead_time.count_from(Duration::zero()), records);
    EXPECT_EQ(meters.refill.count_from(Duration::zero()), meters.refills);
    EXPECT_GT(store_->commit_times().count_from(Duration::zero()), 0U);
    EXPECT_EQ(run.progress().machine->machine, protocol::MachineState::ready_to_print);
    EXPECT_EQ(run.progress().fifo_depth, 256U);
    EXPECT_EQ(frames.frames().size(), 2 * daemon::FrameHistory::frames_kept);
    EXPECT_TRUE(frames.kept().empty());

    // It was at work: otherwise the counts would prove nothing.
    std::cout << seconds << " s, " << seen.sends << " writes and " << seen.receives << " reads of the feed thread, "
              << (sent_after - sent_before).value() << " records\n";
    EXPECT_GE(seconds, 3.0);
    EXPECT_GE((sent_after - sent_before).value(), 4000U);
    EXPECT_GE(seen.sends, 500U);
    EXPECT_GE(seen.receives, 500U);
    for (std::size_t i = 0; i < call_kinds; ++i) {
        EXPECT_EQ(seen.forbidden[i], 0U) << to_string(static_cast<Call>(i));
    }
    if (HasFailure()) {
        std::cout << first_stacks();
    }
}

/// What one printer's turn sets free, another's takes: nothing goes back to the heap in between.
TEST(ManyPrintersFeedThreadTest, shouldNeitherAllocateNorLockNorTouchAFileInTheSteadyState) {
    constexpr int printers = 16;
    constexpr double rate = 300;
    constexpr std::uint32_t many_records = 3000;
    SpoolDirectory directory;
    boost::asio::io_context io{1};
    std::vector<std::unique_ptr<simulator::Simulator>> simulators;
    std::vector<spool::Job> jobs;
    std::vector<daemon::JobRunSettings> settings(printers);
    for (auto& one : settings) {
        simulator::SimulatorSettings line;
        line.port = "0";
        line.conveyor.rate = rate;
        line.printer.print_duration = std::chrono::microseconds{500};
        line.server.reply_delay = std::chrono::milliseconds{2};
        simulators.push_back(std::make_unique<simulator::Simulator>(line, io));
        one.printer = link::parse_printer_address("tcp://" + simulators.back()->open().value()).value();
        one.endpoints = link::resolve(one.printer).value();
        jobs.push_back(directory.import_job(many_records));
    }
    std::thread line{[&] {
        exempt_this_thread();
        for (const auto& simulator : simulators) {
            simulator->start();
        }
        io.run();
    }};
    {
        daemon::FeedThread feed{{}};
        store::StoreThread store{directory.spool()};
        static_cast<void>(feed.start());
        std::vector<daemon::LineMeters> meters(printers);
        std::vector<daemon::FrameHistory> frames(printers);
        std::vector<std::unique_ptr<daemon::JobRun>> runs;
        for (int i = 0; i < printers; ++i) {
            settings[static_cast<std::size_t>(i)].meters = &meters[static_cast<std::size_t>(i)];
            settings[static_cast<std::size_t>(i)].frames = &frames[static_cast<std::size_t>(i)];
            store.call([&](spool::Spool& spool) {
                const spool::Job& job = jobs[static_cast<std::size_t>(i)];
                runs.push_back(std::make_unique<daemon::JobRun>(daemon::RunThreads{feed, store}, spool, job,
                                                                job.records, std::nullopt,
                                                                settings[static_cast<std::size_t>(i)]));
            });
            runs.back()->start();
        }
        for (const auto& run : runs) {
            wait_for(*run, many_records / 3);
        }
        watch(true);
        wait_for(*runs.front(), many_records - 300);
        watch(false);
        for (const auto& run : runs) {
            EXPECT_FALSE(run->finished());
        }
        const CallCounts seen = counts();
        EXPECT_GE(seen.sends, 10000U);
        for (std::size_t i = 0; i < call_kinds; ++i) {
            EXPECT_EQ(seen.forbidden[i], 0U) << to_string(static_cast<Call>(i));
        }
        if (testing::Test::HasFailure()) {
            std::cout << first_stacks();
        }
    }
    ::kill(::getpid(), SIGTERM); // the simulators serve until then
    line.join();
}

TEST_F(FeedThreadTest, shouldTakeAStopFromAnotherThread) {
    daemon::JobRun run{{feed_, *store_}, directory_.spool(), job_, job_.records, std::nullopt, settings()};
    run.start();
    wait_for(run, 500);
    std::thread{[&run] { run.request_stop(); }}.join();
    run.join();
    EXPECT_EQ(run.outcome().code, feeder::OutcomeCode::stop_requested);
}

/// The test of the test: a watched thread is caught.
TEST(WatchedCalls, shouldCountWhatAWatchedThreadDoes) {
    std::array<std::uint64_t, call_kinds> before = counts().forbidden;
    std::thread{[] {
        std::array<int, 2> pair{};
        ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()), 0);
        ASSERT_EQ(::send(pair[0], "x", 1, 0), 1); // makes this thread a watched one
        std::mutex mutex;
        watch(true);
        std::string text(1000, 'x');
        { const std::lock_guard guard{mutex}; }
        const int file = ::open("/dev/null", O_WRONLY);
        ASSERT_EQ(::write(file, text.data(), text.size()), 1000);
        std::string{}.swap(text);
        watch(false);
        ::close(file);
        ::close(pair[0]);
        ::close(pair[1]);
    }}.join();
    const CallCounts after = counts();
    EXPECT_EQ(after.of(Call::allocate) - before[static_cast<std::size_t>(Call::allocate)], 1U);
    EXPECT_EQ(after.of(Call::lock) - before[static_cast<std::size_t>(Call::lock)], 1U);
    EXPECT_EQ(after.of(Call::file) - before[static_cast<std::size_t>(Call::file)], 2U);
    EXPECT_GE(after.of(Call::release) - before[static_cast<std::size_t>(Call::release)], 1U);
}

} // namespace
} // namespace linefeed::realtime
