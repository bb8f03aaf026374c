// `linefeed print FILE --printer tcp://HOST:PORT`: a file goes record by record through the printer, in the foreground.
#pragma once

#include "cli/exit_code.hpp"
#include "cli/print_options.hpp"

namespace linefeed::cli {

/// Runs the command to its end; says everything there is to say on stdout (data) and stderr (messages).
[[nodiscard]] ExitCode run_print(const PrintOptions& options);

} // namespace linefeed::cli
