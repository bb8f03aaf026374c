#include "intake/file_input.hpp"

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace linefeed::intake {

namespace {

Failure refused(const std::filesystem::path& file, const std::string& why) {
    return {FailureKind::input, file.string() + ": " + why};
}

/// What the error says is about this machine or the way to the file, not about the file: later it may be readable.
FailureKind kind_of(int error) {
    switch (error) {
    case EMFILE:
    case ENFILE:
    case ENOMEM:
    case ESTALE:
    case ETIMEDOUT:
    case ENOTCONN:
    case EHOSTDOWN:
    case EHOSTUNREACH:
        return FailureKind::internal;
    default:
        return FailureKind::input;
    }
}

std::string words(int error) {
    switch (error) {
    case ENOENT:
        return "there is no such file";
    case EACCES:
        return "no permission to read it";
    case ELOOP:
        return "this is a symbolic link that is not followed";
    case EIO:
        return "the disk cannot read it";
    default:
        return std::generic_category().message(error);
    }
}

Failure unreadable(int error, std::string place = {}) {
    return {kind_of(error), std::move(place) + words(error)};
}

} // namespace

Result<FileInput> FileInput::open(const std::filesystem::path& file) {
    // O_NONBLOCK: opening a pipe must not wait for its other end. It means nothing for regular files.
    return checked({file, ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)});
}

Result<FileInput> FileInput::open_in(int directory, const std::string& name, const std::filesystem::path& shown) {
    return checked({shown, ::openat(directory, name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW)});
}

/// Takes the error of opening from errno.
Result<FileInput> FileInput::checked(FileInput input) {
    const std::filesystem::path& file = input.file_;
    if (input.descriptor_ < 0) {
        return unreadable(errno, file.string() + ": ");
    }
    struct stat status {};
    if (::fstat(input.descriptor_, &status) != 0) {
        return unreadable(errno, file.string() + ": ");
    }
    if (S_ISDIR(status.st_mode)) {
        return refused(file, "this is a directory, not a file");
    }
    if (!S_ISREG(status.st_mode)) {
        return refused(file, "this is a pipe or a device: a source must be a file, so that it can be recognised later");
    }
    if (status.st_size == 0) {
        return refused(file, "the file is empty");
    }
    input.size_ = static_cast<std::uint64_t>(status.st_size);
    return input;
}

FileInput::~FileInput() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

Result<std::size_t> FileInput::read(std::span<char> out) {
    while (true) {
        const ssize_t got = ::read(descriptor_, out.data(), out.size());
        if (got >= 0) {
            return static_cast<std::size_t>(got);
        }
        if (errno != EINTR) {
            return unreadable(errno);
        }
    }
}

Result<void> FileInput::rewind() {
    return ::lseek(descriptor_, 0, SEEK_SET) == 0 ? Result<void>{} : unreadable(errno);
}

Result<struct stat> FileInput::status() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) {
        return unreadable(errno);
    }
    return status;
}

bool FileInput::is_sqlite() const {
    constexpr std::string_view magic{"SQLite format 3\0", 16};
    std::array<char, magic.size()> beginning{};
    const ssize_t got = ::pread(descriptor_, beginning.data(), beginning.size(), 0);
    return got == static_cast<ssize_t>(magic.size()) && std::string_view{beginning.data(), beginning.size()} == magic;
}

} // namespace linefeed::intake
