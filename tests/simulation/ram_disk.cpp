#include "ram_disk.hpp"

#include "ram_vfs.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>

namespace linefeed::simulation {

RamDisk& RamDisk::instance() {
    static RamDisk disk;
    return disk;
}

RamDisk::RamDisk() {
    // One thread only: no locks, and nobody asks how much memory is in use.
    sqlite3_config(SQLITE_CONFIG_SINGLETHREAD);
    sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
    register_ram_vfs();
}

void RamDisk::format(bool remembers_unsynced) {
    files_.clear();
    writes_left_ = forever;
    remembers_unsynced_ = remembers_unsynced;
    full_ = false;
}

void RamDisk::process_gone() {
    writes_left_ = forever;
    for (auto& [name, file] : files_) {
        file->shared_memory.clear();
    }
}

void RamDisk::lose_power(Random& random) {
    constexpr std::size_t sector = 512;
    // Discs differ: one keeps all it was given, one keeps nothing, one this and that.
    const std::uint64_t temper = random.below(3);
    for (auto& [name, file] : files_) {
        std::vector<RamFile::Unsynced> writes;
        writes.swap(file->unsynced);
        for (auto write = writes.rbegin(); write != writes.rend(); ++write) {
            if (write->truncates) {
                file->bytes.resize(write->offset);
                file->bytes += write->before;
                continue;
            }
            std::copy(write->before.begin(), write->before.end(),
                      file->bytes.begin() + static_cast<std::ptrdiff_t>(write->offset));
            file->bytes.resize(write->size_before);
        }
        for (RamFile::Unsynced& write : writes) {
            const bool kept = temper == 0 || (temper == 2 && random.chance(0.5));
            if (!kept) {
                continue;
            }
            if (write.truncates) {
                file->bytes.resize(write.offset);
                continue;
            }
            if (temper == 2 && random.chance(0.3)) {
                write.after.resize(random.below(write.after.size() / sector + 1) * sector);
            }
            if (file->bytes.size() < write.offset + write.after.size()) {
                file->bytes.resize(write.offset + write.after.size());
            }
            std::memcpy(file->bytes.data() + write.offset, write.after.data(), write.after.size());
        }
    }
}

std::shared_ptr<RamFile> RamDisk::open(const char* name) {
    if (name == nullptr) {
        return std::make_shared<RamFile>();
    }
    auto& file = files_[name];
    if (!file) {
        file = std::make_shared<RamFile>();
    }
    return file;
}

void RamDisk::remove(const std::string& name) {
    if (reaches_disk()) {
        files_.erase(name);
    }
}

bool RamDisk::reaches_disk() {
    if (writes_left_ == forever) {
        return true;
    }
    if (writes_left_ == 0) {
        return false;
    }
    --writes_left_;
    return true;
}

int RamDisk::write(RamFile& file, std::size_t offset, const char* data, std::size_t size) {
    if (!reaches_disk()) {
        return SQLITE_OK;
    }
    const std::size_t end = offset + size;
    if (full_ && end > file.bytes.size()) {
        ++refusals_;
        return SQLITE_FULL;
    }
    if (remembers_unsynced_) {
        RamFile::Unsynced write{offset, {}, std::string{data, size}, file.bytes.size(), false};
        if (offset < file.bytes.size()) {
            write.before = file.bytes.substr(offset, size);
        }
        file.unsynced.push_back(std::move(write));
    }
    if (file.bytes.size() < end) {
        if (file.bytes.capacity() < end) {
            file.bytes.reserve(end * 2);
        }
    }
    if (file.bytes.size() == offset) {
        file.bytes.append(data, size);
        return SQLITE_OK;
    }
    if (file.bytes.size() < end) {
        file.bytes.resize(end);
    }
    std::memcpy(file.bytes.data() + offset, data, size);
    return SQLITE_OK;
}

int RamDisk::truncate(RamFile& file, std::size_t size) {
    if (!reaches_disk() || size >= file.bytes.size()) {
        return SQLITE_OK;
    }
    if (remembers_unsynced_) {
        file.unsynced.push_back({size, file.bytes.substr(size), {}, file.bytes.size(), true});
    }
    file.bytes.resize(size);
    return SQLITE_OK;
}

int RamDisk::sync(RamFile& file) {
    if (reaches_disk()) {
        ++syncs_;
        file.unsynced.clear();
    }
    return SQLITE_OK;
}

} // namespace linefeed::simulation
