#include "api/upload.hpp"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace linefeed::api {

namespace {

constexpr std::string_view name_prefix = "upload-";

Problem disk_problem(int error) {
    const std::string why = std::generic_category().message(error);
    if (error == ENOSPC || error == EDQUOT) {
        return {ProblemType::disk_full, "the file does not fit beside the spool: " + why, "make room on the disk"};
    }
    return {ProblemType::storage, "the file cannot be written beside the spool: " + why, "look at the disk"};
}

} // namespace

Result<void> prepare_uploads(const std::filesystem::path& folder) {
    std::error_code error;
    const auto failed = [&] {
        return Failure{FailureKind::storage,
                       "the folder of uploads " + folder.string() + " cannot be used: " + error.message()};
    };
    std::filesystem::create_directory(folder, error);
    if (!error) {
        std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
    }
    if (error) {
        return failed();
    }
    for (auto entry = std::filesystem::directory_iterator{folder, error};
         !error && entry != std::filesystem::directory_iterator{}; entry.increment(error)) {
        if (entry->path().filename().native().starts_with(name_prefix)) {
            std::error_code ignored; // the next start tries again
            std::filesystem::remove(entry->path(), ignored);
        }
    }
    return error ? Result<void>{failed()} : Result<void>{};
}

Checked<std::unique_ptr<Upload>> Upload::create(const std::filesystem::path& folder) {
    std::string path = (folder / (std::string{name_prefix} + "XXXXXX")).string();
    const int fd = ::mkostemp(path.data(), O_CLOEXEC);
    if (fd < 0) {
        return disk_problem(errno);
    }
    return std::unique_ptr<Upload>{new Upload{std::move(path), fd}};
}

Upload::~Upload() {
    if (fd_ >= 0) {
        ::close(fd_);
    }
    ::unlink(path_.c_str());
    // SQLite may have left these beside it.
    ::unlink((path_.string() + "-wal").c_str());
    ::unlink((path_.string() + "-shm").c_str());
}

Checked<void> Upload::append(std::string_view bytes) {
    sha256_.update(bytes);
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written < 0) {
            return disk_problem(errno);
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return {};
}

Checked<spool::Sha256Digest> Upload::close() {
    const int closed = ::close(std::exchange(fd_, -1));
    if (closed != 0) {
        return disk_problem(errno);
    }
    return sha256_.finish();
}

} // namespace linefeed::api
