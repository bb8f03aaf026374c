// The least that can refill a printer: a loop that waits, reads, looks for one number and writes ready bytes from
// memory. It knows no errors, no ledger and no stop; it is what linefeed's reaction is compared with.
#pragma once

#include "base/record_page.hpp"
#include "base/time.hpp"
#include "daemon/real_time.hpp"

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace linefeed::benchmarks {

/// Flow: construct with a printer that listens; stop() before the printer closes.
class BareHost {
public:
    /// Keeps `depth` records of `pages` in the printer, asks for `=SM` `poll` after each answer.
    BareHost(std::uint16_t port, const std::vector<RecordPage>& pages, std::uint32_t depth, Duration poll,
             const daemon::RealTimeSettings& real_time);
    ~BareHost();
    BareHost(const BareHost&) = delete;
    BareHost& operator=(const BareHost&) = delete;

private:
    void run(std::uint16_t port, const daemon::RealTimeSettings& real_time);
    void refill(int socket, std::uint32_t printed);

    const std::vector<RecordPage>& pages_;
    std::uint32_t depth_;
    Duration poll_;
    std::uint32_t sent_ = 0;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

} // namespace linefeed::benchmarks
