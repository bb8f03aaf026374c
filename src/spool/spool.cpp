// Opening and closing a spool, and what decides whether it may be written.
#include "spool/spool.hpp"

#include "spool/schema.hpp"
#include "spool/spool_state.hpp"

#include <sqlite3.h>

#include <chrono>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace linefeed::spool {

namespace {

namespace fs = std::filesystem;

std::int64_t system_time_ns() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// Makes a new directory survive a power failure: its name is an entry of the directory above.
void sync_directory(const fs::path& directory) {
    const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        ::fsync(descriptor); // some file systems cannot; the database itself is synced by SQLite
        ::close(descriptor);
    }
}

Result<void> make_directories(const fs::path& directory) {
    std::error_code error;
    if (directory.empty() || fs::is_directory(directory, error)) {
        return {};
    }
    if (auto above = make_directories(directory.parent_path()); !above) {
        return above;
    }
    fs::create_directory(directory, error);
    if (error) {
        return Failure{FailureKind::storage,
                       directory.string() + ": the directory cannot be created: " + error.message()};
    }
    sync_directory(directory.has_parent_path() ? directory.parent_path() : fs::path{"."});
    return {};
}

/// Everything that does not write. synchronous comes before anything is written, journal_mode after the file was
/// recognised.
constexpr const char* connection_settings =
    "PRAGMA busy_timeout = 5000;"
    "PRAGMA synchronous = FULL;"
    "PRAGMA mmap_size = 0;"
    "PRAGMA wal_autocheckpoint = 0;"
    "PRAGMA foreign_keys = ON;"
    "PRAGMA recursive_triggers = ON;" // so that REPLACE cannot delete ledger rows
    "PRAGMA cell_size_check = ON;"
    "PRAGMA trusted_schema = OFF;"
    "PRAGMA secure_delete = OFF"; // removing a job need not overwrite its pages

Result<void> start_wal(Database& database) {
    const auto mode = database.query_text("PRAGMA journal_mode = WAL");
    if (!mode) {
        return mode.error();
    }
    if (*mode != "wal") {
        return Failure{FailureKind::storage,
                       database.path() + ": a write-ahead log is not possible on this file system"};
    }
    // What an earlier process believed to be on the disk after a failed fsync may only be in memory: it is written
    // again, into the database, before anything new rests on it.
    if (auto copied = database.query_text("PRAGMA wal_checkpoint(TRUNCATE)"); !copied) {
        return copied.error();
    }
    return {};
}

/// The small tables only: start-up must not take longer the more records there are. Pages carry checksums of their own.
Result<void> check_small_tables(Database& database) {
    for (const char* check : {"PRAGMA quick_check('jobs')", "PRAGMA quick_check('ledger_segments')"}) {
        const auto answer = database.query_text(check);
        if (!answer) {
            return answer.error();
        }
        if (*answer != "ok") {
            const auto last_line = answer->rfind('\n') + 1; // 0 if there is only one
            return Failure{FailureKind::storage,
                           database.path() + ": the spool is damaged: " + answer->substr(last_line)};
        }
    }
    return {};
}

Result<void> prepare_database(Database& database) {
    if (auto done = database.execute(connection_settings); !done) {
        return done;
    }
    const auto version = check_schema(database);
    if (!version) {
        return version.error();
    }
    if (auto done = start_wal(database); !done) {
        return done;
    }
    if (auto done = apply_migrations(database, *version); !done) {
        return done;
    }
    return check_small_tables(database);
}

} // namespace

Spool::Spool(std::unique_ptr<State> state)
    : state_(std::move(state)) {}
Spool::Spool(Spool&&) noexcept = default;
Spool& Spool::operator=(Spool&&) noexcept = default;
Spool::~Spool() = default;

Result<Spool> Spool::open(const std::filesystem::path& path, SpoolOptions options) {
    std::error_code error;
    if (path.empty() || fs::is_directory(path, error)) {
        return Failure{FailureKind::storage, "the spool must be a file: \"" + path.string() + "\" is a directory"};
    }
    if (auto done = make_directories(path.parent_path()); !done) {
        return done.error();
    }
    auto lock = FileLock::acquire(path.string() + ".lock", "the spool " + path.string());
    if (!lock) {
        return lock.error();
    }
    auto database = Database::open(path.string(), options.vfs);
    if (!database) {
        return database.error();
    }
    if (auto done = prepare_database(**database); !done) {
        (*database)->disable_checkpoint_on_close();
        return done.error();
    }
    auto state = std::make_unique<State>(
        State{std::move(*lock), std::move(*database), std::move(options.wall_clock_ns), std::nullopt, 0, {}, {}});
    if (!state->wall_clock_ns) {
        state->wall_clock_ns = system_time_ns;
    }
    if (auto done = state->remove_unfinished_imports(); !done) {
        return state->fatal(done.error());
    }
    if (auto done = state->write_missing_heads(); !done) {
        return state->fatal(done.error());
    }
    if (auto done = state->load_end_of_chain(); !done) {
        return done.error();
    }
    return Spool{std::move(state)};
}

Result<Spool> Spool::open_for_reading(const std::filesystem::path& path, SpoolOptions options) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        return Failure{FailureKind::usage, "there is no spool at " + path.string() + ": give its place with --spool"};
    }
    auto database = Database::open(path.string(), options.vfs, Access::read);
    if (!database) {
        return database.error();
    }
    (*database)->disable_checkpoint_on_close();
    if (auto done = (*database)->execute(connection_settings); !done) {
        return done.error();
    }
    if (auto done = (*database)->execute("PRAGMA query_only = ON"); !done) {
        return done.error();
    }
    const auto version = check_schema(**database);
    if (!version) {
        return version.error();
    }
    if (*version == 0) {
        return Failure{FailureKind::usage, path.string() + " is empty: it is no spool"};
    }
    auto state = std::make_unique<State>(State{FileLock{},
                                               std::move(*database),
                                               std::move(options.wall_clock_ns),
                                               Failure{FailureKind::usage, "it is open for reading only"},
                                               0,
                                               {},
                                               {}});
    if (auto done = state->load_end_of_chain(); !done) {
        return done.error();
    }
    return Spool{std::move(state)};
}

Result<void> Spool::checkpoint() {
    if (auto writable = state_->check_writable(); !writable) {
        return writable;
    }
    if (auto copied = state_->database->checkpoint_passive(); !copied) {
        return state_->failed_write(copied.error());
    }
    return {};
}

Result<void> Spool::writable() const {
    return state_->check_writable();
}

Result<void> Spool::State::check_writable() const {
    if (broken) {
        return Failure{FailureKind::storage,
                       "the spool takes no more writes until linefeed is started again, because: " + broken->message};
    }
    return {};
}

Failure Spool::State::fatal(Failure failure) {
    if (!broken) {
        broken = failure;
        database->disable_checkpoint_on_close();
    }
    return failure;
}

Failure Spool::State::failed_write(Failure failure) {
    switch (database->last_error() & 0xFF) {
    case SQLITE_FULL:
    case SQLITE_BUSY:
    case SQLITE_NOMEM:
    case SQLITE_CONSTRAINT:
    case SQLITE_TOOBIG:
        return failure;
    default:
        return fatal(std::move(failure));
    }
}

} // namespace linefeed::spool
