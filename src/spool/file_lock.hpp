// Only one process may write a spool: two would put two hosts on one ledger, and SQLite 3.40 can damage a WAL that two
// connections write and checkpoint at once. A lock on a file of its own says so before the database is touched.
#pragma once

#include "base/failure.hpp"

#include <filesystem>
#include <utility>

namespace linefeed::spool {

/// An exclusive lock, held until destroyed; the kernel releases it when the process dies. The file stays: removing it
/// would let two processes hold locks on different files of the same name.
class FileLock {
public:
    /// Creates `file` and locks it without waiting. If another holds it, the failure names `what` and the holder's
    /// process id.
    [[nodiscard]] static Result<FileLock> acquire(const std::filesystem::path& file, const std::string& what);
    /// Holds nothing.
    FileLock() = default;
    FileLock(FileLock&& other) noexcept
        : descriptor_(std::exchange(other.descriptor_, -1)) {}
    FileLock& operator=(FileLock&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;
    ~FileLock();

private:
    explicit FileLock(int descriptor)
        : descriptor_(descriptor) {}
    int descriptor_ = -1;
};

} // namespace linefeed::spool
