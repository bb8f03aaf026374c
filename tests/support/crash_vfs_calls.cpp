// The calls of SQLite's VFS interface on a CrashVfs: open files and the directory.
#include "support/crash_vfs_calls.hpp"

#include "support/crash_vfs.hpp"
#include "support/crash_vfs_locks.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace linefeed::test {

/// The calls that SQLite makes. Nothing throws: memory that runs out in the test's own disk ends the test.
struct CrashVfsCalls {
    static int close(sqlite3_file* file) noexcept {
        const Inside inside;
        Opened& opened = opened_of(file);
        if (!is_dead(opened)) {
            CrashVfsLocks::unlock(file, SQLITE_LOCK_NONE);
            if (opened.delete_on_close) {
                opened.vfs->disk_.remove(opened.path);
            }
        }
        --opened.vfs->open_handles_;
        delete std::exchange(reinterpret_cast<Handle*>(file)->opened, nullptr);
        return SQLITE_OK;
    }

    static int read(sqlite3_file* file, void* buffer, int size, sqlite3_int64 offset) noexcept {
        const Inside inside;
        const Opened& opened = opened_of(file);
        if (is_dead(opened)) {
            return SQLITE_IOERR_READ;
        }
        if (const int code = opened.vfs->enter(DiskCall::read); code != SQLITE_OK) {
            return code;
        }
        const std::string& content = opened.file->content;
        const auto from = std::min(static_cast<std::size_t>(offset), content.size());
        const auto wanted = static_cast<std::size_t>(size);
        const auto available = std::min(wanted, content.size() - from);
        std::memcpy(buffer, content.data() + from, available);
        std::memset(static_cast<char*>(buffer) + available, 0, wanted - available);
        return available == wanted ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
    }

    static int write(sqlite3_file* file, const void* buffer, int size, sqlite3_int64 offset) noexcept {
        const Inside inside;
        const Opened& opened = opened_of(file);
        if (is_dead(opened)) {
            return SQLITE_IOERR_WRITE;
        }
        CrashVfs& vfs = *opened.vfs;
        const std::string_view data{static_cast<const char*>(buffer), static_cast<std::size_t>(size)};
        const auto at = static_cast<std::uint64_t>(offset);
        const auto write_half = [&] { vfs.disk_.write(*opened.file, at, data.substr(0, data.size() / 2)); };
        if (!opened.path.empty()) {
            vfs.tell_change(DiskCall::write);
        }
        const int code = vfs.enter(DiskCall::write);
        const std::uint64_t size_now = opened.file->content.size();
        const std::uint64_t growth = at + data.size() > size_now ? at + data.size() - size_now : 0;
        if (code != SQLITE_OK) {
            if (!vfs.capacity_bytes_ || vfs.disk_.used_bytes() + growth <= *vfs.capacity_bytes_) {
                write_half();
            }
            return code;
        }
        if (vfs.capacity_bytes_ && growth > 0 && vfs.disk_.used_bytes() + growth > *vfs.capacity_bytes_) {
            ++vfs.failed_calls_;
            return SQLITE_FULL;
        }
        vfs.disk_.write(*opened.file, at, data);
        return SQLITE_OK;
    }

    static int truncate(sqlite3_file* file, sqlite3_int64 size) noexcept {
        const Inside inside;
        const Opened& opened = opened_of(file);
        if (is_dead(opened)) {
            return SQLITE_IOERR_TRUNCATE;
        }
        if (!opened.path.empty()) {
            opened.vfs->tell_change(DiskCall::truncate);
        }
        if (const int code = opened.vfs->enter(DiskCall::truncate); code != SQLITE_OK) {
            return code;
        }
        opened.vfs->disk_.truncate(*opened.file, static_cast<std::uint64_t>(size));
        return SQLITE_OK;
    }

    static int sync(sqlite3_file* file, int /*flags*/) noexcept {
        const Inside inside;
        Opened& opened = opened_of(file);
        if (is_dead(opened)) {
            return SQLITE_IOERR_FSYNC;
        }
        if (!opened.path.empty()) {
            opened.vfs->tell_change(DiskCall::sync);
        }
        if (const int code = opened.vfs->enter(DiskCall::sync); code != SQLITE_OK) {
            opened.vfs->disk_.forget_unsynced(*opened.file);
            return code;
        }
        if (opened.vfs->ignores_syncs_) {
            return SQLITE_OK;
        }
        opened.vfs->disk_.sync(*opened.file);
        if (std::exchange(opened.syncs_directory, false)) {
            opened.vfs->disk_.sync_directory();
        }
        return SQLITE_OK;
    }

    static int file_size(sqlite3_file* file, sqlite3_int64* size) noexcept {
        const Inside inside;
        const Opened& opened = opened_of(file);
        if (is_dead(opened)) {
            return SQLITE_IOERR_FSTAT;
        }
        if (const int code = opened.vfs->enter(DiskCall::read); code != SQLITE_OK) {
            return code;
        }
        *size = static_cast<sqlite3_int64>(opened.file->content.size());
        return SQLITE_OK;
    }

    static int file_control(sqlite3_file* /*file*/, int /*operation*/, void* /*argument*/) noexcept {
        return SQLITE_NOTFOUND;
    }
    // Both as SQLite's unix VFS: the product must be tested with what it gets there.
    static int sector_size(sqlite3_file* /*file*/) noexcept { return 4096; }
    static int device_characteristics(sqlite3_file* /*file*/) noexcept { return SQLITE_IOCAP_POWERSAFE_OVERWRITE; }

    // --- the file system ---

    static CrashVfs& self(sqlite3_vfs* vfs) { return *static_cast<CrashVfs*>(vfs->pAppData); }

    static int open(sqlite3_vfs* raw_vfs, const char* path, sqlite3_file* file, int flags, int* out_flags) noexcept {
        const Inside inside;
        CrashVfs& vfs = self(raw_vfs);
        file->pMethods = nullptr;
        CrashDisk::FilePtr found;
        bool is_new = false;
        if (path == nullptr) {
            found = std::make_shared<CrashDisk::File>();
            found->temporary = true;
        } else {
            found = vfs.disk_.find(path);
            is_new = found == nullptr;
            if (is_new && (flags & SQLITE_OPEN_CREATE) == 0) {
                return SQLITE_CANTOPEN;
            }
            if (is_new) {
                vfs.tell_change(DiskCall::open);
            }
        }
        if (const int code = vfs.enter(DiskCall::open); code != SQLITE_OK) {
            return code;
        }
        if (is_new) {
            found = vfs.disk_.create(path);
        }
        constexpr int journals = SQLITE_OPEN_SUPER_JOURNAL | SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_WAL;
        auto* handle = reinterpret_cast<Handle*>(file);
        handle->opened = new Opened{&vfs,
                                    std::move(found),
                                    path == nullptr ? "" : path,
                                    vfs.generation_,
                                    is_new && (flags & journals) != 0,
                                    path != nullptr && (flags & SQLITE_OPEN_DELETEONCLOSE) != 0};
        file->pMethods = &methods;
        ++vfs.open_handles_;
        if (out_flags != nullptr) {
            *out_flags = flags;
        }
        return SQLITE_OK;
    }

    static int remove(sqlite3_vfs* raw_vfs, const char* path, int syncs_directory) noexcept {
        const Inside inside;
        CrashVfs& vfs = self(raw_vfs);
        if (vfs.disk_.find(path) == nullptr) {
            return SQLITE_IOERR_DELETE_NOENT;
        }
        vfs.tell_change(DiskCall::remove);
        if (const int code = vfs.enter(DiskCall::remove); code != SQLITE_OK) {
            return code;
        }
        vfs.disk_.remove(path);
        if (syncs_directory != 0) {
            vfs.tell_change(DiskCall::sync);
            if (const int code = vfs.enter(DiskCall::sync); code != SQLITE_OK) {
                return SQLITE_IOERR_DIR_FSYNC;
            }
            vfs.disk_.sync_directory();
        }
        return SQLITE_OK;
    }

    static int access(sqlite3_vfs* raw_vfs, const char* path, int flags, int* result) noexcept {
        const Inside inside;
        const auto file = self(raw_vfs).disk_.find(path);
        // As the unix VFS: an empty journal or WAL does not exist.
        *result = file != nullptr && (flags != SQLITE_ACCESS_EXISTS || !file->content.empty()) ? 1 : 0;
        return SQLITE_OK;
    }

    static int full_pathname(sqlite3_vfs* /*vfs*/, const char* path, int size, char* buffer) noexcept {
        sqlite3_snprintf(size, buffer, "%s", path);
        return SQLITE_OK;
    }
    static int randomness(sqlite3_vfs* /*vfs*/, int size, char* buffer) noexcept {
        std::memset(buffer, 0x5A, static_cast<std::size_t>(size));
        return size;
    }
    static int sleep(sqlite3_vfs* /*vfs*/, int microseconds) noexcept { return microseconds; } // nobody else runs
    static int current_time(sqlite3_vfs* /*vfs*/, double* julian_day) noexcept {
        *julian_day = 2460000.5;
        return SQLITE_OK;
    }
    static int current_time_64(sqlite3_vfs* /*vfs*/, sqlite3_int64* julian_ms) noexcept {
        *julian_ms = sqlite3_int64{2460000} * 86'400'000;
        return SQLITE_OK;
    }
    static int last_error(sqlite3_vfs* /*vfs*/, int /*size*/, char* /*buffer*/) noexcept { return 0; }

    static constexpr sqlite3_io_methods methods{2,
                                                close,
                                                read,
                                                write,
                                                truncate,
                                                sync,
                                                file_size,
                                                CrashVfsLocks::lock,
                                                CrashVfsLocks::unlock,
                                                CrashVfsLocks::check_reserved_lock,
                                                file_control,
                                                sector_size,
                                                device_characteristics,
                                                CrashVfsLocks::shm_map,
                                                CrashVfsLocks::shm_lock,
                                                CrashVfsLocks::shm_barrier,
                                                CrashVfsLocks::shm_unmap,
                                                nullptr,
                                                nullptr};
};

void fill_crash_vfs_calls(sqlite3_vfs& vfs) {
    vfs.iVersion = 2;
    vfs.szOsFile = sizeof(Handle);
    vfs.mxPathname = 1024;
    vfs.xOpen = CrashVfsCalls::open;
    vfs.xDelete = CrashVfsCalls::remove;
    vfs.xAccess = CrashVfsCalls::access;
    vfs.xFullPathname = CrashVfsCalls::full_pathname;
    vfs.xRandomness = CrashVfsCalls::randomness;
    vfs.xSleep = CrashVfsCalls::sleep;
    vfs.xCurrentTime = CrashVfsCalls::current_time;
    vfs.xGetLastError = CrashVfsCalls::last_error;
    vfs.xCurrentTimeInt64 = CrashVfsCalls::current_time_64;
}

} // namespace linefeed::test
