// Who sits at the terminal, as he stands in the ledger.
#pragma once

#include <string>

namespace linefeed::cli {

/// The user's name, "uid 1000" if he has none.
[[nodiscard]] std::string operator_name();

} // namespace linefeed::cli
