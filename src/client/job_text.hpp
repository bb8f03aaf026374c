// Jobs for people: the table, a single job, and records in doubt. The JSON is that of openapi.yaml.
#pragma once

#include "client/json_fields.hpp"
#include "client/terminal.hpp"

#include <string>
#include <vector>

namespace linefeed::client {

/// Job objects as a table.
[[nodiscard]] std::string jobs_text(const std::vector<Json>& jobs, const Screen& screen);

/// One Job object, with all that is known.
[[nodiscard]] std::string job_text(const Json& job, const Screen& screen);

/// "job 12 (names.csv): stopped, 500 of 1000 records printed, next 501"; one line, safe to show.
[[nodiscard]] std::string job_line(const Json& job);

/// A Doubt object: each record, and how an operator can tell what is known.
[[nodiscard]] std::string doubt_text(const Json& doubt, std::int64_t job, const Screen& screen);

} // namespace linefeed::client
