#include "intake/sqlite_source.hpp"

#include "intake/columns.hpp"

#include <algorithm>
#include <cmath>

namespace linefeed::intake {

namespace {

/// How long a writer in another program is waited for.
constexpr int busy_timeout_ms = 2000;
/// Above this, a REAL may stand for several integers of the same text.
constexpr double exact_real_max = 1e15;

/// For the user's query: reading is allowed, nothing else. Sets the bool behind `denied` when it has refused something.
int allow_reading(void* denied, int action, const char*, const char*, const char*, const char*) {
    const bool reads =
        action == SQLITE_SELECT || action == SQLITE_READ || action == SQLITE_FUNCTION || action == SQLITE_RECURSIVE;
    if (!reads) {
        *static_cast<bool*>(denied) = true;
    }
    return reads ? SQLITE_OK : SQLITE_DENY;
}

Failure bad_query(const std::string& file, const std::string& why) {
    return {FailureKind::usage, file + ": the query is refused: " + why};
}

/// Whether there is nothing but blanks, comments and semicolons.
bool is_blank_sql(sqlite3* connection, const char* sql) {
    while (*sql != '\0') {
        sqlite3_stmt* statement = nullptr;
        const char* rest = nullptr;
        const int code = sqlite3_prepare_v2(connection, sql, -1, &statement, &rest);
        const SqliteStatement owner{statement};
        if (code != SQLITE_OK || statement != nullptr) {
            return false;
        }
        sql = rest;
    }
    return true;
}

} // namespace

Result<std::unique_ptr<RowSource>> SqliteSource::open(const std::filesystem::path& file, const SourceOptions& options) {
    const std::string name = file.string();
    if (options.delimiter || !options.header) {
        return Failure{FailureKind::usage,
                       name + ": the options for delimiter and header are for CSV files, this is an SQLite database"};
    }
    if (options.table && options.query) {
        return Failure{FailureKind::usage, "a table and a query cannot be read at once: choose one of them"};
    }
    std::unique_ptr<SqliteSource> source{new SqliteSource{name}};
    if (auto connected = source->connect(options.follow_links); !connected) {
        return connected.error();
    }
    const auto started =
        options.query ? source->start_query(*options.query, options.columns) : source->start_table(options);
    if (!started) {
        return started.error();
    }
    return std::unique_ptr<RowSource>{std::move(source)};
}

Result<void> SqliteSource::connect(bool follow_links) {
    sqlite3* connection = nullptr;
    const std::string path = file_.starts_with('/') ? file_ : "./" + file_; // never a URI or ":memory:"
    const int flags =
        SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE | (follow_links ? 0 : SQLITE_OPEN_NOFOLLOW);
    const int code = sqlite3_open_v2(path.c_str(), &connection, flags, nullptr);
    connection_.reset(connection);
    if (code != SQLITE_OK) {
        return sqlite_failure(connection, code, file_);
    }
    sqlite3_busy_timeout(connection, busy_timeout_ms);
    // Otherwise a misspelt column in double quotes would be printed as text on every product.
    sqlite3_db_config(connection, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
    sqlite3_db_config(connection, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    // One transaction for schema and rows: both from the same moment, however long the reading takes.
    if (const int begun = sqlite3_exec(connection, "BEGIN", nullptr, nullptr, nullptr); begun != SQLITE_OK) {
        return sqlite_failure(connection, begun, file_);
    }
    return {};
}

Result<void> SqliteSource::start_table(const SourceOptions& options) {
    auto reading = read_table(connection_.get(), file_, options.table, options.columns);
    if (!reading) {
        return reading.error();
    }
    auto statement = prepare_sqlite(connection_.get(), reading->select, file_);
    if (!statement) {
        return statement.error();
    }
    statement_ = std::move(*statement);
    names_ = std::move(reading->column_names);
    expected_rows_ = reading->expected_rows;
    for (std::size_t i = 0; i < names_.size(); ++i) {
        chosen_.push_back(i);
        first_use_.push_back(i);
    }
    return {};
}

Result<void> SqliteSource::start_query(const std::string& query, const std::vector<std::string>& columns) {
    sqlite3* const connection = connection_.get();
    sqlite3_set_authorizer(connection, allow_reading, &query_denied_);
    sqlite3_stmt* statement = nullptr;
    const char* rest = nullptr;
    const int code = sqlite3_prepare_v2(connection, query.c_str(), -1, &statement, &rest);
    statement_.reset(statement);
    if (query_denied_) {
        return bad_query(file_, "it must be a single SELECT");
    }
    if ((code & 0xFF) == SQLITE_ERROR) {
        return bad_query(file_, sqlite3_errmsg(connection));
    }
    if (code != SQLITE_OK) {
        return sqlite_failure(connection, code, file_);
    }
    if (statement == nullptr) {
        return bad_query(file_, "it is empty");
    }
    const bool reads = sqlite3_stmt_readonly(statement) != 0 && sqlite3_stmt_isexplain(statement) == 0 &&
                       sqlite3_column_count(statement) > 0;
    if (!reads || !is_blank_sql(connection, rest)) {
        return bad_query(file_, "it must be a single SELECT");
    }
    if (sqlite3_bind_parameter_count(statement) > 0) {
        return bad_query(file_, "it has parameters without a value");
    }
    std::vector<std::string> all_names;
    all_names.reserve(static_cast<std::size_t>(sqlite3_column_count(statement)));
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
        all_names.emplace_back(sqlite3_column_name(statement, i));
    }
    auto chosen = choose(columns, all_names, all_names.size(), same_sqlite_name);
    if (!chosen) {
        return Failure{chosen.error().kind, file_ + ", result of the query: " + chosen.error().message};
    }
    chosen_ = std::move(*chosen);
    for (const std::size_t index : chosen_) {
        const auto first = std::find(chosen_.begin(), chosen_.end(), index);
        first_use_.push_back(static_cast<std::size_t>(first - chosen_.begin()));
        names_.push_back(all_names[index]);
    }
    return {};
}

Result<std::string_view> SqliteSource::value(std::size_t index, Row& row) {
    const int column = static_cast<int>(index);
    sqlite3_stmt* const statement = statement_.get();
    const int type = sqlite3_column_type(statement, column);
    if (type == SQLITE_NULL) {
        row.problem = "the value is NULL (use COALESCE in --query to print something)";
        return std::string_view{};
    }
    if (type == SQLITE_BLOB) {
        row.problem = "the value is a BLOB, not text (use CAST … AS TEXT or hex() in --query)";
        return std::string_view{};
    }
    const double real = type == SQLITE_FLOAT ? sqlite3_column_double(statement, column) : 0.0;
    const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
    if (data == nullptr) {
        return sqlite_failure(connection_.get(), SQLITE_NOMEM, file_);
    }
    const std::string_view text{data, static_cast<std::size_t>(sqlite3_column_bytes(statement, column))};
    if (type == SQLITE_FLOAT &&
        (std::abs(real) >= exact_real_max || text.find_first_of("eE") != std::string_view::npos)) {
        row.problem = "the number " + std::string{text} + " is a REAL and may have lost digits: store it as TEXT";
        return std::string_view{};
    }
    return text;
}

Result<bool> SqliteSource::next(Row& row) {
    if (ended_) {
        return false;
    }
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_DONE) {
        ended_ = true;
        return false;
    }
    if (code != SQLITE_ROW) {
        ended_ = true;
        return sqlite_failure(connection_.get(), code, file_);
    }
    row.line = ++rows_;
    row.fields.clear();
    row.problem.clear();
    row.problem_column.clear();
    bool all_empty = true;
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
        const bool again = first_use_[i] != i;
        const auto text = again ? Result<std::string_view>{row.fields[first_use_[i]]} : value(chosen_[i], row);
        if (!text) {
            ended_ = true;
            return text.error();
        }
        if (!row.problem.empty()) {
            row.problem_column = names_[i];
            row.fields.clear();
            return true;
        }
        row.fields.push_back(*text);
        all_empty = all_empty && text->empty();
    }
    if (all_empty) {
        row.fields.clear();
        row.problem = "the record is empty";
    }
    return true;
}

double SqliteSource::progress() const {
    if (ended_) {
        return 1.0;
    }
    return expected_rows_ > 0 ? std::min(1.0, static_cast<double>(rows_) / expected_rows_) : 0.0;
}

} // namespace linefeed::intake
