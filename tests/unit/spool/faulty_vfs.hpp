// SQLite's own file system with faults: the k-th write or sync fails with a chosen code, once or from then on.
#pragma once

#include <sqlite3.h>

#include <map>

namespace linefeed::spool {

/// The faults to come; one set for the whole process.
struct DiskFaults {
    long calls = 0;        ///< writes, truncations and syncs so far
    long fail_at = -1;     ///< the number of the call that fails, from 0; negative = none
    bool persists = false; ///< every later one fails too
    int write_code = SQLITE_FULL;
    int sync_code = SQLITE_IOERR_FSYNC;
    long failed = 0; ///< calls that were made to fail

    bool next_fails() {
        const long call = calls++;
        const bool fails = fail_at >= 0 && (call == fail_at || (persists && call > fail_at));
        failed += fails ? 1 : 0;
        return fails;
    }
};

inline DiskFaults& disk_faults() {
    static DiskFaults faults;
    return faults;
}

namespace faulty_vfs {

inline constexpr const char* name = "linefeed-faulty";

/// The original methods behind each changed table.
inline std::map<const sqlite3_io_methods*, const sqlite3_io_methods*>& originals() {
    static std::map<const sqlite3_io_methods*, const sqlite3_io_methods*> map;
    return map;
}

inline int write(sqlite3_file* file, const void* data, int size, sqlite3_int64 offset) {
    return disk_faults().next_fails() ? disk_faults().write_code
                                      : originals().at(file->pMethods)->xWrite(file, data, size, offset);
}

inline int sync(sqlite3_file* file, int flags) {
    return disk_faults().next_fails() ? disk_faults().sync_code : originals().at(file->pMethods)->xSync(file, flags);
}

inline int truncate(sqlite3_file* file, sqlite3_int64 size) {
    return disk_faults().next_fails() ? SQLITE_IOERR_TRUNCATE : originals().at(file->pMethods)->xTruncate(file, size);
}

/// A table like `original` with the three calls above; made once for each.
inline const sqlite3_io_methods* changed(const sqlite3_io_methods* original) {
    static std::map<const sqlite3_io_methods*, sqlite3_io_methods> tables;
    auto [entry, is_new] = tables.try_emplace(original, *original);
    if (is_new) {
        entry->second.xWrite = write;
        entry->second.xSync = sync;
        entry->second.xTruncate = truncate;
        originals()[&entry->second] = original;
    }
    return &entry->second;
}

inline int open(sqlite3_vfs* vfs, const char* path, sqlite3_file* file, int flags, int* out_flags) {
    auto* real = static_cast<sqlite3_vfs*>(vfs->pAppData);
    const int code = real->xOpen(real, path, file, flags, out_flags);
    if (code == SQLITE_OK) {
        file->pMethods = changed(file->pMethods);
    }
    return code;
}

/// Makes it known to SQLite under `name`; any number of times.
inline void install() {
    static sqlite3_vfs vfs = [] {
        sqlite3_vfs copy = *sqlite3_vfs_find(nullptr);
        copy.pAppData = sqlite3_vfs_find(nullptr);
        copy.zName = name;
        copy.pNext = nullptr;
        copy.xOpen = open;
        return copy;
    }();
    sqlite3_vfs_register(&vfs, 0);
}

} // namespace faulty_vfs
} // namespace linefeed::spool
