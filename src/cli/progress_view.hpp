// Progress of long work on stderr: a bar that is drawn over on a terminal, a plain line now and then otherwise.
#pragma once

#include "protocol/printable.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace linefeed::cli {

/// Flow: update() as often as you like, message() for anything else that is to be said, finish() at the end.
class ProgressView {
public:
    /// `quiet` shows messages, but no progress.
    explicit ProgressView(bool quiet);

    struct State {
        std::string label;                  ///< "printing", "importing"
        std::optional<double> fraction = 0; ///< 0…1; absent = nobody knows
        std::string count;                  ///< "1234 of 100000 records"
        double rate_per_s = 0;              ///< 0 = unknown or standing still
        std::optional<double> seconds_left;
    };
    void update(const State& state);
    /// A line of its own.
    void message(const std::string& text);
    /// Ends the bar.
    void finish();

private:
    void clear_bar();

    bool terminal_ = false;
    bool quiet_ = false;
    bool bar_drawn_ = false;
    std::chrono::steady_clock::time_point last_{};
};

/// "1:02:03", "2:03", "7 s".
[[nodiscard]] std::string format_duration(double seconds);

using protocol::printable; // whoever writes for people needs it

} // namespace linefeed::cli
