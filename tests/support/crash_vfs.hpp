// SQLite on a disk in memory that can fail and lose power (crash_disk.hpp says what survives). Fast: nothing leaves the
// process. Use:
//
//     CrashVfs vfs{"my-disk"};                              // a name that no other living instance has
//     SpoolOptions options{clock, vfs.name()};
//     auto spool = Spool::open(directory / "spool", options); // only the lock file and the directory are real
//     …
//     vfs.kill();                                // kill -9: what is open is dead, its destructors change nothing
//     vfs.lose_power(Survival::torn, seed);      // as kill(), and unsynced changes go through the lottery
//     spool = …open again
//
// Not thread safe: one instance belongs to one thread at a time; several instances may be used by several threads.
#pragma once

#include "support/crash_disk.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct sqlite3_vfs;

namespace linefeed::test {

/// What SQLite asks of the disk.
enum class DiskCall {
    open,
    read, ///< and asking for the size
    write,
    truncate,
    sync,
    remove,
    shared_memory, ///< a new region of it
};
inline constexpr std::size_t disk_call_kinds = 7;

/// Calls that fail. A failed write leaves the first half of its bytes; a failed sync drops what was to be synced.
struct DiskFault {
    std::vector<DiskCall> kinds; ///< which calls count; empty = all
    std::uint64_t at = 0;        ///< the number of the call that fails, counted from set_fault(), from 0
    bool persists = false;       ///< and all of these kinds after it
    std::optional<int> code;     ///< SQLite result; absent = the one of the kind: SQLITE_IOERR_WRITE, …_FSYNC, …
};

/// > 0 while code of the VFS runs on this thread: allocations then are not the product's. For tests that make
/// allocations fail, since no exception may pass through SQLite.
inline thread_local int inside_crash_vfs = 0;

class CrashVfs {
public:
    /// Registers with SQLite.
    explicit CrashVfs(std::string name);
    CrashVfs(const CrashVfs&) = delete;
    CrashVfs& operator=(const CrashVfs&) = delete;
    /// Precondition: nothing is open on it any more.
    ~CrashVfs();

    [[nodiscard]] const std::string& name() const { return name_; }

    /// All that is open is dead: its calls fail and change nothing. The files stay as they are.
    void kill();
    /// kill(), and unsynced changes are lost or kept.
    void lose_power(Survival survival, std::uint64_t seed);
    /// What lose_power() would leave.
    [[nodiscard]] DiskImage image(Survival survival, std::uint64_t seed) const { return disk_.image(survival, seed); }
    /// kill(), and all files are replaced.
    void load(const DiskImage& image);

    /// Counting begins now. std::nullopt = no fault any more.
    void set_fault(std::optional<DiskFault> fault);
    /// Calls that were made to fail since construction (by faults or the capacity).
    [[nodiscard]] std::uint64_t failed_calls() const { return failed_calls_; }
    /// Writes beyond this many bytes of all files together fail with SQLITE_FULL; std::nullopt = no limit.
    void set_capacity_bytes(std::optional<std::uint64_t> capacity_bytes) { capacity_bytes_ = capacity_bytes; }
    /// A disk that lies: syncs succeed and make nothing durable. To see that a test would notice.
    void set_ignores_syncs(bool ignores_syncs) { ignores_syncs_ = ignores_syncs; }
    [[nodiscard]] const CrashDisk& disk() const { return disk_; }

    /// Whether handles of this generation still work: a new one begins with each kill().
    [[nodiscard]] bool is_alive(std::uint64_t generation) const { return generation == generation_; }
    /// Calls of a kind since construction, failed ones included.
    [[nodiscard]] std::uint64_t calls(DiskCall kind) const { return calls_[static_cast<std::size_t>(kind)]; }
    /// Called before each call that changes files or makes changes durable (creating, write, truncate, sync, remove):
    /// the points at which a power failure makes a difference. May call image(), and use other instances.
    std::function<void(DiskCall)> before_change;

    /// Makes SQLite's own random numbers (WAL salts) the same in each run of the process. For the whole process.
    static void seed_sqlite_random(int seed);

private:
    friend struct CrashVfsCalls;
    friend struct CrashVfsLocks;

    /// Counts a call and says whether it fails: SQLITE_OK or the code.
    [[nodiscard]] int enter(DiskCall kind);
    void tell_change(DiskCall kind) const;

    std::string name_;
    std::unique_ptr<sqlite3_vfs> vfs_;
    CrashDisk disk_;
    std::uint64_t generation_ = 0; ///< handles of an earlier one are dead
    std::int64_t open_handles_ = 0;
    std::array<std::uint64_t, disk_call_kinds> calls_{};
    std::optional<DiskFault> fault_;
    std::uint64_t counted_ = 0; ///< calls of the fault's kinds
    std::uint64_t failed_calls_ = 0;
    std::optional<std::uint64_t> capacity_bytes_;
    bool ignores_syncs_ = false;
};

} // namespace linefeed::test
