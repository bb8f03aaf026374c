// The names under which the database keeps kinds and states, read back.
#pragma once

#include "spool/ledger.hpp"

namespace linefeed::spool {

[[nodiscard]] std::optional<LedgerKind> ledger_kind_from_name(std::string_view name);
[[nodiscard]] std::optional<RecordState> record_state_from_name(std::string_view name);

/// What the first row of a spool has as previous hash.
inline constexpr std::string_view first_previous_hash =
    "0000000000000000000000000000000000000000000000000000000000000000";

} // namespace linefeed::spool
