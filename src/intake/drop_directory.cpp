#include "intake/drop_directory.hpp"

#include "base/assert.hpp"
#include "intake/drop_names.hpp"

#include <climits>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <dirent.h>
#include <fcntl.h>
#include <memory>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

namespace linefeed::intake {

namespace {

constexpr const char* processing_name = "processing";
constexpr const char* lock_name = ".lock";    ///< in processing/
constexpr const char* draft_name = ".report"; ///< of a report, in done/ and failed/
/// So many files of one name can lie in a folder.
constexpr unsigned most_attempts = 1'000'000;

std::string words(int error) {
    return std::generic_category().message(error);
}

/// Returns 0 if there is nothing of this name, EEXIST or another error.
int check_absent(int directory, const std::string& name) {
    struct stat status {};
    if (::fstatat(directory, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0) {
        return EEXIST;
    }
    return errno == ENOENT ? 0 : errno;
}

/// Renames over nothing. Returns 0 or errno.
int rename_over_nothing(int from_directory, const std::string& from, int to_directory, const std::string& to) {
    if (::renameat2(from_directory, from.c_str(), to_directory, to.c_str(), RENAME_NOREPLACE) == 0) {
        return 0;
    }
    if (errno != EINVAL && errno != ENOSYS) {
        return errno;
    }
    // Some network file systems cannot. Nobody but the holder of the lock writes where this goes to.
    if (const int error = check_absent(to_directory, to); error != 0) {
        return error;
    }
    return ::renameat(from_directory, from.c_str(), to_directory, to.c_str()) == 0 ? 0 : errno;
}

Result<std::optional<FileLook>> look_in(int directory, const std::string& name) {
    struct stat status {};
    if (::fstatat(directory, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) {
        if (errno == ENOENT) {
            return std::optional<FileLook>{};
        }
        return Failure{FailureKind::storage, words(errno)};
    }
    FileLook look;
    look.kind = S_ISREG(status.st_mode)   ? FileKind::regular
                : S_ISDIR(status.st_mode) ? FileKind::directory
                : S_ISLNK(status.st_mode) ? FileKind::symbolic_link
                                          : FileKind::other;
    look.device = status.st_dev;
    look.inode = status.st_ino;
    look.size_bytes = static_cast<std::uint64_t>(status.st_size);
    look.modified_ns = modified_ns(status);
    look.changed_ns = std::int64_t{status.st_ctim.tv_sec} * 1'000'000'000 + status.st_ctim.tv_nsec;
    look.names = status.st_nlink;
    return std::optional{look};
}

/// Whether neither a file nor a report would be in the way, and the name is not that of another file's report. Returns
/// 0, EEXIST or another error.
int check_free(int directory, const std::string& name) {
    int error = check_absent(directory, name);
    error = error == 0 ? check_absent(directory, name + std::string{report_ending}) : error;
    if (error == 0 && name.size() > report_ending.size() && name.ends_with(report_ending)) {
        error = check_absent(directory, name.substr(0, name.size() - report_ending.size()));
    }
    return error;
}

/// The names in a directory but "." and "..", in order.
Result<std::vector<std::string>> list(int directory) {
    const int again = ::openat(directory, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (again < 0) {
        return Failure{FailureKind::storage, words(errno)};
    }
    const auto close = [](DIR* stream) { ::closedir(stream); };
    const std::unique_ptr<DIR, decltype(close)> stream{::fdopendir(again), close};
    if (stream == nullptr) {
        ::close(again);
        return Failure{FailureKind::storage, words(ENOMEM)};
    }
    std::vector<std::string> names;
    while (true) {
        errno = 0;
        const dirent* const entry = ::readdir(stream.get()); // NOLINT(concurrency-mt-unsafe): a stream of its own
        if (entry == nullptr) {
            break;
        }
        const std::string_view name{entry->d_name};
        if (name != "." && name != "..") {
            names.emplace_back(name);
        }
    }
    if (errno != 0) {
        return Failure{FailureKind::storage, words(errno)};
    }
    std::ranges::sort(names);
    return names;
}

/// Returns 0 or errno.
int write_whole(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno != EINTR) {
            return errno;
        }
        text.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
    }
    return 0;
}

} // namespace

Descriptor::~Descriptor() {
    if (number_ >= 0) {
        ::close(number_);
    }
}

std::string_view to_string(DropEnd end) {
    switch (end) {
    case DropEnd::done:
        return "done";
    case DropEnd::failed:
        return "failed";
    }
    assertion_failed("DropEnd", __FILE__, __LINE__);
}

Failure DropDirectory::failure(FailureKind kind, const std::string& name, int error) const {
    return {kind, (path_ / name).string() + ": " + words(error)};
}

Result<DropDirectory> DropDirectory::open(const std::filesystem::path& folder) {
    DropDirectory directory;
    directory.path_ = folder;
    const std::unique_ptr<char, decltype(&std::free)> real{::realpath(folder.c_str(), nullptr), &std::free};
    if (real == nullptr) {
        return directory.failure(FailureKind::usage, "", errno);
    }
    directory.path_ = real.get();
    directory.folder_ = Descriptor{::open(real.get(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW)};
    if (directory.folder_.get() < 0) {
        return directory.failure(FailureKind::usage, "", errno);
    }
    if (auto opened = directory.open_inner(); !opened) {
        return opened.error();
    }
    if (auto locked = directory.lock(); !locked) {
        return locked.error();
    }
    return directory;
}

Result<void> DropDirectory::open_inner() {
    struct stat outer {};
    if (::fstat(folder_.get(), &outer) != 0) {
        return failure(FailureKind::storage, "", errno);
    }
    const std::array<std::pair<const char*, Descriptor*>, 3> wanted{
        {{processing_name, &processing_}, {"done", &done_}, {"failed", &failed_}}};
    for (const auto& [name, place] : wanted) {
        if (::mkdirat(folder_.get(), name, 0755) != 0 && errno != EEXIST) {
            return failure(FailureKind::storage, name, errno);
        }
        *place = Descriptor{::openat(folder_.get(), name, O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW)};
        struct stat inner {};
        if (place->get() < 0 || ::fstat(place->get(), &inner) != 0) {
            return failure(FailureKind::usage, name, errno);
        }
        if (inner.st_dev != outer.st_dev) {
            return failure(FailureKind::usage, name, EXDEV);
        }
    }
    return {};
}

Result<void> DropDirectory::lock() {
    lock_ = Descriptor{::openat(processing_.get(), lock_name, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644)};
    if (lock_.get() < 0 || ::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) {
        return errno == EWOULDBLOCK
                   ? Failure{FailureKind::storage, "the folder " + path_.string() + " is in use by another linefeed"}
                   : failure(FailureKind::storage, std::string{processing_name} + '/' + lock_name, errno);
    }
    return {};
}

/// Otherwise nobody would notice that what is dropped now comes to lie somewhere else, or that nothing can be claimed.
Result<void> DropDirectory::check_in_place() const {
    const std::array<std::pair<std::filesystem::path, const Descriptor*>, 4> places{
        {{path_, &folder_},
         {path_ / processing_name, &processing_},
         {path_ / "done", &done_},
         {path_ / "failed", &failed_}}};
    for (const auto& [path, place] : places) {
        struct stat there {};
        struct stat open {};
        if (::lstat(path.c_str(), &there) != 0) {
            return Failure{FailureKind::storage,
                           path.string() + ": the folder " +
                               (errno == ENOENT ? "was removed" : "is not reached any more: " + words(errno))};
        }
        if (::fstat(place->get(), &open) != 0 || there.st_dev != open.st_dev || there.st_ino != open.st_ino) {
            return Failure{FailureKind::storage, path.string() + ": the folder was replaced by another one"};
        }
    }
    return {};
}

Result<std::vector<std::string>> DropDirectory::names() const {
    if (auto in_place = check_in_place(); !in_place) {
        return in_place.error();
    }
    auto names = list(folder_.get());
    if (!names) {
        return Failure{names.error().kind, path_.string() + ": " + names.error().message};
    }
    std::erase_if(*names, [](const std::string& name) {
        return name == processing_name || name == to_string(DropEnd::done) || name == to_string(DropEnd::failed);
    });
    return names;
}

Result<std::optional<FileLook>> DropDirectory::look(const std::string& name) const {
    return look_in(folder_.get(), name);
}

Result<std::optional<std::string>> DropDirectory::claim(const std::string& name) {
    for (unsigned attempt = 1; attempt < most_attempts; ++attempt) {
        const std::string kept = kept_name(name, attempt);
        int error = kept == lock_name || kept == draft_name ? EEXIST : 0;
        for (const Descriptor* const directory : {&processing_, &done_, &failed_}) {
            error = error == 0 ? check_free(directory->get(), kept) : error;
        }
        error = error == 0 ? rename_over_nothing(folder_.get(), name, processing_.get(), kept) : error;
        switch (error) {
        case 0:
            return std::optional{kept};
        case EEXIST:
            continue;
        case ENOENT:
            return std::optional<std::string>{};
        default:
            return Failure{FailureKind::storage, "it cannot be moved to processing/: " + words(error)};
        }
    }
    return Failure{FailureKind::storage, "it cannot be moved to processing/: too many files have had this name"};
}

void DropDirectory::remove_mark(const std::string& name, const FileLook& seen) {
    const auto look = look_in(folder_.get(), name);
    if (look && *look == seen && seen.kind == FileKind::regular) {
        ::unlinkat(folder_.get(), name.c_str(), 0); // one that stays is older than the next file of this name
    }
}

Result<void> DropDirectory::sync_claims() {
    // EINVAL: a network file system, where the server sees to it.
    if (::fsync(processing_.get()) != 0 && errno != EINVAL) {
        return failure(FailureKind::storage, processing_name, errno);
    }
    return {};
}

Result<std::vector<std::string>> DropDirectory::claimed() const {
    auto names = list(processing_.get());
    if (!names) {
        return Failure{names.error().kind, (path_ / processing_name).string() + ": " + names.error().message};
    }
    std::erase_if(*names, [](const std::string& name) { return name == lock_name || is_sqlite_companion(name); });
    return names;
}

Result<std::optional<FileLook>> DropDirectory::look_claimed(const std::string& name) const {
    return look_in(processing_.get(), name);
}

Result<FileInput> DropDirectory::open_claimed(const std::string& name) const {
    return FileInput::open_in(processing_.get(), name, path_ / processing_name / name);
}

Result<std::string> DropDirectory::free_name(DropEnd end, const std::string& name) const {
    struct stat status {};
    // A report of this name alone is what is left of an attempt before a crash.
    if (::fstatat(directory_of(end).get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0 && errno == ENOENT) {
        return name;
    }
    for (unsigned attempt = 2; attempt < most_attempts; ++attempt) {
        std::string other = kept_name(name, attempt);
        if (check_free(done_.get(), other) == 0 && check_free(failed_.get(), other) == 0) {
            return other;
        }
    }
    return failure(FailureKind::storage, std::string{to_string(end)}, EEXIST);
}

Result<void> DropDirectory::write_report(DropEnd end, const std::string& name, const std::string& text) {
    const std::string report = name + std::string{report_ending};
    const DropEnd other = end == DropEnd::done ? DropEnd::failed : DropEnd::done;
    ::unlinkat(directory_of(other).get(), report.c_str(), 0); // the name was free in both folders when it was claimed
    const int directory = directory_of(end).get();
    const Descriptor draft{
        ::openat(directory, draft_name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644)};
    int error = draft.get() < 0 ? errno : write_whole(draft.get(), text);
    if (error == 0 && ::renameat(directory, draft_name, directory, report.c_str()) != 0) {
        error = errno;
    }
    return error == 0 ? Result<void>{}
                      : failure(FailureKind::storage, std::string{to_string(end)} + '/' + report, error);
}

Result<bool> DropDirectory::finish(DropEnd end, const std::string& name, const std::string& new_name) {
    for (const char* const companion : {"-wal", "-shm"}) { // of a database that was read here
        ::unlinkat(processing_.get(), (name + companion).c_str(), 0);
    }
    const int error = rename_over_nothing(processing_.get(), name, directory_of(end).get(), new_name);
    if (error == 0 || error == ENOENT) {
        return error == 0;
    }
    return failure(FailureKind::storage, std::string{to_string(end)} + '/' + new_name, error);
}

} // namespace linefeed::intake
