#include "cli/progress_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <unistd.h>

namespace linefeed::cli {

namespace {

constexpr auto terminal_interval = std::chrono::milliseconds{200};
constexpr auto plain_interval = std::chrono::seconds{5};
constexpr int bar_width = 30;

std::string line_of(const ProgressView::State& state) {
    char text[64] = "  ";
    if (state.fraction) {
        std::snprintf(text, sizeof text, " %5.1f %%  ", *state.fraction * 100);
    }
    std::string line = state.label + text + state.count;
    if (state.rate_per_s > 0) {
        std::snprintf(text, sizeof text, "  %.*f/s", state.rate_per_s < 10 ? 1 : 0, state.rate_per_s);
        line += text;
    }
    if (state.seconds_left) {
        line += "  " + format_duration(*state.seconds_left) + " left";
    }
    return line;
}

} // namespace

ProgressView::ProgressView(bool quiet)
    : terminal_(::isatty(STDERR_FILENO) != 0)
    , quiet_(quiet) {}

void ProgressView::update(const State& state) {
    const auto now = std::chrono::steady_clock::now();
    const auto interval = terminal_ ? std::chrono::steady_clock::duration{terminal_interval} : plain_interval;
    if (last_ == std::chrono::steady_clock::time_point{} && !terminal_) {
        last_ = now; // the first plain line comes after one interval: short work stays silent
    }
    if (quiet_ || now - last_ < interval) {
        return;
    }
    last_ = now;
    if (!terminal_) {
        std::fprintf(stderr, "linefeed: %s\n", line_of(state).c_str());
        return;
    }
    const int filled = static_cast<int>(std::lround(std::clamp(state.fraction.value_or(0), 0.0, 1.0) * bar_width));
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(bar_width - filled), '-');
    std::fprintf(stderr, "\r\033[K[%s] %s", bar.c_str(), line_of(state).c_str());
    bar_drawn_ = true;
}

void ProgressView::clear_bar() {
    if (bar_drawn_) {
        std::fputs("\r\033[K", stderr);
        bar_drawn_ = false;
    }
}

void ProgressView::message(const std::string& text) {
    clear_bar();
    std::fprintf(stderr, "linefeed: %s\n", text.c_str());
}

void ProgressView::finish() {
    clear_bar();
}

std::string format_duration(double seconds) {
    const auto total = static_cast<std::uint64_t>(std::ceil(std::max(0.0, seconds)));
    char text[64];
    if (total >= 3600) {
        std::snprintf(text, sizeof text, "%llu:%02llu:%02llu", static_cast<unsigned long long>(total / 3600),
                      static_cast<unsigned long long>(total / 60 % 60), static_cast<unsigned long long>(total % 60));
    } else if (total >= 60) {
        std::snprintf(text, sizeof text, "%llu:%02llu", static_cast<unsigned long long>(total / 60),
                      static_cast<unsigned long long>(total % 60));
    } else {
        std::snprintf(text, sizeof text, "%llu s", static_cast<unsigned long long>(total));
    }
    return text;
}

} // namespace linefeed::cli
