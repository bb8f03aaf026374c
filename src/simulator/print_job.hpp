// The job in the printer: its name and its script (protocol, sections 4 JL and 7).
#pragma once

#include "protocol/print_messages.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace linefeed::simulator {

/// A loaded job, or one that is being sent.
struct PrintJob {
    std::string path;               ///< as `?JL` tells it; EXTERN for a script that was sent
    std::vector<std::string> lines; ///< without `BEGINLJSCRIPT` and `ENDLJSCRIPT`
};

/// The name of a job that came as a script.
inline constexpr std::string_view extern_job_name = "EXTERN";
/// A script that goes on beyond this is cut: the printer's memory ends too.
inline constexpr std::size_t max_script_lines = 10000;

/// What the job prints of its own: the texts of its objects (`OBJ [… (font) (text) …]`), joined by TAB. The name of a
/// job without such texts, so that its products can be told from others.
[[nodiscard]] std::string text_of(const PrintJob& job);

/// The job in a file: its lines end with CR, LF or both.
[[nodiscard]] PrintJob job_from_file(std::string path, std::string_view content);

} // namespace linefeed::simulator
