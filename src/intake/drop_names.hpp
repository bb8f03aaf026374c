// The names in a drop folder: which are batches, what they are called once they are claimed, and what lies beside them.
// A name is any bytes but '/' and NUL, up to NAME_MAX; nothing here needs it to be text.
#pragma once

#include <string>
#include <string_view>

namespace linefeed::intake {

/// NAME.done beside NAME says that NAME is complete.
inline constexpr std::string_view done_mark_ending = ".done";
/// What came of NAME stands beside it in NAME.report.json.
inline constexpr std::string_view report_ending = ".report.json";

/// Whether a file of this name is a batch: it matches the shell pattern (`*` does not match a leading dot) and is
/// neither a done mark nor a companion of an SQLite database.
[[nodiscard]] bool is_batch_name(const std::string& name, const std::string& pattern);
/// The batch that a done mark of this name speaks of; empty = the name is not one of a mark.
[[nodiscard]] std::string marked_name(std::string_view name);
/// Whether the name is that of a file that SQLite keeps beside a database (-wal, -shm, -journal).
[[nodiscard]] bool is_sqlite_companion(std::string_view name);
/// The name for a claimed file, the `attempt`-th (from 1) if earlier ones are taken: "a.csv", "a~2.csv", "a~3.csv" …
/// Cut, at a whole UTF-8 character, where a report would not fit beside it any more.
[[nodiscard]] std::string kept_name(const std::string& name, unsigned attempt);

} // namespace linefeed::intake
