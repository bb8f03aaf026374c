// A CSV file as source of records: columns chosen by name or number, rows of the wrong shape told apart.
#pragma once

#include "intake/csv_reader.hpp"
#include "intake/file_input.hpp"
#include "intake/row_source.hpp"

namespace linefeed::intake {

class CsvSource final : public RowSource {
public:
    /// Reads header and first row. See open_source() for the failures.
    [[nodiscard]] static Result<std::unique_ptr<RowSource>> open(FileInput file, const SourceOptions& options);

    [[nodiscard]] Result<bool> next(Row& row) override;
    [[nodiscard]] const std::vector<std::string>& column_names() const override { return names_; }
    [[nodiscard]] std::uint64_t most_rows() const override;
    [[nodiscard]] double progress() const override;

private:
    explicit CsvSource(FileInput file);
    [[nodiscard]] Result<void> start(const SourceOptions& options);
    /// Reads into `current_`; empty lines before it are counted, and dropped at the end of the file.
    [[nodiscard]] Result<bool> advance();
    [[nodiscard]] Result<void> choose_columns(const SourceOptions& options, const std::vector<std::string>& header);
    void fill(Row& row) const;
    [[nodiscard]] Failure failure(FailureKind kind, const std::string& why) const;

    FileInput file_;
    CsvReader reader_;
    CsvRow current_;
    bool has_current_ = false;
    bool current_is_used_ = false;  ///< next() has handed it out
    std::uint64_t empty_lines_ = 0; ///< before `current_`, still to be reported
    std::size_t width_ = 0;         ///< fields of a good row
    std::vector<std::size_t> chosen_;
    std::vector<std::string> names_;
};

} // namespace linefeed::intake
