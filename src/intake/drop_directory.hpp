// A drop folder on the disk: the folder itself, where anybody may put anything, and three folders in it that only
// linefeed writes: processing/ for what is claimed, done/ and failed/ for what is over. Everything is relative to open
// directories and nothing follows a link, so that no name can lead elsewhere, whoever renames what meanwhile.
#pragma once

#include "base/failure.hpp"
#include "intake/file_input.hpp"
#include "intake/settling.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace linefeed::intake {

/// An open file or directory.
class Descriptor {
public:
    explicit Descriptor(int number = -1)
        : number_(number) {}
    Descriptor(Descriptor&& other) noexcept
        : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor();
    [[nodiscard]] int get() const { return number_; }

private:
    int number_;
};

/// Where a batch ends.
enum class DropEnd { done, failed };

/// "done", "failed": the name of the folder.
[[nodiscard]] std::string_view to_string(DropEnd end);

/// Names are names in one directory: without '/'.
class DropDirectory {
public:
    /// Makes the three folders if they are missing, and locks the drop folder. FailureKind::usage if it is missing or
    /// no directory, if one of the three is something else or lies on another file system; FailureKind::storage if
    /// another linefeed uses it, or if the folders cannot be made.
    [[nodiscard]] static Result<DropDirectory> open(const std::filesystem::path& folder);

    /// Absolute and without links, as it was when it was opened.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] int descriptor() const { return folder_.get(); }

    // What is dropped
    /// All names in the folder, the three folders left out, in order. FailureKind::storage if it or one of the three is
    /// not where it was: removed, renamed, or another file system mounted over it.
    [[nodiscard]] Result<std::vector<std::string>> names() const;
    /// What is behind a name; absent = nothing any more.
    [[nodiscard]] Result<std::optional<FileLook>> look(const std::string& name) const;
    /// Renames it into processing/, over nothing; returns the name there, which is free in all three folders. Absent =
    /// it had vanished.
    [[nodiscard]] Result<std::optional<std::string>> claim(const std::string& name);
    /// Removes a done mark, if it is a regular file and still as it was `seen`: the next file of this name may have its
    /// own already.
    void remove_mark(const std::string& name, const FileLook& seen);
    /// A power failure does not undo what was claimed until now.
    [[nodiscard]] Result<void> sync_claims();

    // What is claimed
    /// All names in processing/, in order; files that SQLite keeps beside a database are no batches.
    [[nodiscard]] Result<std::vector<std::string>> claimed() const;
    [[nodiscard]] Result<std::optional<FileLook>> look_claimed(const std::string& name) const;
    [[nodiscard]] Result<FileInput> open_claimed(const std::string& name) const;
    /// A free name for a claimed file in done/ or failed/: its own, unless somebody else has put something there.
    [[nodiscard]] Result<std::string> free_name(DropEnd end, const std::string& name) const;
    /// Writes the report that will lie beside a file `name`, whole or not at all, and removes one that was written for
    /// another end.
    [[nodiscard]] Result<void> write_report(DropEnd end, const std::string& name, const std::string& text);
    /// Renames a claimed file, over nothing. False = it had vanished.
    [[nodiscard]] Result<bool> finish(DropEnd end, const std::string& name, const std::string& new_name);

private:
    DropDirectory() = default;
    [[nodiscard]] Result<void> open_inner();
    [[nodiscard]] Result<void> lock();
    [[nodiscard]] Result<void> check_in_place() const;
    [[nodiscard]] const Descriptor& directory_of(DropEnd end) const { return end == DropEnd::done ? done_ : failed_; }
    [[nodiscard]] Failure failure(FailureKind kind, const std::string& name, int error) const;

    std::filesystem::path path_;
    Descriptor folder_;
    Descriptor processing_;
    Descriptor done_;
    Descriptor failed_;
    Descriptor lock_;
};

} // namespace linefeed::intake
