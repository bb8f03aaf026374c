// What a backup of a printer's files holds: `manifest.json` beside the files. While a backup is being made, and where
// it broke off, `manifest.partial` holds the same line by line instead.
#pragma once

#include "base/failure.hpp"
#include "protocol/machine_messages.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::printer {

/// A file of the printer, and of the backup.
struct SavedFile {
    std::string path{}; ///< in the printer, its bytes
    std::uint64_t size = 0;
    std::string sha256{};
    /// The printer lists it and does not deliver it: it is empty, or cannot be opened; both answer alike.
    [[nodiscard]] bool empty_or_unreadable() const { return size == 0; }
    friend bool operator==(const SavedFile&, const SavedFile&) = default;
};

/// Whose files they are.
struct SavedPrinter {
    std::string type{};
    std::string serial_number{};
    std::string firmware{};
    friend bool operator==(const SavedPrinter&, const SavedPrinter&) = default;
};

struct Manifest {
    SavedPrinter printer{};
    std::string made{}; ///< UTC, "2026-05-06T07:08:09Z"
    std::string loaded_job{};
    std::vector<SavedFile> files{};
    friend bool operator==(const Manifest&, const Manifest&) = default;
};

inline constexpr std::string_view manifest_name = "manifest.json";
inline constexpr std::string_view partial_name = "manifest.partial";

[[nodiscard]] std::string manifest_json(const Manifest& manifest);
/// FailureKind::input, saying what is wrong: no manifest, of a later linefeed, a path that lies in none of the
/// printer's directories or is there twice.
[[nodiscard]] Result<Manifest> parse_manifest(std::string_view text);

/// The first line of a partial manifest: everything but the files. Then one line for each file. With line ends.
[[nodiscard]] std::string partial_head(const Manifest& manifest);
[[nodiscard]] std::string partial_line(const SavedFile& file);
/// As far as it is whole: it ends where the backup broke off. FailureKind::input: not even its head is.
[[nodiscard]] Result<Manifest> parse_partial(std::string_view text);

/// Where the backup keeps a file: `files/FFSDISK/Jobs/Name.job`, everything that is not a letter, a digit or harmless
/// written as %XX, so that no name can lead out of the directory.
[[nodiscard]] std::filesystem::path saved_as(std::string_view path);

} // namespace linefeed::printer
