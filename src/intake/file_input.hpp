// A source file opened for reading, after everything that is not a readable regular file was refused in words.
#pragma once

#include "base/failure.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <sys/stat.h>
#include <utility>

namespace linefeed::intake {

/// When a file was changed last, ns since the Unix epoch.
[[nodiscard]] inline std::int64_t modified_ns(const struct stat& status) {
    return std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
}

/// An open regular file; reads from front to back.
class FileInput {
public:
    /// Fails with FailureKind::input: missing, a directory, a pipe or device, no permission, empty; with
    /// FailureKind::internal, as the functions below, if it is this machine or the network that is in trouble.
    [[nodiscard]] static Result<FileInput> open(const std::filesystem::path& file);
    FileInput(FileInput&& other) noexcept
        : file_(std::move(other.file_))
        , descriptor_(std::exchange(other.descriptor_, -1))
        , size_(other.size_) {}
    FileInput& operator=(FileInput&&) = delete;
    FileInput(const FileInput&) = delete;
    FileInput& operator=(const FileInput&) = delete;
    ~FileInput();

    /// The file `name` in an open directory, never through a symbolic link; `shown` is its path for messages.
    [[nodiscard]] static Result<FileInput> open_in(int directory, const std::string& name,
                                                   const std::filesystem::path& shown);
    /// Reads on; returns how much, 0 at the end of the file. The failure's message does not name the file.
    [[nodiscard]] Result<std::size_t> read(std::span<char> out);
    /// Back to the front. The failure's message does not name the file.
    [[nodiscard]] Result<void> rewind();
    /// What the file is like now. The failure's message does not name the file.
    [[nodiscard]] Result<struct stat> status() const;
    /// Whether the file begins like an SQLite database. Does not move the place of read().
    [[nodiscard]] bool is_sqlite() const;
    /// When it was opened.
    [[nodiscard]] std::uint64_t size() const { return size_; }
    [[nodiscard]] const std::filesystem::path& path() const { return file_; }

private:
    [[nodiscard]] static Result<FileInput> checked(FileInput input);
    FileInput(std::filesystem::path file, int descriptor)
        : file_(std::move(file))
        , descriptor_(descriptor) {}

    std::filesystem::path file_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

} // namespace linefeed::intake
