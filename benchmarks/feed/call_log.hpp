// When a socket's bytes went in and out, seen where the program meets the kernel: poll, recv, send and their kin are
// replaced in this program by functions that call the real ones and note the time. So a client is measured as it is,
// without a probe inside, and two clients are measured alike.
#pragma once

#include "base/time.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace linefeed::benchmarks {

/// One call that wrote to the socket.
struct WriteCall {
    Instant woken;    ///< when the last wait before it had returned
    Instant received; ///< when the last read before it had returned
    Instant entered;
    Instant returned;
    std::uint64_t bytes_through = 0; ///< written to the socket in all, this call included
    std::uint64_t reads = 0;         ///< that brought bytes from the socket, before it
};

/// The calls of one connection. Written by the thread that uses the socket; read by any other behind size().
class CallLog {
public:
    explicit CallLog(std::size_t capacity)
        : calls_(capacity) {}

    void received(Instant woken, Instant at) {
        woken_ = woken;
        received_ = at;
        ++reads_;
    }
    void wrote(Instant entered, Instant returned, std::size_t bytes);

    [[nodiscard]] std::size_t size() const { return size_.load(std::memory_order_acquire); }
    [[nodiscard]] const WriteCall& operator[](std::size_t index) const { return calls_[index]; }

private:
    std::vector<WriteCall> calls_;
    std::atomic<std::size_t> size_{0};
    Instant woken_{};
    Instant received_{};
    std::uint64_t bytes_ = 0;
    std::uint64_t reads_ = 0;
};

/// From now on connections of this process to `port` are noted in `log`, which must outlive them.
void log_connections_to(std::uint16_t port, CallLog& log);

[[nodiscard]] Instant steady_now();

} // namespace linefeed::benchmarks
