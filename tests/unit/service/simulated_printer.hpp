// A printer with a conveyor in this process, on a thread of its own, and what stuck to its products: the only judge of
// what was printed.
#pragma once

#include "simulator/simulator.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace linefeed::service {

class SimulatedPrinter {
public:
    /// `port` "0" = any.
    SimulatedPrinter(std::filesystem::path tape, double rate, const std::string& port = "0",
                     simulator::SimulatorSettings settings = {})
        : tape_(std::move(tape)) {
        settings.port = port;
        settings.tape = tape_.string();
        settings.conveyor.rate = rate;
        settings.printer.print_duration = std::chrono::microseconds{300};
        simulator_.emplace(settings, io_);
        address_ = simulator_->open().value();
        simulator_->start();
        line_ = std::thread{[this] { io_.run(); }};
    }
    ~SimulatedPrinter() { stop(); }
    SimulatedPrinter(const SimulatedPrinter&) = delete;
    SimulatedPrinter& operator=(const SimulatedPrinter&) = delete;

    /// "127.0.0.1:PORT".
    [[nodiscard]] const std::string& address() const { return address_; }
    [[nodiscard]] std::string port() const { return address_.substr(address_.rfind(':') + 1); }

    void stop() {
        if (line_.joinable()) {
            io_.stop();
            line_.join();
            EXPECT_TRUE(simulator_->finish());
            simulator_.reset();
        }
    }
    /// The texts on the products, in order. The printer is gone then.
    [[nodiscard]] std::vector<std::string> products() {
        stop();
        std::vector<std::string> texts;
        std::ifstream file{tape_};
        std::string line;
        std::getline(file, line); // time_ns,number,text
        while (std::getline(file, line)) {
            texts.push_back(line.substr(line.rfind(',') + 1));
        }
        return texts;
    }

private:
    std::filesystem::path tape_;
    boost::asio::io_context io_{1};
    std::optional<simulator::Simulator> simulator_;
    std::string address_;
    std::thread line_;
};

/// SN-first … SN-last, as on the products of a job.
inline std::vector<std::string> serials(std::uint32_t first, std::uint32_t last) {
    std::vector<std::string> texts;
    for (std::uint32_t number = first; number <= last; ++number) {
        texts.push_back("SN-" + std::to_string(number));
    }
    return texts;
}

} // namespace linefeed::service
