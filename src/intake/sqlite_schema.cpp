#include "intake/sqlite_schema.hpp"

#include "intake/columns.hpp"
#include "spool/database.hpp"

#include <algorithm>

namespace linefeed::intake {

namespace {

struct Table {
    std::string name;
    bool is_plain = false; ///< neither a view nor virtual
    bool has_rowid = false;
};

struct Column {
    std::string name;
    int key_position = 0; ///< in the primary key, from 1; 0 = not in it
};

std::string quoted(const std::string& name) {
    std::string text{'"'};
    for (const char character : name) {
        text.append(character == '"' ? 2 : 1, character);
    }
    return text + '"';
}

std::string text_of(sqlite3_stmt* statement, int column) {
    const unsigned char* text = sqlite3_column_text(statement, column);
    const int size = sqlite3_column_bytes(statement, column);
    return text == nullptr ? std::string{}
                           : std::string{reinterpret_cast<const char*>(text), static_cast<std::size_t>(size)};
}

/// Calls `take` for each row.
template <typename Take>
Result<void> for_each_row(sqlite3* connection, sqlite3_stmt* statement, const std::string& file, Take take) {
    while (true) {
        const int code = sqlite3_step(statement);
        if (code == SQLITE_DONE) {
            return {};
        }
        if (code != SQLITE_ROW) {
            return sqlite_failure(connection, code, file);
        }
        take();
    }
}

Result<std::vector<Table>> list_tables(sqlite3* connection, const std::string& file) {
    auto statement =
        prepare_sqlite(connection,
                       "SELECT name, type, wr FROM pragma_table_list WHERE schema = 'main' AND type IN ('table', "
                       "'view', 'virtual') AND name NOT LIKE 'sqlite\\_%' ESCAPE '\\' ORDER BY name",
                       file);
    if (!statement) {
        return statement.error();
    }
    std::vector<Table> tables;
    const auto done = for_each_row(connection, statement->get(), file, [&] {
        const bool is_plain = text_of(statement->get(), 1) == "table";
        const bool has_rowid = is_plain && sqlite3_column_int(statement->get(), 2) == 0;
        tables.push_back({text_of(statement->get(), 0), is_plain, has_rowid});
    });
    if (!done) {
        return done.error();
    }
    return tables;
}

Result<std::vector<Column>> list_columns(sqlite3* connection, const std::string& file, const std::string& table) {
    // Hidden columns of virtual tables (1) are left out as in SELECT *; generated columns (2, 3) are not.
    auto statement =
        prepare_sqlite(connection, "SELECT name, pk FROM pragma_table_xinfo(?1) WHERE hidden <> 1 ORDER BY cid", file);
    if (!statement) {
        return statement.error();
    }
    sqlite3_bind_text(statement->get(), 1, table.data(), static_cast<int>(table.size()), SQLITE_STATIC);
    std::vector<Column> columns;
    const auto done = for_each_row(connection, statement->get(), file, [&] {
        columns.push_back({text_of(statement->get(), 0), sqlite3_column_int(statement->get(), 1)});
    });
    if (!done) {
        return done.error();
    }
    return columns;
}

Result<Table> choose_table(const std::vector<Table>& tables, const std::string& file,
                           const std::optional<std::string>& wanted) {
    std::vector<std::string> names;
    for (const Table& table : tables) {
        names.push_back(table.name);
        if (wanted && same_sqlite_name(*wanted, table.name)) {
            return table;
        }
    }
    if (tables.empty()) {
        return Failure{FailureKind::input, file + ": the database has no tables"};
    }
    if (wanted) {
        return Failure{FailureKind::usage,
                       file + ": there is no table \"" + *wanted + "\", there are " + quoted_list(names)};
    }
    if (tables.size() > 1) {
        return Failure{FailureKind::usage, file + ": choose one of its tables with --table: " + quoted_list(names)};
    }
    return tables.front();
}

/// A name of the row number that no column hides; empty if there is none.
std::string rowid_name(const std::vector<Column>& columns) {
    for (const char* candidate : {"rowid", "_rowid_", "oid"}) {
        const bool hidden = std::any_of(columns.begin(), columns.end(),
                                        [&](const Column& column) { return same_sqlite_name(column.name, candidate); });
        if (!hidden) {
            return candidate;
        }
    }
    return {};
}

/// " ORDER BY …" for the order in which the rows were entered, or of the primary key; views keep their own.
std::string natural_order(const Table& table, std::vector<Column> columns) {
    if (!table.is_plain) {
        return {};
    }
    if (table.has_rowid) {
        const std::string rowid = rowid_name(columns);
        return rowid.empty() ? "" : " ORDER BY " + rowid;
    }
    std::erase_if(columns, [](const Column& column) { return column.key_position == 0; });
    std::sort(columns.begin(), columns.end(),
              [](const Column& a, const Column& b) { return a.key_position < b.key_position; });
    std::string order;
    for (const Column& column : columns) {
        order += (order.empty() ? " ORDER BY " : ", ") + quoted(column.name);
    }
    return order;
}

/// From the span of the row numbers: exact if no row was ever deleted.
Result<double> estimate_rows(sqlite3* connection, const std::string& file, const Table& table,
                             const std::vector<Column>& columns) {
    const std::string rowid = table.has_rowid ? rowid_name(columns) : std::string{};
    if (rowid.empty()) {
        return 0.0;
    }
    const std::string from = "(" + rowid + ") FROM " + quoted(table.name) + ")";
    auto statement = prepare_sqlite(connection, "SELECT (SELECT max" + from + " - (SELECT min" + from + " + 1", file);
    if (!statement) {
        return statement.error();
    }
    double rows = 0;
    const auto done =
        for_each_row(connection, statement->get(), file, [&] { rows = sqlite3_column_double(statement->get(), 0); });
    if (!done) {
        return done.error();
    }
    return rows;
}

} // namespace

Failure sqlite_failure(sqlite3* connection, int code, const std::string& file) {
    std::string message = file + ": " + spool::describe_sqlite_error(code);
    switch (code & 0xFF) {
    case SQLITE_ERROR:
        message = file + ": " + sqlite3_errmsg(connection);
        break;
    case SQLITE_CANTOPEN:
        message += "; in WAL mode its directory must be writable";
        break;
    default:
        break;
    }
    return {FailureKind::input, std::move(message)};
}

Result<SqliteStatement> prepare_sqlite(sqlite3* connection, const std::string& sql, const std::string& file) {
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v2(connection, sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
    if (code != SQLITE_OK) {
        return sqlite_failure(connection, code, file);
    }
    return SqliteStatement{statement};
}

bool same_sqlite_name(std::string_view a, std::string_view b) {
    return a.size() == b.size() && sqlite3_strnicmp(a.data(), b.data(), static_cast<int>(a.size())) == 0;
}

Result<TableReading> read_table(sqlite3* connection, const std::string& file, const std::optional<std::string>& table,
                                const std::vector<std::string>& columns) {
    const auto tables = list_tables(connection, file);
    if (!tables) {
        return tables.error();
    }
    const auto source = choose_table(*tables, file, table);
    if (!source) {
        return source.error();
    }
    const auto existing = list_columns(connection, file, source->name);
    if (!existing) {
        return existing.error();
    }
    std::vector<std::string> names;
    for (const Column& column : *existing) {
        names.push_back(column.name);
    }
    const auto chosen = choose(columns, names, names.size(), same_sqlite_name);
    if (!chosen) {
        return Failure{chosen.error().kind, file + ", table \"" + source->name + "\": " + chosen.error().message};
    }
    TableReading reading;
    reading.select = "SELECT ";
    for (const std::size_t index : *chosen) {
        reading.select += (reading.column_names.empty() ? "" : ", ") + quoted(names[index]);
        reading.column_names.push_back(names[index]);
    }
    reading.select += " FROM main." + quoted(source->name) + natural_order(*source, *existing);
    const auto rows = estimate_rows(connection, file, *source, *existing);
    if (!rows) {
        return rows.error();
    }
    reading.expected_rows = *rows;
    return reading;
}

} // namespace linefeed::intake
