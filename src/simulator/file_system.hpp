// The printer's memory cards as its file commands show them (protocol, section 8): the default directories of the
// internal flash, the SD card and the USB stick, in memory. Paths are written as the manual writes them; capitals make
// no difference, and a `\` in front may stand or not.
#pragma once

#include "protocol/file_messages.hpp"
#include "protocol/profile.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::simulator {

/// What is stored. Each device has the directories Jobs, Fonts and Graphics.
class FileSystem {
public:
    /// With the files that the manual shows in its examples, and an empty stick.
    explicit FileSystem(const protocol::Profile& profile);

    /// What `$RD` answers: the directory or file at the path; with a joker in its last part, the entries that match.
    /// `FFSDISK\Jobs*` lists the directory Jobs, as in the manual. Empty: there is no such thing.
    [[nodiscard]] std::vector<protocol::DirectoryEntry> list(std::string_view path) const;

    /// The bytes of a file, or null.
    [[nodiscard]] const std::string* read(std::string_view path) const;
    /// False if the path lies in none of the default directories, or there is no room. A file of that name is replaced.
    bool write(std::string_view path, std::string bytes);
    /// Only from the default directories. False if there is no such file.
    bool remove(std::string_view path);

    /// Of the internal flash.
    [[nodiscard]] std::uint32_t free_kbyte() const;
    /// Someone pulls the USB stick out, with its files, or puts it in.
    void set_stick(bool present) { stick_present_ = present; }

private:
    struct File {
        std::string directory; ///< of its default directory, as in directories_
        std::string name;
        std::string bytes;
    };
    /// A path taken apart at its last `\`.
    struct Place {
        std::string_view directory;
        std::string_view name;
    };

    [[nodiscard]] static Place place_of(std::string_view path);
    /// The default directory of that name; null if there is none, or its device is not there.
    [[nodiscard]] const std::string* directory(std::string_view path) const;
    [[nodiscard]] std::vector<protocol::DirectoryEntry> entries_of(std::string_view directory,
                                                                   std::string_view mask) const;
    [[nodiscard]] std::size_t find(std::string_view path) const;
    [[nodiscard]] std::uint64_t flash_bytes() const;

    std::vector<std::string> directories_; ///< in the order of the manual
    std::vector<File> files_;              ///< in the order in which they were made
    std::uint64_t flash_capacity_ = 0;     ///< bytes
    bool stick_present_ = true;
};

/// Whether the name matches a mask with `*` (any text) and `?` (one character), whatever the case; `*.*` matches all.
[[nodiscard]] bool matches(std::string_view name, std::string_view mask);

} // namespace linefeed::simulator
