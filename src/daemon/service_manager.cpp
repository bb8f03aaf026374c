#include "daemon/service_manager.hpp"

#include "protocol/printable.hpp"

#include <algorithm>
#include <chrono>
#include <systemd/sd-daemon.h>

namespace linefeed::daemon {

namespace {

void notify(const std::string& state) {
    static_cast<void>(::sd_notify(0, state.c_str())); // what systemd does not hear it asks for by its time-outs
}

/// A line break in it would begin another assignment.
std::string with_status(const char* state, std::string_view status) {
    return std::string{state} + "STATUS=" + protocol::printable(status);
}

} // namespace

void notify_ready(std::string_view status) {
    notify(with_status("READY=1\n", status));
}

void notify_status(std::string_view status) {
    notify(with_status("", status));
}

void notify_reloading() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    notify("RELOADING=1\nMONOTONIC_USEC=" +
           std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(now).count()));
}

void notify_stopping(std::string_view status) {
    notify(with_status("STOPPING=1\n", status));
}

Watchdog::Watchdog(std::vector<Heart> hearts)
    : hearts_(std::move(hearts)) {
    for (const Heart& heart : hearts_) {
        told_.push_back(heart.beats());
    }
}

std::optional<Duration> Watchdog::look_interval() {
    std::uint64_t granted_us = 0;
    if (::sd_watchdog_enabled(0, &granted_us) <= 0) {
        return std::nullopt;
    }
    constexpr std::uint64_t looks = 4;
    const Duration wanted = std::chrono::microseconds{granted_us / looks};
    return std::min<Duration>(wanted, std::chrono::seconds{1});
}

std::vector<std::string> Watchdog::look() {
    std::vector<std::uint64_t> beats;
    std::vector<std::string> still;
    for (std::size_t i = 0; i < hearts_.size(); ++i) {
        beats.push_back(hearts_[i].beats());
        if (beats[i] == told_[i]) {
            still.push_back(hearts_[i].name);
        }
    }
    if (still.empty()) {
        told_ = beats;
        notify("WATCHDOG=1");
    }
    return still;
}

} // namespace linefeed::daemon
