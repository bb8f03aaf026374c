// What linefeed does to a printer besides feeding it, each on a connection of its own: acknowledging one error, and
// keeping people away from the panel.
#pragma once

#include "base/failure.hpp"
#include "printer/printer_client.hpp"
#include "protocol/printer_error.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace linefeed::printer {

/// `!EQ`, if the printer still shows the error with this number (PrinterError::code(), or without bit 24); there is no
/// blind one. The error that it shows then, if another stood behind it. Blocks. FailureKind::stopped: it shows
/// another error, or none, or this one still after `!EQ`; ::unreachable: it does not answer.
[[nodiscard]] Result<protocol::PrinterError> acknowledge(const ClientSettings& settings, std::uint32_t error);
/// The same on a connection that is there.
[[nodiscard]] Result<protocol::PrinterError> acknowledge(PrinterClient& printer, std::uint32_t error);

/// `!US`, which blocks the printer's panel for 10 s, repeated on a connection of its own as long as it is wanted. `!UR`
/// ends it, whatever the reason: taken back, time over, service ending; where the connection is lost meanwhile on
/// a new one, and if there is none the printer ends it by itself. Any thread but the feed thread.
class PanelHold {
public:
    /// `repeat` < 10 s.
    explicit PanelHold(const ClientSettings& settings, Duration repeat = std::chrono::seconds{3});
    /// Releases.
    ~PanelHold();
    PanelHold(const PanelHold&) = delete;
    PanelHold& operator=(const PanelHold&) = delete;

    /// Holds the panel, or goes on holding it, for so long from now. Blocks until the printer has answered, or gives up
    /// with FailureKind::unreachable; then it is not held.
    [[nodiscard]] Result<void> hold(Duration time);
    /// Blocks until `!UR` is on its way; nothing if it is not held.
    void release();
    /// The printer has answered behind the last `!US`. Never blocks.
    [[nodiscard]] bool held() const { return held_.load(std::memory_order_relaxed); }

private:
    using Clock = std::chrono::steady_clock;

    void run();
    [[nodiscard]] Result<void> suspend();
    void resume();

    ClientSettings settings_;
    Duration repeat_;
    std::mutex mutex_; ///< guards what follows, also while the printer is talked to
    std::condition_variable changed_;
    std::optional<Clock::time_point> until_; ///< absent = not wanted
    Clock::time_point next_{};               ///< next `!US`
    std::unique_ptr<PrinterClient> client_;
    bool ending_ = false;
    std::atomic<bool> held_{false};
    std::thread thread_;
};

} // namespace linefeed::printer
