// The simulator over real sockets: who is answered, what lands on the tape, how it ends.
#include "simulator/fleet.hpp"
#include "simulator/simulator.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

namespace linefeed::simulator {
namespace {

using boost::asio::ip::tcp;
using std::chrono::milliseconds;

/// A simulator in a thread of its own; it ends one second after its last client left.
class RunningSimulator {
public:
    explicit RunningSimulator(SimulatorSettings settings)
        : simulator_(with_test_ends(std::move(settings))) {
        const auto address = simulator_.open();
        EXPECT_TRUE(address) << address.error().message;
        port_ = address ? address->substr(address->rfind(':') + 1) : "";
        thread_ = std::thread{[this] { ended_ = simulator_.run().has_value(); }};
    }
    ~RunningSimulator() {
        if (thread_.joinable()) {
            thread_.join();
        }
    }
    RunningSimulator(const RunningSimulator&) = delete;
    RunningSimulator& operator=(const RunningSimulator&) = delete;

    const RunStatistics& wait_for_end() {
        thread_.join();
        EXPECT_TRUE(ended_);
        return simulator_.statistics();
    }
    [[nodiscard]] const std::string& port() const { return port_; }

private:
    static SimulatorSettings with_test_ends(SimulatorSettings settings) {
        settings.port = "0";
        settings.exit_when_idle = std::chrono::seconds{1};
        return settings;
    }

    Simulator simulator_;
    std::string port_;
    std::thread thread_;
    bool ended_ = false;
};

class Client {
public:
    explicit Client(const RunningSimulator& simulator) {
        boost::asio::connect(socket_, tcp::resolver{io_}.resolve("127.0.0.1", simulator.port()));
    }
    void send(const std::string& bytes) { boost::asio::write(socket_, boost::asio::buffer(bytes)); }
    std::string ask(const std::string& bytes) {
        send(bytes);
        return read();
    }
    /// The next answer up to its CR; empty when the simulator has closed the connection.
    std::string read() {
        boost::system::error_code error;
        const std::size_t size = boost::asio::read_until(socket_, boost::asio::dynamic_buffer(received_), '\r', error);
        const std::string line = received_.substr(0, size);
        received_.erase(0, size);
        return line;
    }
    void end_sending() { socket_.shutdown(tcp::socket::shutdown_send); }

private:
    boost::asio::io_context io_;
    tcp::socket socket_{io_};
    std::string received_;
};

TEST(Simulator, shouldPrintOntoTheTapeUntilTheStopNumber) {
    SimulatorSettings settings;
    settings.conveyor.rate = 500;
    settings.tape = testing::TempDir() + "linefeed_simulator_test.csv";
    RunningSimulator simulator{settings};
    {
        Client client{simulator};
        client.send("^0=CM20\r");
        for (int number = 1; number <= 20; ++number) {
            client.send("^0=MR" + std::to_string(number) + "\tM\xFCller " + std::to_string(number) + "\r");
        }
        EXPECT_EQ(client.ask("^0?SM\r"), "^0=SM256\t19\t0\t20\t1\r");
        client.send("^0!GO\r");
        std::string status = client.ask("^0?SM\r");
        while (status != "^0=SM256\t0\t20\t0\t1\r") {
            ASSERT_EQ(status.substr(0, 9), "^0=SM256\t");
            std::this_thread::sleep_for(milliseconds{2});
            status = client.ask("^0?SM\r");
        }
        EXPECT_EQ(client.ask("^0?RS\r"), "^0=RS2\t5\t-1711274809\t0\t9\t1\r");
    }
    const RunStatistics& run = simulator.wait_for_end();
    EXPECT_EQ(run.prints, 20U);
    EXPECT_EQ(run.numbers.doubles() + run.numbers.missing(), 0U);
    EXPECT_EQ(run.highest_fill, 20U);
    std::ifstream tape{*settings.tape};
    std::string line;
    std::getline(tape, line);
    EXPECT_EQ(line, "time_ns,number,text");
    std::int64_t before = 0;
    for (int number = 1; number <= 20; ++number) {
        ASSERT_TRUE(std::getline(tape, line));
        const std::size_t comma = line.find(',');
        EXPECT_EQ(line.substr(comma), "," + std::to_string(number) + ",M\xC3\xBCller " + std::to_string(number));
        const std::int64_t time_ns = std::stoll(line.substr(0, comma));
        EXPECT_GE(time_ns, before + 1000000) << "two products nearer than half a period";
        before = time_ns;
    }
    EXPECT_FALSE(std::getline(tape, line));
    std::filesystem::remove(*settings.tape);
}

TEST(Simulator, shouldAnswerTheClientThatAskedAndTheOneThatHasEndedSending) {
    SimulatorSettings settings;
    settings.server.reply_delay = milliseconds{20};
    RunningSimulator simulator{settings};
    Client first{simulator};
    Client second{simulator};
    second.send("garbage^0=CM5\r^0?S");
    second.send("M\r\n^0?CC\r");
    second.end_sending();
    EXPECT_EQ(first.ask("^0?JL\r"), "^0=JL\\FFSDISK\\JOBS\\Testprint.job\r");
    EXPECT_EQ(second.read(), "^0=SM256\t0\t0\t5\t1\r");
    EXPECT_EQ(second.read(), "^0=CC0\t0\t0\r");
    EXPECT_EQ(second.read(), "");
}

TEST(Simulator, shouldDelayAnswersAndKeepTheirOrder) {
    SimulatorSettings settings;
    settings.server.reply_delay = milliseconds{50};
    RunningSimulator simulator{settings};
    Client client{simulator};
    const auto asked = std::chrono::steady_clock::now();
    EXPECT_EQ(client.ask("^0?SM\r^0?RS\r^0?CC\r"), "^0=SM256\t0\t0\t0\t1\r");
    EXPECT_GE(std::chrono::steady_clock::now() - asked, milliseconds{50});
    EXPECT_EQ(client.read(), "^0=RS2\t5\t0\t0\t9\t1\r");
    EXPECT_EQ(client.read(), "^0=CC0\t0\t0\r");
}

TEST(Simulator, shouldStopTheConveyorAfterItsProducts) {
    SimulatorSettings settings;
    settings.conveyor.rate = 200;
    settings.products = 3;
    RunningSimulator simulator{settings};
    {
        Client client{simulator};
        client.send("^0=MR1\ta\r^0=MR2\tb\r^0=MR3\tc\r^0=MR4\td\r^0=MR5\te\r^0!GO\r");
        std::this_thread::sleep_for(milliseconds{200});
        EXPECT_EQ(client.ask("^0?SM\r"), "^0=SM256\t1\t3\t0\t1\r");
        EXPECT_EQ(client.ask("^0?RS\r"), "^0=RS2\t6\t0\t0\t9\t1\r");
    }
    EXPECT_EQ(simulator.wait_for_end().prints, 3U);
}

TEST(Simulator, shouldLetProductsPassOnAFreeRunningLine) {
    SimulatorSettings settings;
    settings.conveyor.rate = 200;
    settings.conveyor.free_running = true;
    RunningSimulator simulator{settings};
    EXPECT_GT(simulator.wait_for_end().unprinted_products, 50U);
}

TEST(Simulator, shouldStandStillWhileTheInterlockedPrinterDoesNotPrint) {
    SimulatorSettings settings;
    settings.conveyor.rate = 200;
    RunningSimulator simulator{settings};
    EXPECT_EQ(simulator.wait_for_end().unprinted_products, 0U);
}

TEST(Simulator, shouldCauseTheFaultsOrdered) {
    SimulatorSettings settings;
    settings.conveyor.rate = 500;
    settings.faults = {parse_fault("print 2 error 12113").value(), parse_fault("print 4 cut").value()};
    RunningSimulator simulator{settings};
    {
        Client client{simulator};
        client.send("^0=MR1\ta\r^0=MR2\tb\r^0=MR3\tc\r^0!GO\r");
        std::this_thread::sleep_for(milliseconds{100});
        EXPECT_EQ(client.ask("^0?RS\r"), "^0=RS2\t5\t302002001\t0\t9\t1\r");
        EXPECT_EQ(client.ask("^0?SM\r"), "^0=SM256\t0\t2\t0\t1\r");
        client.send("^0=MR3\tc\r^0=MR4\td\r^0!GO\r");
        EXPECT_EQ(client.read(), "");
    }
    const RunStatistics& run = simulator.wait_for_end();
    EXPECT_EQ(run.errors.at(12113), 1U);
    EXPECT_GE(run.prints, 4U);
}

/// As for a benchmark: a PrintGo every 2 ms, and what is missed stops nothing.
SimulatorSettings counting_misses() {
    SimulatorSettings settings;
    settings.conveyor.rate = 500;
    settings.conveyor.keeps_grid = settings.count_misses = true;
    return settings;
}

TEST(Simulator, shouldCountMissesAndGoOn) {
    RunningSimulator simulator{counting_misses()};
    {
        Client client{simulator};
        client.send("^0=CM2\r^0=MR1\tA\r");
        client.ask("^0?SM\r");
        client.send("^0!GO\r");
        std::this_thread::sleep_for(milliseconds{60}); // from 20 ms on a PrintGo every 2 ms: one print, then misses
        EXPECT_EQ(client.ask("^0?RS\r").substr(0, 8), "^0=RS2\t6");
        client.send("^0=MR2\tB\r");
        std::string status;
        while (status != "^0=SM256\t0\t2\t0\t1\r") {
            status = client.ask("^0?SM\r");
            ASSERT_EQ(status.substr(0, 9), "^0=SM256\t");
        }
    }
    const RunStatistics& run = simulator.wait_for_end();
    EXPECT_EQ(run.prints, 2U);
    EXPECT_GE(run.unprinted_products, 5U);
    EXPECT_EQ(run.errors.count(5043), 0U);
}

TEST(Simulator, shouldCountWhatIsMissedBeforeTheFirstRecord) {
    RunningSimulator simulator{counting_misses()};
    {
        Client client{simulator};
        client.send("^0!GO\r");
        std::this_thread::sleep_for(milliseconds{60});
        client.ask("^0?SM\r");
    }
    const RunStatistics& run = simulator.wait_for_end();
    EXPECT_EQ(run.prints, 0U) << "a benchmark is of hosts that send records";
    EXPECT_GE(run.unprinted_products, 5U);
}

TEST(Simulator, shouldEndByASignalThatComesBeforeItRuns) {
    SimulatorSettings settings = counting_misses();
    settings.port = "0";
    FleetSettings one;
    one.report = testing::TempDir() + "linefeed_early_signal_test.json";
    Fleet fleet{settings, one};
    ASSERT_TRUE(fleet.open());
    std::raise(SIGUSR1);
    std::raise(SIGTERM);
    EXPECT_TRUE(fleet.run());
}

TEST(Fleet, shouldRunSeveralPrintersAndReportOnEach) {
    SimulatorSettings settings = counting_misses();
    settings.port = "0";
    FleetSettings two;
    two.printers = 2;
    two.report = testing::TempDir() + "linefeed_fleet_test.json";
    Fleet fleet{settings, two};
    const auto addresses = fleet.open();
    ASSERT_TRUE(addresses);
    ASSERT_EQ(addresses->size(), 2U);
    EXPECT_NE(addresses->at(0), addresses->at(1));
    std::thread host{[port = addresses->at(1).substr(addresses->at(1).rfind(':') + 1)] {
        boost::asio::io_context io;
        tcp::socket socket{io};
        boost::asio::connect(socket, tcp::resolver{io}.resolve("127.0.0.1", port));
        boost::asio::write(socket, boost::asio::buffer(std::string{"^0=CM2\r^0=MR1\tA\r^0=MR2\tB\r^0!GO\r"}));
        std::this_thread::sleep_for(milliseconds{100});
        std::raise(SIGTERM);
    }};
    EXPECT_TRUE(fleet.run());
    host.join();
    ASSERT_TRUE(fleet.write_report());
    EXPECT_EQ(fleet.statistics().at(0)->prints, 0U);
    EXPECT_EQ(fleet.statistics().at(1)->prints, 2U);
    const auto report = nlohmann::json::parse(std::ifstream{*two.report});
    ASSERT_EQ(report["printers"].size(), 2U);
    EXPECT_EQ(report["printers"][1]["prints"], 2);
    EXPECT_EQ(report["printers"][1]["misses"], 0);
    EXPECT_TRUE(report["printers"][0]["lead_ns"]["min"].is_null());
}

TEST(Simulator, shouldSayThatItsPortIsTaken) {
    SimulatorSettings settings;
    RunningSimulator simulator{settings};
    settings.port = simulator.port();
    Simulator second{settings};
    const auto address = second.open();
    ASSERT_FALSE(address);
    EXPECT_EQ(address.error().message, "cannot listen on 127.0.0.1:" + simulator.port() + ": Address already in use");
}

} // namespace
} // namespace linefeed::simulator
