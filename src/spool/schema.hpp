// The database schema, as numbered migrations that are part of the program (schema/*.sql). A spool is brought up to
// date when it is opened; one that a newer program has written is refused instead of guessed at.
#pragma once

#include "spool/database.hpp"

#include <span>
#include <string_view>

namespace linefeed::spool {

/// One migration. Versions count 1, 2, 3 …; PRAGMA user_version holds the last one applied.
struct Migration {
    int version = 0;
    std::string_view name; ///< of the file
    const char* sql = nullptr;
};

/// All of them, in order.
[[nodiscard]] std::span<const Migration> migrations();

/// PRAGMA application_id of a spool: "lnfd".
inline constexpr std::int64_t spool_application_id = 0x6C6E6664;

/// Refuses a database that is not a spool, or one newer than this program. Writes nothing. Returns its version, 0 =
/// empty.
[[nodiscard]] Result<int> check_schema(Database& database);

/// Applies what is missing, each migration in a transaction of its own.
[[nodiscard]] Result<void> apply_migrations(Database& database, int current_version);

} // namespace linefeed::spool
