// Rows of text from a CSV file or an SQLite database, one at a time, in bounded memory.
#pragma once

#include "base/failure.hpp"
#include "intake/file_input.hpp"
#include "spool/job.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::intake {

/// A row, or what is wrong with it. The views are valid until the next call of next().
struct Row {
    /// 1-based: the line of a CSV file where the row begins, the row of a query.
    std::uint64_t line = 0;
    /// Of the chosen columns, in the order asked for. Empty if `problem` is set.
    std::vector<std::string_view> fields;
    /// Why the row cannot be read ("7 fields instead of 3"), with the column where that is known. Empty = good.
    std::string problem;
    std::string problem_column;
};

/// How a source is read. Options that do not fit its kind are refused.
struct SourceOptions {
    /// Column names or 1-based numbers, in the order of the record's fields; empty = all columns.
    std::vector<std::string> columns;
    /// CSV: separator; absent = `;`, `,` or TAB, whichever the first line suggests.
    std::optional<char> delimiter;
    /// CSV: the first row holds names.
    bool header = true;
    /// SQLite: the table or view to read …
    std::optional<std::string> table;
    /// … or the query. Exactly one of them; a database with a single table needs neither.
    std::optional<std::string> query;
    /// SQLite: false refuses a database whose path holds a symbolic link.
    bool follow_links = true;
};

/// Flow: open_source(), then next() until it returns false or fails.
class RowSource {
public:
    virtual ~RowSource() = default;
    /// Reads the next row into `row` (reused: no allocation per row in the steady state). False at the end. A failure
    /// means that the source as a whole cannot be read any further (unreadable, corrupt, locked).
    [[nodiscard]] virtual Result<bool> next(Row& row) = 0;
    /// Names of the chosen columns in order ("column 1" … for a CSV file without header).
    [[nodiscard]] virtual const std::vector<std::string>& column_names() const = 0;
    /// No more rows than this can be records.
    [[nodiscard]] virtual std::uint64_t most_rows() const { return std::numeric_limits<std::uint64_t>::max(); }
    /// How much of the source has been read, 0…1; for progress.
    [[nodiscard]] virtual double progress() const = 0;
};

/// Opens a file: an SQLite database if it begins like one, CSV otherwise. Failures (FailureKind::input, or usage for
/// options that do not fit): missing, a directory, empty, no such table or column, locked, corrupt.
[[nodiscard]] Result<std::unique_ptr<RowSource>> open_source(const std::filesystem::path& file,
                                                             const SourceOptions& options);

/// The same for a file that is open already.
[[nodiscard]] Result<std::unique_ptr<RowSource>> open_source(FileInput file, const SourceOptions& options);

/// The fingerprint of a file, and of its -wal if there is one.
[[nodiscard]] Result<spool::SourceFingerprint> fingerprint(const std::filesystem::path& file);

} // namespace linefeed::intake
