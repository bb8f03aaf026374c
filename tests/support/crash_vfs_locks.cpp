#include "support/crash_vfs_locks.hpp"

namespace linefeed::test {

int CrashVfsLocks::lock(sqlite3_file* file, int level) noexcept {
    Opened& opened = opened_of(file);
    if (is_dead(opened)) {
        return SQLITE_IOERR_LOCK;
    }
    CrashDisk::Sharing& sharing = opened.file->sharing;
    const auto held_by_other = [&opened](const void* holder) { return holder != nullptr && holder != &opened; };
    if (opened.lock < SQLITE_LOCK_SHARED && level >= SQLITE_LOCK_SHARED) {
        if (held_by_other(sharing.pending) || held_by_other(sharing.exclusive)) {
            return SQLITE_BUSY;
        }
        ++sharing.readers;
        opened.lock = SQLITE_LOCK_SHARED;
    }
    if (opened.lock < SQLITE_LOCK_RESERVED && level == SQLITE_LOCK_RESERVED) {
        if (held_by_other(sharing.reserved)) {
            return SQLITE_BUSY;
        }
        sharing.reserved = &opened;
        opened.lock = SQLITE_LOCK_RESERVED;
    }
    if (opened.lock < SQLITE_LOCK_EXCLUSIVE && level == SQLITE_LOCK_EXCLUSIVE) {
        if (held_by_other(sharing.pending) || held_by_other(sharing.reserved)) {
            return SQLITE_BUSY;
        }
        sharing.pending = &opened;
        opened.lock = SQLITE_LOCK_PENDING;
        if (sharing.readers > 1) {
            return SQLITE_BUSY;
        }
        sharing.exclusive = &opened;
        opened.lock = SQLITE_LOCK_EXCLUSIVE;
    }
    return SQLITE_OK;
}

int CrashVfsLocks::unlock(sqlite3_file* file, int level) noexcept {
    Opened& opened = opened_of(file);
    if (is_dead(opened) || opened.lock <= level) {
        return SQLITE_OK;
    }
    CrashDisk::Sharing& sharing = opened.file->sharing;
    const auto give_up = [&opened](const void*& holder) { holder = holder == &opened ? nullptr : holder; };
    give_up(sharing.exclusive);
    give_up(sharing.pending);
    give_up(sharing.reserved);
    if (level == SQLITE_LOCK_NONE) {
        --sharing.readers;
    }
    opened.lock = level;
    return SQLITE_OK;
}

int CrashVfsLocks::check_reserved_lock(sqlite3_file* file, int* result) noexcept {
    const Opened& opened = opened_of(file);
    *result = !is_dead(opened) && opened.file->sharing.reserved != nullptr ? 1 : 0;
    return SQLITE_OK;
}

int CrashVfsLocks::shm_map(sqlite3_file* file, int region, int size, int extend, void volatile** memory) noexcept {
    const Inside inside;
    *memory = nullptr;
    Opened& opened = opened_of(file);
    if (is_dead(opened)) {
        return SQLITE_IOERR_SHMMAP;
    }
    CrashDisk::Sharing& sharing = opened.file->sharing;
    const auto index = static_cast<std::size_t>(region);
    CrashDisk::Regions& regions = *sharing.shm_regions;
    if (opened.shm == nullptr || index >= regions.size()) {
        if (const int code = opened.vfs->enter(DiskCall::shared_memory); code != SQLITE_OK) {
            return code;
        }
    }
    if (opened.shm == nullptr) {
        opened.shm = sharing.shm_regions;
        ++sharing.shm_users;
    }
    while (index >= regions.size() && extend != 0) {
        regions.push_back(std::make_unique<char[]>(static_cast<std::size_t>(size))); // zeros
    }
    if (index < regions.size()) {
        *memory = regions[index].get();
    }
    return SQLITE_OK;
}

int CrashVfsLocks::shm_lock(sqlite3_file* file, int first, int count, int flags) noexcept {
    Opened& opened = opened_of(file);
    const bool unlocks = (flags & SQLITE_SHM_UNLOCK) != 0;
    if (is_dead(opened)) {
        return unlocks ? SQLITE_OK : SQLITE_IOERR_SHMLOCK;
    }
    CrashDisk::Sharing& sharing = opened.file->sharing;
    const bool exclusive = (flags & SQLITE_SHM_EXCLUSIVE) != 0;
    if (!unlocks) {
        for (int i = first; i < first + count; ++i) {
            const bool own_shared = (opened.shm_shared & (1U << i)) != 0;
            const bool own_exclusive = (opened.shm_exclusive & (1U << i)) != 0;
            const bool other_writes = sharing.shm_writer[i] && !own_exclusive;
            const bool other_reads = sharing.shm_readers[i] > (own_shared ? 1 : 0);
            if (other_writes || (exclusive && other_reads)) {
                return SQLITE_BUSY;
            }
        }
    }
    for (int i = first; i < first + count; ++i) {
        unsigned& own = exclusive ? opened.shm_exclusive : opened.shm_shared;
        const unsigned bit = 1U << i;
        if (unlocks == ((own & bit) == 0)) {
            continue; // as it is wanted already
        }
        own ^= bit;
        if (exclusive) {
            sharing.shm_writer[i] = !unlocks;
        } else {
            sharing.shm_readers[i] += unlocks ? -1 : 1;
        }
    }
    return SQLITE_OK;
}

void CrashVfsLocks::shm_barrier(sqlite3_file* /*file*/) noexcept {}

int CrashVfsLocks::shm_unmap(sqlite3_file* file, int /*deletes*/) noexcept {
    const Inside inside;
    Opened& opened = opened_of(file);
    if (is_dead(opened) || opened.shm == nullptr) {
        return SQLITE_OK;
    }
    opened.shm = nullptr;
    shm_lock(file, 0, CrashDisk::Sharing::shm_locks, SQLITE_SHM_UNLOCK | SQLITE_SHM_SHARED);
    shm_lock(file, 0, CrashDisk::Sharing::shm_locks, SQLITE_SHM_UNLOCK | SQLITE_SHM_EXCLUSIVE);
    if (--opened.file->sharing.shm_users == 0) {
        opened.file->sharing.shm_regions->clear();
    }
    return SQLITE_OK;
}

} // namespace linefeed::test
