// What an SQLite source has to offer: its tables and columns, and the SELECT that reads one of them in its natural
// order.
#pragma once

#include "base/failure.hpp"

#include <sqlite3.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::intake {

struct SqliteDeleter {
    void operator()(sqlite3* connection) const { sqlite3_close(connection); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using SqliteConnection = std::unique_ptr<sqlite3, SqliteDeleter>;
using SqliteStatement = std::unique_ptr<sqlite3_stmt, SqliteDeleter>;

/// FailureKind::input for what SQLite says about the file.
[[nodiscard]] Failure sqlite_failure(sqlite3* connection, int code, const std::string& file);

/// Prepares our own SQL (not the user's).
[[nodiscard]] Result<SqliteStatement> prepare_sqlite(sqlite3* connection, const std::string& sql,
                                                     const std::string& file);

/// The statement that reads a table.
struct TableReading {
    std::string select;
    std::vector<std::string> column_names; ///< of its result, as spelled in the database
    double expected_rows = 0;              ///< an estimate that costs nothing; 0 = unknown
};

/// Finds the table (or view) — the only one if none is named — and the columns. Fails with FailureKind::usage if they
/// do not exist, naming those that do.
[[nodiscard]] Result<TableReading> read_table(sqlite3* connection, const std::string& file,
                                              const std::optional<std::string>& table,
                                              const std::vector<std::string>& columns);

/// Whether two names are the same to SQLite: without regard to case.
[[nodiscard]] bool same_sqlite_name(std::string_view a, std::string_view b);

} // namespace linefeed::intake
