// Files on this side of a transfer: whole under their name, or not there.
#pragma once

#include "base/failure.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace linefeed::printer {

/// A file that gets its name only when it is whole. Flow: create(), write() …, commit(); without it nothing remains.
class NewFile {
public:
    /// What happens to a file that has the name already.
    enum class Existing { refuse, replace };

    /// In the same directory, under a hidden name. FailureKind::usage: the name is taken; ::storage otherwise.
    [[nodiscard]] static Result<NewFile> create(const std::filesystem::path& path, Existing existing);
    NewFile(NewFile&& other) noexcept;
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;
    NewFile& operator=(NewFile&&) = delete;

    /// FailureKind::storage, as the function below.
    [[nodiscard]] Result<void> write(std::string_view bytes);
    /// The file is on the disk under its name.
    [[nodiscard]] Result<void> commit();

private:
    NewFile(std::filesystem::path path, std::string temporary, int descriptor, Existing existing);

    std::filesystem::path path_;
    std::string temporary_; ///< empty: it has its name
    int descriptor_ = -1;
    Existing existing_;
};

/// FailureKind::usage: the name of a file that would be written is taken.
[[nodiscard]] Failure name_taken(const std::filesystem::path& path);

/// The bytes of a regular file. FailureKind::input: it is none, cannot be read, or has more than `max_bytes`.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path, std::uint64_t max_bytes);

/// SHA-256 as 64 lower-case hex digits.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

} // namespace linefeed::printer
