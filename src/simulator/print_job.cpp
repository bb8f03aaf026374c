// Jobs from files, see print_job.hpp.
#include "simulator/print_job.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::simulator {

PrintJob job_from_file(std::string path, std::string_view content) {
    PrintJob job{std::move(path), {}};
    while (!content.empty() && job.lines.size() < max_script_lines) {
        const std::size_t end = std::min(content.find_first_of("\r\n"), content.size());
        const protocol::ScriptLine line{std::string{content.substr(0, end)}};
        content.remove_prefix(std::min(end + 1, content.size()));
        if (!line.text.empty() && !line.is_begin() && !line.is_end()) {
            job.lines.push_back(line.text);
        }
    }
    return job;
}

} // namespace linefeed::simulator
