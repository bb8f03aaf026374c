// Several printers on one feed thread and one store thread: one that answers slowly and one that never answers must not
// hold up the third (design, section 3). The whole daemon::JobRun prints over loopback on the simulator, where a line
// that starves stops with error 5043.
#include "daemon/job_run.hpp"
#include "link/printer_address.hpp"
#include "numbered_job.hpp"
#include "simulator/simulator.hpp"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <chrono>
#include <csignal>
#include <memory>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace linefeed::realtime {
namespace {

using std::chrono::milliseconds;

/// The kernel takes the connection and some bytes for it; nobody ever answers.
class SilentPrinter {
public:
    SilentPrinter()
        : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof(address);
        // The socket interface wants the general type of address.
        auto* general = reinterpret_cast<sockaddr*>(&address);
        if (::bind(socket_, general, size) == 0 && ::listen(socket_, 1) == 0 &&
            ::getsockname(socket_, general, &size) == 0) {
            address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
        }
    }
    ~SilentPrinter() { ::close(socket_); }
    SilentPrinter(const SilentPrinter&) = delete;
    SilentPrinter& operator=(const SilentPrinter&) = delete;

    [[nodiscard]] const std::string& address() const { return address_; }

private:
    int socket_;
    std::string address_;
};

class ManyPrintersTest : public testing::Test {
protected:
    void SetUp() override {
        store_.emplace(directory_.spool());
        static_cast<void>(feed_.start());
    }
    void TearDown() override {
        runs_.clear();
        store_.reset();
        if (line_.joinable()) {
            ::kill(::getpid(), SIGTERM); // the simulators serve until then
            line_.join();
        }
    }

    /// The address of one more simulated printer.
    std::string printer(double rate, milliseconds reply_delay) {
        simulator::SimulatorSettings settings;
        settings.port = "0";
        settings.conveyor.rate = rate;
        settings.printer.print_duration = std::chrono::microseconds{500};
        settings.server.reply_delay = reply_delay;
        simulators_.push_back(std::make_unique<simulator::Simulator>(settings, io_));
        return simulators_.back()->open().value();
    }
    void start_printers() {
        line_ = std::thread{[this] {
            for (const auto& simulator : simulators_) {
                simulator->start();
            }
            io_.run();
        }};
    }
    daemon::JobRun& print(const std::string& address, std::uint32_t records) {
        daemon::JobRunSettings settings;
        settings.printer = link::parse_printer_address("tcp://" + address).value();
        settings.endpoints = link::resolve(settings.printer).value();
        store_->call([&](spool::Spool& spool) {
            const spool::Job job = directory_.import_job(records);
            runs_.push_back(std::make_unique<daemon::JobRun>(daemon::RunThreads{feed_, *store_}, spool, job,
                                                             job.records, std::nullopt, settings));
        });
        runs_.back()->start();
        return *runs_.back();
    }

    SpoolDirectory directory_;
    daemon::FeedThread feed_{{}};
    std::optional<store::StoreThread> store_;
    boost::asio::io_context io_{1};
    std::vector<std::unique_ptr<simulator::Simulator>> simulators_;
    std::thread line_;
    std::vector<std::unique_ptr<daemon::JobRun>> runs_;
};

TEST_F(ManyPrintersTest, shouldNotLetASlowOrASilentPrinterHoldUpAnother) {
    const SilentPrinter silent;
    const std::string slow = printer(20, milliseconds{300});
    const std::string good = printer(500, milliseconds{2});
    start_printers();

    daemon::JobRun& silent_run = print(silent.address(), 1000);
    daemon::JobRun& slow_run = print(slow, 1000);
    daemon::JobRun& good_run = print(good, 1500);
    while (!good_run.finished()) {
        good_run.wait(100);
    }
    good_run.join();
    EXPECT_EQ(good_run.outcome().code, feeder::OutcomeCode::finished) << good_run.detail();
    EXPECT_FALSE(slow_run.finished()) << "it prints for 50 s";
    EXPECT_GT(slow_run.progress().printed_through, RecordNumber{});

    slow_run.request_stop();
    slow_run.join();
    EXPECT_EQ(slow_run.outcome().code, feeder::OutcomeCode::stop_requested);
    silent_run.join(); // ends by itself
    EXPECT_NE(silent_run.outcome().code, feeder::OutcomeCode::finished);
}

TEST_F(ManyPrintersTest, shouldPrintJobAfterJobOnTheSameThreads) {
    const std::string first = printer(1000, milliseconds{1});
    const std::string second = printer(1000, milliseconds{1});
    start_printers();
    for (int round = 0; round < 3; ++round) {
        daemon::JobRun& one = print(first, 300);
        daemon::JobRun& other = print(second, 400);
        one.join();
        other.join();
        EXPECT_EQ(one.outcome().code, feeder::OutcomeCode::finished) << one.detail();
        EXPECT_EQ(other.outcome().code, feeder::OutcomeCode::finished) << other.detail();
        runs_.clear();
    }
    EXPECT_TRUE(directory_.spool().verify_ledger());
}

} // namespace
} // namespace linefeed::realtime
