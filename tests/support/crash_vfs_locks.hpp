// Open files of a CrashVfs, and what connections share of them: locks and the index of the WAL.
#pragma once

#include "support/crash_vfs.hpp"

#include <sqlite3.h>

#include <memory>
#include <string>

namespace linefeed::test {

/// One open file of one connection.
struct Opened {
    CrashVfs* vfs;
    CrashDisk::FilePtr file;
    std::string path; ///< empty = temporary
    std::uint64_t generation;
    bool syncs_directory; ///< a new journal: its first sync makes its name durable
    bool delete_on_close;
    int lock = SQLITE_LOCK_NONE;
    std::shared_ptr<CrashDisk::Regions> shm = nullptr; ///< stays readable when this handle is dead
    unsigned shm_shared = 0;                           ///< bit per lock
    unsigned shm_exclusive = 0;
};

struct Handle {
    sqlite3_file base;
    Opened* opened;
};

inline Opened& opened_of(sqlite3_file* file) {
    return *reinterpret_cast<Handle*>(file)->opened;
}

/// The code of the VFS runs.
class Inside {
public:
    Inside() { ++inside_crash_vfs; }
    ~Inside() { --inside_crash_vfs; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
};

[[nodiscard]] inline bool is_dead(const Opened& opened) {
    return !opened.vfs->is_alive(opened.generation);
}

/// Entries of sqlite3_io_methods.
struct CrashVfsLocks {
    static int lock(sqlite3_file* file, int level) noexcept;
    static int unlock(sqlite3_file* file, int level) noexcept;
    static int check_reserved_lock(sqlite3_file* file, int* result) noexcept;
    static int shm_map(sqlite3_file* file, int region, int size, int extend, void volatile** memory) noexcept;
    static int shm_lock(sqlite3_file* file, int first, int count, int flags) noexcept;
    static void shm_barrier(sqlite3_file* file) noexcept;
    static int shm_unmap(sqlite3_file* file, int deletes) noexcept;
};

} // namespace linefeed::test
