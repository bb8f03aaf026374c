// A service in this process with a directory of its own, printers that are simulated, and files of serial numbers.
#pragma once

#include "config/load.hpp"
#include "daemon/events.hpp"
#include "service/service.hpp"
#include "simulated_printer.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace linefeed::service {

using daemon::JobPhase;

class ServiceTest : public testing::Test {
protected:
    void SetUp() override {
        const std::filesystem::path memory = "/dev/shm";
        const auto base = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
        std::string name = base / "linefeed-service-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        directory_ = name;
    }
    void TearDown() override {
        service_.reset();
        std::filesystem::remove_all(directory_);
    }

    /// The settings, with the printers "line1", "line2" … of these addresses, and `more` behind them.
    [[nodiscard]] std::string settings_text(const std::vector<std::string>& addresses, const std::string& of_each = {},
                                            const std::string& more = {}) const {
        std::string text =
            "spool: " + (directory_ / "spool.db").string() + "\nlayouts: {serials: {columns: [serial]}}\n";
        text += "printers:\n";
        for (std::size_t i = 0; i < addresses.size(); ++i) {
            text += "  line" + std::to_string(i + 1) + ": {address: \"tcp://" + addresses[i] + "\"" + of_each + "}\n";
        }
        return text + more;
    }
    void open(const std::string& text) {
        text_ = text;
        const auto load = [this] { return config::parse_settings(text_, directory_ / "linefeed.yaml", {}); };
        auto settings = load();
        ASSERT_TRUE(settings) << config::to_string(settings.error().kept().front());
        auto service = Service::open({.settings = *settings, .load = load, .version = "test", .take_over = take_over_});
        ASSERT_TRUE(service) << service.error().message;
        service_ = std::move(*service);
        service_->start();
    }

    /// A file of `count` serial numbers from `first` on.
    std::filesystem::path file(const std::string& name, std::uint32_t count, std::uint32_t first = 1) const {
        const std::filesystem::path path = directory_ / name;
        std::ofstream out{path};
        out << "serial\n";
        for (const std::string& text : serials(first, first + count - 1)) {
            out << text << '\n';
        }
        return path;
    }
    /// Imported, and waiting at line1 unless told otherwise.
    spool::JobId import(std::uint32_t count, std::uint32_t first = 1, const std::string& printer = "line1",
                        bool autostart = false) {
        const auto answer = service_->import(anna, {.file = file("f" + std::to_string(first) + ".csv", count, first),
                                                    .name = {},
                                                    .layout = "serials",
                                                    .printer = printer,
                                                    .autostart = autostart});
        EXPECT_TRUE(answer && answer->job) << (answer ? answer->report : answer.error().message);
        return answer ? answer->job.value_or(spool::JobId{}) : spool::JobId{};
    }
    [[nodiscard]] daemon::JobView view(spool::JobId job) {
        const auto view = service_->job(job);
        EXPECT_TRUE(view && *view);
        return view && *view ? **view : daemon::JobView{};
    }
    /// False after 30 s.
    [[nodiscard]] static bool wait_until(const std::function<bool()>& true_now) {
        const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds{30};
        while (!true_now()) {
            if (std::chrono::steady_clock::now() > patience) {
                return false;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds{5});
        }
        return true;
    }
    [[nodiscard]] bool comes_to(spool::JobId job, JobPhase phase) {
        const bool came = wait_until([&] { return view(job).phase == phase; });
        EXPECT_TRUE(came) << "it is " << to_string(view(job).phase) << ": " << view(job).message;
        return came;
    }
    [[nodiscard]] bool prints_through(spool::JobId job, std::uint32_t number) {
        return wait_until([&] { return view(job).printed >= RecordCount{number}; });
    }
    [[nodiscard]] std::vector<std::string> event_kinds() {
        std::vector<std::string> kinds;
        for (const daemon::EventView& event : service_->events(0, 1000).value()) {
            kinds.push_back(event.kind);
        }
        return kinds;
    }

    static inline const daemon::Caller anna{"anna (uid 1000)"};

    std::filesystem::path directory_;
    std::string text_; ///< what a reload reads
    std::function<Result<void>(const config::Settings&)> take_over_ = [](const config::Settings&) {
        return Result<void>{};
    };
    std::unique_ptr<Service> service_;
};

} // namespace linefeed::service
