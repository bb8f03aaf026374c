// A server over FakeOperations in a directory of its own.
#pragma once

#include "api/server.hpp"
#include "fake_operations.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <grp.h>
#include <memory>
#include <unistd.h>

namespace linefeed::api {

class RunningServer : public testing::Test {
protected:
    RunningServer() {
        std::filesystem::create_directories(directory_);
        settings_.spool = directory_ / "spool.db";
        settings_.control.socket = directory_ / "linefeed.sock";
        settings_.control.group = ::getgrgid(::getgid())->gr_name;
        settings_.http.port = 0;
    }
    ~RunningServer() override {
        server_.reset();
        std::filesystem::remove_all(directory_);
    }
    void start() {
        server_ = std::make_unique<Server>(operations_, settings_);
        const auto started = server_->start();
        ASSERT_TRUE(started) << started.error().message;
    }

    const std::filesystem::path directory_ =
        std::filesystem::temp_directory_path() / ("linefeed_api_" + std::to_string(::getpid()));
    config::Settings settings_;
    FakeOperations operations_;
    std::unique_ptr<Server> server_;
};

} // namespace linefeed::api
