// A streaming CSV reader (RFC 4180) that knows line and byte offset of every row, needs bounded memory whatever the
// file holds, and gives the same rows however the bytes arrive. Values are text: nothing is trimmed or converted.
#pragma once

#include "base/failure.hpp"
#include "intake/csv_scanner.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::intake {

/// A row that is longer is bad; it is skipped without being stored.
inline constexpr std::size_t max_row_bytes = std::size_t{1024} * 1024;

/// How much the reader takes at once. Tests use smaller limits, so that small texts reach them.
struct CsvLimits {
    std::size_t row_bytes = max_row_bytes;
    std::size_t block_bytes = std::size_t{256} * 1024; ///< per call of the function that reads
};

/// One row. The views are valid until the next row is read.
struct CsvRow {
    std::uint64_t line = 0;   ///< where it begins, from 1; CR LF, LF and CR each end a line
    std::uint64_t offset = 0; ///< where it begins, bytes from the start of the file
    bool empty_line = false;  ///< nothing between two line breaks; `fields` is one empty field
    CsvProblem problem = CsvProblem::none;
    std::uint64_t problem_line = 0;       ///< where the quote that is not closed was opened
    std::vector<std::string_view> fields; ///< empty if there is a problem
};

/// The problem in words.
[[nodiscard]] std::string describe(const CsvRow& row);

/// Flow: open(), then guess_delimiter() or set_delimiter(), then next() until it returns false. A UTF-8 byte order mark
/// is skipped.
class CsvReader {
public:
    /// Fills a part of the span, returns how much; 0 = end of file.
    using ReadBytes = std::function<Result<std::size_t>(std::span<char>)>;

    explicit CsvReader(ReadBytes read_bytes, CsvLimits limits = {});

    /// Reads the beginning. Fails with FailureKind::input if it is UTF-16.
    [[nodiscard]] Result<void> open();
    void set_delimiter(CsvDelimiter delimiter);
    /// Looks at the first row for it, as far as a row may reach.
    [[nodiscard]] Result<CsvDelimiter> guess_delimiter();
    /// False at the end of the file. Fails only if reading fails.
    [[nodiscard]] Result<bool> next(CsvRow& row);

    /// Bytes behind the last row read.
    [[nodiscard]] std::uint64_t offset() const { return offset_ + begin_; }
    /// Bytes of memory for the window of the file; never more than a row and three blocks.
    [[nodiscard]] std::size_t window_bytes() const { return window_.size(); }

private:
    /// The next occurrence of one byte, remembered: each byte of the file is looked at once per searched byte, not once
    /// a row.
    class Finder {
    public:
        explicit Finder(char byte)
            : byte_(byte) {}
        [[nodiscard]] std::size_t find(const char* data, std::size_t from, std::size_t end);
        void shift(std::size_t bytes);

    private:
        char byte_;
        std::size_t known_ = 0; ///< none between what was asked for last and here
        bool found_ = false;    ///< and here it is
    };

    [[nodiscard]] Result<void> read_more();
    void discard_front(std::size_t bytes);
    [[nodiscard]] Result<bool> next_quoted(CsvRow& row);
    void finish_row(std::size_t end);

    ReadBytes read_bytes_;
    CsvLimits limits_;
    std::vector<char> window_;
    std::size_t begin_ = 0;    ///< of the row that comes next
    std::size_t end_ = 0;      ///< of the bytes that were read
    std::uint64_t offset_ = 0; ///< of the window in the file
    std::uint64_t line_ = 1;
    bool end_of_file_ = false;
    CsvScanner scanner_{std::nullopt};
    CsvDelimiter delimiter_;
    Finder line_feed_{'\n'};
    Finder carriage_return_{'\r'};
    Finder quote_{'"'};
};

} // namespace linefeed::intake
