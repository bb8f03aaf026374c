#include "spool/schema.hpp"

#include <string>

namespace linefeed::spool {

Result<int> check_schema(Database& database) {
    const auto version = database.query_number("PRAGMA user_version");
    if (!version) {
        return version.error();
    }
    const auto application = database.query_number("PRAGMA application_id");
    if (!application) {
        return application.error();
    }
    const auto objects = database.query_number("SELECT count(*) FROM sqlite_schema");
    if (!objects) {
        return objects.error();
    }
    const bool empty = *version == 0 && *application == 0 && *objects == 0;
    if (!empty && *application != spool_application_id) {
        return Failure{FailureKind::storage,
                       database.path() + ": this is the database of another program, not a linefeed spool"};
    }
    const auto newest = static_cast<std::int64_t>(migrations().size());
    if (*version > newest) {
        return Failure{FailureKind::storage, database.path() + ": written by a newer linefeed (schema " +
                                                 std::to_string(*version) + ", this program knows " +
                                                 std::to_string(newest) + "): use that version"};
    }
    if (*version < 0 || (!empty && *version == 0)) {
        return Failure{FailureKind::storage, database.path() + ": the spool is damaged: it has no schema version"};
    }
    return static_cast<int>(*version);
}

namespace {

Result<void> apply(Database& database, const Migration& migration) {
    auto transaction = Transaction::begin(database);
    if (!transaction) {
        return transaction.error();
    }
    if (auto done = database.execute(migration.sql); !done) {
        return done;
    }
    const std::string set_version = "PRAGMA user_version = " + std::to_string(migration.version);
    if (auto done = database.execute(set_version.c_str()); !done) {
        return done;
    }
    return transaction->commit();
}

} // namespace

Result<void> apply_migrations(Database& database, int current_version) {
    const auto enforced = database.query_number("PRAGMA foreign_keys");
    if (!enforced) {
        return enforced.error();
    }
    // A table whose rows name rows of the same table cannot be dropped in a time that grows with their number only: for
    // each row SQLite would look through all others. The setting takes effect between transactions only.
    if (auto off = database.execute("PRAGMA foreign_keys = OFF"); !off) {
        return off;
    }
    for (const Migration& migration : migrations()) {
        if (migration.version <= current_version) {
            continue;
        }
        if (auto done = apply(database, migration); !done) {
            return done;
        }
    }
    return *enforced != 0 ? database.execute("PRAGMA foreign_keys = ON") : Result<void>{};
}

} // namespace linefeed::spool
