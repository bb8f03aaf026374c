#include "spool/database.hpp"

#include "base/assert.hpp"

#include <sqlite3.h>

#include <limits>
#include <utility>

namespace linefeed::spool {

namespace {

struct ErrorText {
    int code;
    std::string_view name;
    std::string_view words;
};

// Extended codes first: the first entry that fits is taken.
constexpr ErrorText error_texts[] = {
    {SQLITE_IOERR_FSYNC, "SQLITE_IOERR_FSYNC", "the disk did not confirm what was written (fsync failed)"},
    {SQLITE_IOERR_DIR_FSYNC, "SQLITE_IOERR_DIR_FSYNC", "the disk did not confirm a new file (fsync failed)"},
    {SQLITE_IOERR_WRITE, "SQLITE_IOERR_WRITE", "the disk cannot be written"},
    {SQLITE_IOERR_READ, "SQLITE_IOERR_READ", "the disk cannot be read"},
    {SQLITE_IOERR_NOMEM, "SQLITE_IOERR_NOMEM", "out of memory"},
    {SQLITE_READONLY_ROLLBACK, "SQLITE_READONLY_ROLLBACK",
     "the database was not closed cleanly and cannot be repaired without write permission"},
    {SQLITE_FULL, "SQLITE_FULL", "the disk is full"},
    {SQLITE_IOERR, "SQLITE_IOERR", "the disk failed"},
    {SQLITE_CORRUPT, "SQLITE_CORRUPT", "the file is damaged"},
    {SQLITE_NOTADB, "SQLITE_NOTADB", "the file is not an SQLite database"},
    {SQLITE_READONLY, "SQLITE_READONLY", "the file cannot be written (no permission)"},
    {SQLITE_CANTOPEN, "SQLITE_CANTOPEN", "the file cannot be opened"},
    {SQLITE_PERM, "SQLITE_PERM", "no permission"},
    {SQLITE_BUSY, "SQLITE_BUSY", "the file is locked by another program"},
    {SQLITE_NOMEM, "SQLITE_NOMEM", "out of memory"},
    {SQLITE_CONSTRAINT, "SQLITE_CONSTRAINT", "a rule of the database forbids it"},
    {SQLITE_TOOBIG, "SQLITE_TOOBIG", "a value is too large"},
};

int as_length(std::string_view bytes) {
    LINEFEED_ASSERT(bytes.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max()));
    return static_cast<int>(bytes.size());
}

} // namespace

std::string describe_sqlite_error(int extended_code) {
    for (const ErrorText& text : error_texts) {
        if (text.code == extended_code || text.code == (extended_code & 0xFF)) {
            return std::string{text.words} + " (" + std::string{text.name} + ")";
        }
    }
    return std::string{sqlite3_errstr(extended_code)} + " (SQLite error " + std::to_string(extended_code) + ")";
}

Statement::Statement(Statement&& other) noexcept
    : database_(other.database_)
    , handle_(std::exchange(other.handle_, nullptr))
    , bind_error_(other.bind_error_) {}

Statement::~Statement() {
    if (handle_ != nullptr) {
        // The result of a reset is the error of the last step, which has been reported.
        sqlite3_reset(handle_);
        sqlite3_clear_bindings(handle_);
    }
}

Statement& Statement::bind(int parameter, std::int64_t value) {
    const int code = sqlite3_bind_int64(handle_, parameter, value);
    bind_error_ = bind_error_ == SQLITE_OK ? code : bind_error_;
    return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
    const char* data = text.data() == nullptr ? "" : text.data(); // a null pointer would bind NULL
    const int code = sqlite3_bind_text(handle_, parameter, data, as_length(text), SQLITE_STATIC);
    bind_error_ = bind_error_ == SQLITE_OK ? code : bind_error_;
    return *this;
}

Statement& Statement::bind_blob(int parameter, std::string_view bytes) {
    const char* data = bytes.data() == nullptr ? "" : bytes.data();
    const int code = sqlite3_bind_blob(handle_, parameter, data, as_length(bytes), SQLITE_STATIC);
    bind_error_ = bind_error_ == SQLITE_OK ? code : bind_error_;
    return *this;
}

Result<bool> Statement::step() {
    if (bind_error_ != SQLITE_OK) {
        return database_->failure(bind_error_);
    }
    const int code = sqlite3_step(handle_);
    if (code == SQLITE_ROW) {
        return true;
    }
    if (code == SQLITE_DONE) {
        return false;
    }
    return database_->failure(code);
}

Result<void> Statement::run() {
    const auto stepped = step();
    if (!stepped) {
        return stepped.error();
    }
    LINEFEED_ASSERT(!*stepped);
    sqlite3_reset(handle_);
    return {};
}

std::int64_t Statement::number(int column) const {
    return sqlite3_column_int64(handle_, column);
}

std::string_view Statement::text(int column) const {
    return blob(column); // the database is UTF-8: text comes as its bytes
}

std::string_view Statement::blob(int column) const {
    const void* data = sqlite3_column_blob(handle_, column);
    const int size = sqlite3_column_bytes(handle_, column);
    return data == nullptr ? std::string_view{}
                           : std::string_view{static_cast<const char*>(data), static_cast<std::size_t>(size)};
}

void Database::Finalizer::operator()(sqlite3_stmt* handle) const {
    sqlite3_finalize(handle);
}

Result<std::unique_ptr<Database>> Database::open(const std::string& path, const std::string& vfs, Access access) {
    // First, so that the handle has an owner whatever happens: SQLite gives one even when it fails.
    std::unique_ptr<Database> database{new Database{path}};
    // A reader of a write-ahead log has to write its shared index, so it opens for writing too: PRAGMA query_only.
    const int create = access == Access::create ? SQLITE_OPEN_CREATE : 0;
    const int flags = SQLITE_OPEN_READWRITE | create | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
    // "./" keeps a relative path from being read as a URI or as ":memory:".
    const std::string file = path.starts_with('/') ? path : "./" + path;
    const int code = sqlite3_open_v2(file.c_str(), &database->handle_, flags, vfs.empty() ? nullptr : vfs.c_str());
    if (database->handle_ == nullptr) {
        return Failure{FailureKind::storage, path + ": " + describe_sqlite_error(SQLITE_NOMEM)};
    }
    if (code != SQLITE_OK) {
        return database->failure(code);
    }
    return database;
}

Database::~Database() {
    statements_.clear();
    const int code = sqlite3_close(handle_);
    LINEFEED_ASSERT(code == SQLITE_OK); // otherwise a statement outlives its database
}

Failure Database::failure(int code) const {
    last_error_ = code;
    std::string message = path_ + ": " + describe_sqlite_error(code);
    if ((sqlite3_errcode(handle_) & 0xFF) == (code & 0xFF)) {
        message += std::string{": "} + sqlite3_errmsg(handle_);
    }
    return {FailureKind::storage, std::move(message)};
}

Result<void> Database::execute(const char* sql) {
    const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) {
        return failure(code);
    }
    return {};
}

Result<Statement> Database::prepare(const char* sql) {
    auto& kept = statements_[sql];
    if (kept == nullptr) {
        sqlite3_stmt* handle = nullptr;
        const int code = sqlite3_prepare_v3(handle_, sql, -1, SQLITE_PREPARE_PERSISTENT, &handle, nullptr);
        if (code != SQLITE_OK) {
            return failure(code);
        }
        kept.reset(handle);
    }
    LINEFEED_ASSERT(sqlite3_stmt_busy(kept.get()) == 0);
    return Statement{*this, kept.get()};
}

Result<std::string> Database::query_text(const char* sql) {
    sqlite3_stmt* handle = nullptr;
    const int prepared = sqlite3_prepare_v2(handle_, sql, -1, &handle, nullptr);
    const std::unique_ptr<sqlite3_stmt, Finalizer> owner{handle};
    if (prepared != SQLITE_OK) {
        return failure(prepared);
    }
    std::string first;
    int code = sqlite3_step(handle);
    if (code == SQLITE_ROW) {
        const void* text = sqlite3_column_blob(handle, 0);
        const int size = sqlite3_column_bytes(handle, 0);
        if (text != nullptr) {
            first.assign(static_cast<const char*>(text), static_cast<std::size_t>(size));
        }
    }
    // To the end: what a pragma changes is committed behind its last row, and only then can fail (journal_mode = WAL
    // would leave a database without WAL).
    while (code == SQLITE_ROW) {
        code = sqlite3_step(handle);
    }
    if (code != SQLITE_DONE) {
        return failure(code);
    }
    return first;
}

Result<std::int64_t> Database::query_number(const char* sql) {
    const auto text = query_text(sql);
    if (!text) {
        return text.error();
    }
    return text->empty() ? 0 : std::stoll(*text);
}

std::int64_t Database::last_insert_id() const {
    return sqlite3_last_insert_rowid(handle_);
}

int Database::changes() const {
    return sqlite3_changes(handle_);
}

Result<bool> Database::checkpoint_passive() {
    int frames_in_wal = 0;
    int frames_copied = 0;
    const int code =
        sqlite3_wal_checkpoint_v2(handle_, nullptr, SQLITE_CHECKPOINT_PASSIVE, &frames_in_wal, &frames_copied);
    if ((code & 0xFF) == SQLITE_BUSY) {
        return false;
    }
    if (code != SQLITE_OK) {
        return failure(code);
    }
    return frames_in_wal == frames_copied;
}

void Database::disable_checkpoint_on_close() {
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
}

void Database::roll_back() noexcept {
    sqlite3_exec(handle_, "ROLLBACK", nullptr, nullptr, nullptr);
}

bool Database::in_transaction() const {
    return sqlite3_get_autocommit(handle_) == 0;
}

Result<Transaction> Transaction::begin(Database& database) {
    if (auto begun = database.execute("BEGIN IMMEDIATE"); !begun) {
        return begun.error();
    }
    return Transaction{database};
}

Transaction::~Transaction() {
    // A failed statement may have rolled back already; a failed rollback leaves nothing that could be done about it.
    if (database_ != nullptr && database_->in_transaction()) {
        database_->roll_back();
    }
}

Result<void> Transaction::commit() {
    if (auto done = database_->execute("COMMIT"); !done) {
        return done;
    }
    database_ = nullptr;
    return {};
}

} // namespace linefeed::spool
