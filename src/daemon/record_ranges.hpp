// Record numbers as people type them: N, N-M, or several of those separated by commas.
#pragma once

#include "base/failure.hpp"
#include "base/record_number.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::daemon {

/// "N" or "N-M"; std::nullopt if it is neither, or M < N.
[[nodiscard]] std::optional<RecordRange> parse_record_range(std::string_view text);

/// "N-M,N,…" in any order, blanks around each; "none" is no record. Ascending at return. FailureKind::usage, saying
/// what is wrong, if a part is no range or a record is named twice.
[[nodiscard]] Result<std::vector<RecordRange>> parse_record_ranges(std::string_view text);

/// "5", "5-9".
[[nodiscard]] std::string to_text(const RecordRange& range);
/// "5-9, 12, 14-20": the first of them, and how many more there are.
[[nodiscard]] std::string to_text(const std::vector<RecordRange>& ranges);

} // namespace linefeed::daemon
