// What a real-time thread must not do, counted where it does it. The program's own malloc, pthread_mutex_lock, open,
// fsync and their kin come before those of the C library, also for the calls that libstdc++ and SQLite make.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace linefeed::realtime {

enum class Call {
    allocate, ///< malloc and its kin, and with them operator new
    release,  ///< free, of anything: it may lock and return memory to the system
    lock,     ///< a mutex, a condition, a semaphore, a read-write lock
    file,     ///< open, close, read, write, sync of a file; also what goes to a terminal or a pipe
    memory,   ///< mmap and its kin
    sleep,
};
inline constexpr std::size_t call_kinds = 6;
[[nodiscard]] const char* to_string(Call call);

/// Marks the calling thread as one that is not watched although it sends.
void exempt_this_thread();

/// From now on, until it is switched off, the calls of every thread count that has sent something over a socket and is
/// not exempt.
void watch(bool on);

struct CallCounts {
    std::array<std::uint64_t, call_kinds> forbidden{};
    std::uint64_t sends = 0; ///< what the watched threads do for a living
    std::uint64_t receives = 0;

    [[nodiscard]] std::uint64_t of(Call call) const { return forbidden[static_cast<std::size_t>(call)]; }
};
[[nodiscard]] CallCounts counts();

/// Where the first forbidden calls came from, one stack each, for addr2line.
[[nodiscard]] std::string first_stacks();

} // namespace linefeed::realtime
