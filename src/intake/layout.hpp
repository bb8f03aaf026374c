// The field layout: everything that decides which records a file gives. One description for the command line, the drop
// folders and the settings of the service, with one canonical form, so that the spool can tell whether a file was read
// in the same way before.
#pragma once

#include "base/failure.hpp"
#include "intake/file_input.hpp"
#include "intake/import.hpp"
#include "intake/row_source.hpp"
#include "protocol/mail_record.hpp"
#include "protocol/profile.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::intake {

struct Layout {
    // The source, see SourceOptions
    std::vector<std::string> columns;
    std::optional<std::string> table;
    std::optional<std::string> query;
    std::optional<char> delimiter;
    bool header = true;
    bool skip_bad = false;

    // The record
    std::vector<std::string> encodings; ///< "latin1" for all columns, or "COLUMN=unicode-hex" for one
    std::vector<std::string> graphics;  ///< columns that are graphics, see GraphicFields
    /// Where their images are; absent = beside the source, empty = nowhere.
    std::optional<std::filesystem::path> graphics_folder;
    protocol::Profile profile = protocol::profiles.front();
    std::uint32_t base = 0; ///< record k has number base + k
    protocol::RecordProperties properties;
};

/// Every option that changes the records but the base, in a fixed form (spool::JobSpec::layout).
[[nodiscard]] std::string canonical_json(const Layout& layout);
/// Whether two canonical forms differ at most in the profile: records that come out the same mean the same then.
[[nodiscard]] bool is_same_way(std::string_view one, std::string_view other);
/// What records a source gives depends on images besides its own bytes, by the canonical form of its layout.
[[nodiscard]] bool reads_images(std::string_view canonical);

/// A source that is open, and how its records are made.
struct OpenedSource {
    std::unique_ptr<RowSource> rows;
    ImportOptions options;
};

/// Opens a source in the way that `layout` says. Fails as open_source(), and with FailureKind::usage if an encoding is
/// not known, or it or a graphic names a column that is not printed.
[[nodiscard]] Result<OpenedSource> open_with_layout(const std::filesystem::path& file, const Layout& layout);
/// The same for a file that is open already. An SQLite database is opened once more by its path, which must hold no
/// symbolic link then.
[[nodiscard]] Result<OpenedSource> open_with_layout(FileInput file, const Layout& layout);

} // namespace linefeed::intake
