#include "spool/file_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

namespace linefeed::spool {

namespace {

Failure system_failure(const std::filesystem::path& file, int error) {
    return {FailureKind::storage, file.string() + ": " + std::generic_category().message(error)};
}

/// The process id that the holder wrote into the file, in words; empty if it cannot be read.
std::string holder(int descriptor) {
    char text[24];
    const ssize_t size = ::pread(descriptor, text, sizeof text, 0);
    const std::string_view digits{text, size > 0 ? static_cast<std::size_t>(size) : 0};
    const auto end = digits.find_first_not_of("0123456789");
    const std::string pid{digits.substr(0, end)};
    return pid.empty() ? "" : " (process " + pid + ")";
}

} // namespace

Result<FileLock> FileLock::acquire(const std::filesystem::path& file, const std::string& what) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
    if (descriptor < 0) {
        return system_failure(file, errno);
    }
    FileLock lock{descriptor};
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) {
            return Failure{FailureKind::storage, what + " is in use by another linefeed" + holder(descriptor)};
        }
        return system_failure(file, errno);
    }
    // The process id only serves the message above: a full disk must not keep the spool closed.
    const std::string pid = std::to_string(::getpid()) + '\n';
    if (::ftruncate(descriptor, 0) == 0) {
        [[maybe_unused]] const ssize_t written = ::pwrite(descriptor, pid.data(), pid.size(), 0);
    }
    return lock;
}

FileLock::~FileLock() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

} // namespace linefeed::spool
