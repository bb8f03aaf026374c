// A thin layer over the C API of SQLite: handles that close themselves, prepared statements that are kept, and errors
// as values in words. Nothing about WAL or transactions is hidden.
#pragma once

#include "base/failure.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

struct sqlite3;
struct sqlite3_stmt;

namespace linefeed::spool {

/// What an (extended) result code of SQLite means, in words with its name: "the disk is full (SQLITE_FULL)".
[[nodiscard]] std::string describe_sqlite_error(int extended_code);

/// What a connection may do.
enum class Access {
    create, ///< read, write, and make the file if it is missing
    read,   ///< read only; the file must be there
};

class Database;

/// A prepared statement in use. Flow: bind(), step() until it returns false; the destructor makes it ready for the next
/// use. Bound text and blobs must live until then; column views until the next step().
class Statement {
public:
    Statement(Statement&& other) noexcept;
    Statement& operator=(Statement&&) = delete;
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;
    ~Statement();

    /// Parameters count from 1. A failed bind is reported by step().
    Statement& bind(int parameter, std::int64_t value);
    Statement& bind(int parameter, std::string_view text);
    Statement& bind_blob(int parameter, std::string_view bytes);

    /// True if there is a row, false at the end.
    [[nodiscard]] Result<bool> step();
    /// For statements without rows: one execution, after which parameters can be bound anew.
    [[nodiscard]] Result<void> run();

    /// Columns count from 0.
    [[nodiscard]] std::int64_t number(int column) const;
    [[nodiscard]] std::string_view text(int column) const;
    [[nodiscard]] std::string_view blob(int column) const;

private:
    friend class Database;
    Statement(Database& database, sqlite3_stmt* handle)
        : database_(&database)
        , handle_(handle) {}

    Database* database_;
    sqlite3_stmt* handle_;
    int bind_error_ = 0;
};

/// One connection. Not thread safe. The object must stay in place while statements or transactions are in use.
class Database {
public:
    /// Opens or creates the file for writing. `vfs` empty = SQLite's default. The path is taken as it is, never as a
    /// URI.
    [[nodiscard]] static Result<std::unique_ptr<Database>> open(const std::string& path, const std::string& vfs,
                                                                Access access = Access::create);
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;
    ~Database();

    [[nodiscard]] const std::string& path() const { return path_; }

    /// Runs SQL that is executed once: pragmas, transactions, schema. May hold several statements.
    [[nodiscard]] Result<void> execute(const char* sql);
    /// The statement for this SQL, prepared at its first use and kept. `sql` must be a string literal, and not be in
    /// use.
    [[nodiscard]] Result<Statement> prepare(const char* sql);
    /// The first column of the first row as number, 0 without a row. Not kept.
    [[nodiscard]] Result<std::int64_t> query_number(const char* sql);
    /// The first column of the first row as text, empty without a row. Not kept.
    [[nodiscard]] Result<std::string> query_text(const char* sql);

    [[nodiscard]] std::int64_t last_insert_id() const;
    /// Rows that the last INSERT, UPDATE or DELETE changed.
    [[nodiscard]] int changes() const;
    /// Copies what readers allow from the WAL into the database. True if the WAL could be copied completely.
    [[nodiscard]] Result<bool> checkpoint_passive();
    /// Leaves the WAL alone when the connection is closed: after an error, nothing more is written.
    void disable_checkpoint_on_close();

    /// Ends the transaction. Makes no failure of it: that may need memory, and the cause has been reported.
    void roll_back() noexcept;

    /// The failure for a result code, with the file and SQLite's own words.
    [[nodiscard]] Failure failure(int code) const;
    /// The last result code that was turned into a failure; decides what can be trusted afterwards.
    [[nodiscard]] int last_error() const { return last_error_; }
    [[nodiscard]] bool in_transaction() const;

private:
    friend class Statement;
    explicit Database(std::string path)
        : path_(std::move(path)) {}

    struct Finalizer {
        void operator()(sqlite3_stmt* handle) const;
    };

    std::string path_;
    sqlite3* handle_ = nullptr;
    mutable int last_error_ = 0;
    std::unordered_map<const void*, std::unique_ptr<sqlite3_stmt, Finalizer>> statements_; ///< by address of their SQL
};

/// BEGIN IMMEDIATE … COMMIT; rolls back unless committed.
class Transaction {
public:
    [[nodiscard]] static Result<Transaction> begin(Database& database);
    Transaction(Transaction&& other) noexcept
        : database_(std::exchange(other.database_, nullptr)) {}
    Transaction& operator=(Transaction&&) = delete;
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction();

    /// Durable when it returns without failure.
    [[nodiscard]] Result<void> commit();

private:
    explicit Transaction(Database& database)
        : database_(&database) {}
    Database* database_;
};

} // namespace linefeed::spool
