#include "ram_vfs.hpp"

#include "base/assert.hpp"
#include "ram_disk.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace linefeed::simulation {

namespace {

struct OpenFile {
    sqlite3_file base;
    std::shared_ptr<RamFile> file;
};

RamFile& file_of(sqlite3_file* handle) {
    return *reinterpret_cast<OpenFile*>(handle)->file;
}

int close_file(sqlite3_file* handle) {
    reinterpret_cast<OpenFile*>(handle)->file.~shared_ptr();
    return SQLITE_OK;
}

int read_file(sqlite3_file* handle, void* buffer, int amount, sqlite3_int64 offset) {
    const std::string& bytes = file_of(handle).bytes;
    const auto from = static_cast<std::size_t>(offset);
    const auto wanted = static_cast<std::size_t>(amount);
    const std::size_t there = from >= bytes.size() ? 0 : std::min(wanted, bytes.size() - from);
    if (there > 0) {
        std::memcpy(buffer, bytes.data() + from, there);
    }
    std::memset(static_cast<char*>(buffer) + there, 0, wanted - there);
    return there == wanted ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
}

int write_file(sqlite3_file* handle, const void* data, int amount, sqlite3_int64 offset) {
    return RamDisk::instance().write(file_of(handle), static_cast<std::size_t>(offset), static_cast<const char*>(data),
                                     static_cast<std::size_t>(amount));
}

int truncate_file(sqlite3_file* handle, sqlite3_int64 size) {
    return RamDisk::instance().truncate(file_of(handle), static_cast<std::size_t>(size));
}

int sync_file(sqlite3_file* handle, int) {
    return RamDisk::instance().sync(file_of(handle));
}

int file_size(sqlite3_file* handle, sqlite3_int64* size) {
    *size = static_cast<sqlite3_int64>(file_of(handle).bytes.size());
    return SQLITE_OK;
}

int lock_file(sqlite3_file*, int) {
    return SQLITE_OK; // there is one connection
}

int check_reserved_lock(sqlite3_file*, int* reserved) {
    *reserved = 0;
    return SQLITE_OK;
}

int file_control(sqlite3_file*, int, void*) {
    return SQLITE_NOTFOUND;
}

int sector_size(sqlite3_file*) {
    return 512;
}

int device_characteristics(sqlite3_file*) {
    return 0;
}

int map_shared_memory(sqlite3_file* handle, int region, int size, int, void volatile** address) {
    auto& regions = file_of(handle).shared_memory;
    while (regions.size() <= static_cast<std::size_t>(region)) {
        regions.push_back(std::make_unique<char[]>(static_cast<std::size_t>(size)));
    }
    *address = regions[static_cast<std::size_t>(region)].get();
    return SQLITE_OK;
}

int lock_shared_memory(sqlite3_file*, int, int, int) {
    return SQLITE_OK;
}

void shared_memory_barrier(sqlite3_file*) {}

int unmap_shared_memory(sqlite3_file* handle, int remove) {
    if (remove != 0) {
        file_of(handle).shared_memory.clear();
    }
    return SQLITE_OK;
}

constexpr sqlite3_io_methods io_methods{2,
                                        close_file,
                                        read_file,
                                        write_file,
                                        truncate_file,
                                        sync_file,
                                        file_size,
                                        lock_file,
                                        lock_file,
                                        check_reserved_lock,
                                        file_control,
                                        sector_size,
                                        device_characteristics,
                                        map_shared_memory,
                                        lock_shared_memory,
                                        shared_memory_barrier,
                                        unmap_shared_memory,
                                        nullptr,
                                        nullptr};

int open_file(sqlite3_vfs*, const char* name, sqlite3_file* handle, int flags, int* flags_out) {
    handle->pMethods = nullptr;
    if ((flags & SQLITE_OPEN_CREATE) == 0 && name != nullptr && !RamDisk::instance().exists(name)) {
        return SQLITE_CANTOPEN;
    }
    new (&reinterpret_cast<OpenFile*>(handle)->file) std::shared_ptr<RamFile>{RamDisk::instance().open(name)};
    handle->pMethods = &io_methods;
    if (flags_out != nullptr) {
        *flags_out = flags;
    }
    return SQLITE_OK;
}

int delete_file(sqlite3_vfs*, const char* name, int) {
    if (!RamDisk::instance().exists(name)) {
        return SQLITE_IOERR_DELETE_NOENT;
    }
    RamDisk::instance().remove(name);
    return SQLITE_OK;
}

int access_file(sqlite3_vfs*, const char* name, int, int* result) {
    *result = RamDisk::instance().exists(name) ? 1 : 0;
    return SQLITE_OK;
}

int full_pathname(sqlite3_vfs*, const char* name, int size, char* out) {
    sqlite3_snprintf(size, out, "%s", name);
    return SQLITE_OK;
}

int randomness(sqlite3_vfs*, int size, char* out) {
    std::memset(out, 0x5A, static_cast<std::size_t>(size));
    return size;
}

int sleep_for(sqlite3_vfs*, int microseconds) {
    return microseconds;
}

int current_time(sqlite3_vfs*, double* days) {
    *days = 2460000.5;
    return SQLITE_OK;
}

int last_error(sqlite3_vfs*, int, char*) {
    return 0;
}

int current_time_ms(sqlite3_vfs*, sqlite3_int64* milliseconds) {
    constexpr sqlite3_int64 some_day = 212544043200000;
    *milliseconds = some_day;
    return SQLITE_OK;
}

} // namespace

void register_ram_vfs() {
    static sqlite3_vfs vfs{};
    vfs.iVersion = 2;
    vfs.szOsFile = sizeof(OpenFile);
    vfs.mxPathname = 512;
    vfs.zName = ram_disk_vfs;
    vfs.xOpen = open_file;
    vfs.xDelete = delete_file;
    vfs.xAccess = access_file;
    vfs.xFullPathname = full_pathname;
    vfs.xRandomness = randomness;
    vfs.xSleep = sleep_for;
    vfs.xCurrentTime = current_time;
    vfs.xGetLastError = last_error;
    vfs.xCurrentTimeInt64 = current_time_ms;
    LINEFEED_ASSERT(sqlite3_vfs_register(&vfs, 0) == SQLITE_OK);
}

} // namespace linefeed::simulation
