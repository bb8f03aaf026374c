// The job in the printer: loading one with proof, and jobs as scripts (protocol, sections 4 JL and 7). Never while it
// prints.
#pragma once

#include "base/failure.hpp"
#include "printer/printer_client.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace linefeed::printer {

/// The machine says that it does not print. FailureKind::stopped: it does; ::unreachable: it does not answer.
[[nodiscard]] Result<void> check_not_printing(PrinterClient& printer);

/// `=JL path`, then `?JL` until the printer names it, which takes 50…150 ms; the name that it tells.
/// FailureKind::input: there is no such job; ::stopped: it prints, or names another job after `patience`;
/// ::unreachable: no answer.
[[nodiscard]] Result<std::string> load_job(PrinterClient& printer, const std::string& path,
                                           Duration patience = std::chrono::seconds{3});

/// The current job as a script, without `BEGINLJSCRIPT` and `ENDLJSCRIPT`. FailureKind::unreachable: no answer, or it
/// ends early.
[[nodiscard]] Result<std::vector<std::string>> read_script(PrinterClient& printer);

/// The lines of a script in a file: ends with CR, LF or both, empty ones dropped; with or without `BEGINLJSCRIPT` and
/// `ENDLJSCRIPT`, which are taken away. FailureKind::input: no line, one that is too long or cannot be sent to this
/// firmware, begin or end in the wrong place.
[[nodiscard]] Result<std::vector<std::string>> script_lines(std::string_view text, protocol::EscapeMode escapes);

/// What came of sending a script.
struct ScriptSent {
    std::string job;              ///< the printer's name for it: EXTERN
    bool reads_back_alike = true; ///< `?JB` gives the lines that were sent; firmware may write them in its own way
};

/// Sends a script in one piece, waits until the printer names the job EXTERN, and reads it back. The job that was
/// loaded before is gone. Fails as load_job(); FailureKind::stopped also where the printer still has the script that it
/// had before.
[[nodiscard]] Result<ScriptSent> send_script(PrinterClient& printer, const std::vector<std::string>& lines,
                                             Duration patience = std::chrono::seconds{3});

} // namespace linefeed::printer
