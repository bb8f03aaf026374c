// An automatic firmware profile: what it is by what the printer says of itself.
#pragma once

#include "base/failure.hpp"
#include "printer/printer_client.hpp"
#include "protocol/profile.hpp"

#include <optional>

namespace linefeed::printer {

/// What the printer says that it is (`?VS`). std::nullopt: it does not tell, as in standby, or no profile is known for
/// it.
[[nodiscard]] std::optional<protocol::Profile> told_profile(PrinterClient& printer);

/// Asks the printer (`?VS`) on a connection of its own. FailureKind::unreachable: it cannot be reached, or does not
/// tell: nothing is guessed, since what needs escapes would come out wrong.
[[nodiscard]] Result<protocol::Profile> ask_profile(const ClientSettings& settings);

} // namespace linefeed::printer
