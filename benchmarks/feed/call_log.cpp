#include "call_log.hpp"

#include "base/assert.hpp"

#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <csignal>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace linefeed::benchmarks {

namespace {

struct Watched {
    std::uint16_t port = 0;
    CallLog* log = nullptr;
};
constexpr std::size_t max_ports = 4;
constexpr std::size_t max_descriptors = 256;
std::array<Watched, max_ports> watched_ports;
std::size_t watched_size = 0;
thread_local Instant woken;
std::array<std::atomic<CallLog*>, max_descriptors> log_of_descriptor{};

CallLog* log_of(int descriptor) {
    return descriptor >= 0 && static_cast<std::size_t>(descriptor) < max_descriptors
               ? log_of_descriptor[static_cast<std::size_t>(descriptor)].load(std::memory_order_relaxed)
               : nullptr;
}

void watch(int descriptor, const sockaddr* address) {
    if (address->sa_family != AF_INET || descriptor < 0 || static_cast<std::size_t>(descriptor) >= max_descriptors) {
        return;
    }
    const auto port = ntohs(reinterpret_cast<const sockaddr_in*>(address)->sin_port);
    for (std::size_t i = 0; i < watched_size; ++i) {
        if (watched_ports[i].port == port) {
            log_of_descriptor[static_cast<std::size_t>(descriptor)] = watched_ports[i].log;
        }
    }
}

template <typename Call>
ssize_t logged_write(int descriptor, Call call) {
    CallLog* const log = log_of(descriptor);
    if (log == nullptr) {
        return call();
    }
    const Instant entered = steady_now();
    const ssize_t written = call();
    const int error = errno;
    if (written > 0) {
        log->wrote(entered, steady_now(), static_cast<std::size_t>(written));
    }
    errno = error;
    return written;
}

template <typename Call>
ssize_t logged_read(int descriptor, Call call) {
    const ssize_t size = call();
    if (CallLog* const log = size > 0 ? log_of(descriptor) : nullptr; log != nullptr) {
        log->received(woken, steady_now());
    }
    return size;
}

} // namespace

void CallLog::wrote(Instant entered, Instant returned, std::size_t bytes) {
    const std::size_t index = size_.load(std::memory_order_relaxed);
    LINEFEED_ASSERT(index < calls_.size());
    bytes_ += bytes;
    calls_[index] = {woken_, received_, entered, returned, bytes_, reads_};
    size_.store(index + 1, std::memory_order_release);
}

void log_connections_to(std::uint16_t port, CallLog& log) {
    LINEFEED_ASSERT(watched_size < max_ports);
    watched_ports[watched_size++] = {port, &log};
}

Instant steady_now() {
    return Instant{std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

} // namespace linefeed::benchmarks

using namespace linefeed::benchmarks;

// The program's own definitions come before those of the C library.
extern "C" {

int connect(int descriptor, const sockaddr* address, socklen_t size) {
    watch(descriptor, address);
    return static_cast<int>(::syscall(SYS_connect, descriptor, address, size));
}

int epoll_wait(int descriptor, epoll_event* events, int size, int timeout_ms) {
    const auto ready = static_cast<int>(::syscall(SYS_epoll_wait, descriptor, events, size, timeout_ms));
    woken = steady_now();
    return ready;
}

int ppoll(pollfd* descriptors, nfds_t size, const timespec* timeout, const sigset_t* signals) {
    timespec left = timeout == nullptr ? timespec{} : *timeout; // the kernel writes into it
    const auto ready = static_cast<int>(
        ::syscall(SYS_ppoll, descriptors, size, timeout == nullptr ? nullptr : &left, signals, _NSIG / 8));
    woken = steady_now();
    return ready;
}

ssize_t sendmsg(int descriptor, const msghdr* message, int flags) {
    return logged_write(descriptor, [&] { return ::syscall(SYS_sendmsg, descriptor, message, flags); });
}

ssize_t send(int descriptor, const void* data, size_t size, int flags) {
    return logged_write(descriptor, [&] { return ::syscall(SYS_sendto, descriptor, data, size, flags, nullptr, 0); });
}

ssize_t recvmsg(int descriptor, msghdr* message, int flags) {
    return logged_read(descriptor, [&] { return ::syscall(SYS_recvmsg, descriptor, message, flags); });
}

ssize_t recv(int descriptor, void* data, size_t size, int flags) {
    return logged_read(descriptor,
                       [&] { return ::syscall(SYS_recvfrom, descriptor, data, size, flags, nullptr, nullptr); });
}

} // extern "C"
