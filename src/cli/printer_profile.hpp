// `--profile auto`: the firmware profile as the printer says what it is.
#pragma once

#include "base/failure.hpp"
#include "cli/print_options.hpp"
#include "protocol/profile.hpp"

namespace linefeed::cli {

/// Asks the printer of `options`, see printer::ask_profile(). FailureKind::usage: its address is none.
[[nodiscard]] Result<protocol::Profile> ask_profile(const PrintOptions& options);

} // namespace linefeed::cli
