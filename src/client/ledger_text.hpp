// The ledger of a job, for people and for programs: a summary of its records by fate, or each record with what is
// printed on it.
#pragma once

#include "client/json_fields.hpp"

#include <string>
#include <vector>

namespace linefeed::client {

/// "issued 10 = 9 printed + …", and the stretches of records with the same fate and run. `job` is a Job object,
/// `history` HistoryStretch objects.
[[nodiscard]] std::string ledger_text(const Json& job, const std::vector<Json>& history);
[[nodiscard]] Json ledger_json(const Json& job, const std::vector<Json>& history);

/// How a record is written.
enum class RecordFormat {
    table, ///< for people: local time
    csv,   ///< RFC 4180
    json,  ///< an object, one line
};
/// The first line; empty = there is none.
[[nodiscard]] std::string record_head(RecordFormat format);
/// `record` is {"number", "fields"}, of `stretch`. With its line end.
[[nodiscard]] std::string record_line(const Json& record, const Json& stretch, RecordFormat format);

} // namespace linefeed::client
