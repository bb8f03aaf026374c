#include "support/crash_vfs.hpp"

#include "base/assert.hpp"
#include "support/crash_vfs_calls.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <utility>

namespace linefeed::test {

namespace {

int natural_code(DiskCall kind) {
    switch (kind) {
    case DiskCall::open:
        return SQLITE_CANTOPEN;
    case DiskCall::read:
        return SQLITE_IOERR_READ;
    case DiskCall::write:
        return SQLITE_IOERR_WRITE;
    case DiskCall::truncate:
        return SQLITE_IOERR_TRUNCATE;
    case DiskCall::sync:
        return SQLITE_IOERR_FSYNC;
    case DiskCall::remove:
        return SQLITE_IOERR_DELETE;
    case DiskCall::shared_memory:
        return SQLITE_IOERR_SHMMAP;
    }
    return SQLITE_IOERR;
}

} // namespace

CrashVfs::CrashVfs(std::string name)
    : name_(std::move(name))
    , vfs_(std::make_unique<sqlite3_vfs>()) {
    LINEFEED_ASSERT(sqlite3_vfs_find(name_.c_str()) == nullptr);
    vfs_->zName = name_.c_str();
    vfs_->pAppData = this;
    fill_crash_vfs_calls(*vfs_);
    const int registered = sqlite3_vfs_register(vfs_.get(), 0);
    LINEFEED_ASSERT(registered == SQLITE_OK);
}

CrashVfs::~CrashVfs() {
    LINEFEED_ASSERT(open_handles_ == 0);
    sqlite3_vfs_unregister(vfs_.get());
}

void CrashVfs::kill() {
    ++generation_;
    disk_.release_all();
}

void CrashVfs::lose_power(Survival survival, std::uint64_t seed) {
    load(disk_.image(survival, seed));
}

void CrashVfs::load(const DiskImage& image) {
    kill();
    disk_.load(image);
}

void CrashVfs::set_fault(std::optional<DiskFault> fault) {
    fault_ = std::move(fault);
    counted_ = 0;
}

int CrashVfs::enter(DiskCall kind) {
    ++calls_[static_cast<std::size_t>(kind)];
    if (!fault_) {
        return SQLITE_OK;
    }
    const auto& kinds = fault_->kinds;
    if (!kinds.empty() && std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) {
        return SQLITE_OK;
    }
    const std::uint64_t call = counted_++;
    if (call != fault_->at && !(fault_->persists && call > fault_->at)) {
        return SQLITE_OK;
    }
    ++failed_calls_;
    return fault_->code.value_or(natural_code(kind));
}

void CrashVfs::tell_change(DiskCall kind) const {
    if (before_change) {
        before_change(kind);
    }
}

void CrashVfs::seed_sqlite_random(int seed) {
    sqlite3_initialize();
    sqlite3_test_control(SQLITE_TESTCTRL_PRNG_SEED, seed, nullptr);
}

} // namespace linefeed::test
