// An SQLite table, view or query as source of records, over a read-only connection of its own. What SQLite stores
// exactly becomes text exactly; what may have lost digits or has no text is a bad row.
#pragma once

#include "intake/row_source.hpp"
#include "intake/sqlite_schema.hpp"

namespace linefeed::intake {

class SqliteSource final : public RowSource {
public:
    /// See open_source() for the failures. All rows are read in one transaction: others may go on writing.
    [[nodiscard]] static Result<std::unique_ptr<RowSource>> open(const std::filesystem::path& file,
                                                                 const SourceOptions& options);

    [[nodiscard]] Result<bool> next(Row& row) override;
    [[nodiscard]] const std::vector<std::string>& column_names() const override { return names_; }
    [[nodiscard]] double progress() const override;

private:
    explicit SqliteSource(std::string file)
        : file_(std::move(file)) {}
    [[nodiscard]] Result<void> connect(bool follow_links);
    [[nodiscard]] Result<void> start_table(const SourceOptions& options);
    [[nodiscard]] Result<void> start_query(const std::string& query, const std::vector<std::string>& columns);
    /// The text of result column `index`; empty with row.problem set if it has none. Fails if memory runs out.
    [[nodiscard]] Result<std::string_view> value(std::size_t index, Row& row);

    std::string file_;
    bool query_denied_ = false; ///< the query wanted to do something else than read
    SqliteConnection connection_;
    SqliteStatement statement_;
    std::vector<std::size_t> chosen_; ///< columns of the result, each converted once …
    std::vector<std::size_t>
        first_use_; ///< … by the field with this index, which is the field's own unless chosen twice
    std::vector<std::string> names_;
    std::uint64_t rows_ = 0;
    double expected_rows_ = 0;
    bool ended_ = false;
};

} // namespace linefeed::intake
