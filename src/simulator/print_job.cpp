// Jobs from files, see print_job.hpp.
#include "simulator/print_job.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::simulator {
namespace {

/// The first pair of parentheses and what is in it, those within it included; empty if there is none.
std::string_view first_group(std::string_view text) {
    const std::size_t begin = std::min(text.find('('), text.size());
    int depth = 0;
    for (std::size_t at = begin; at < text.size(); ++at) {
        depth += text[at] == '(' ? 1 : 0;
        depth -= text[at] == ')' ? 1 : 0;
        if (depth == 0) {
            return text.substr(begin, at + 1 - begin);
        }
    }
    return {};
}

/// Of an object: what stands in the second parentheses, behind the font. Empty for any other line.
std::string_view object_text(std::string_view line) {
    if (!line.starts_with("OBJ ") && !line.starts_with("OBJ[")) {
        return {};
    }
    const std::string_view font = first_group(line);
    if (font.empty()) {
        return {};
    }
    line.remove_prefix(static_cast<std::size_t>(font.data() - line.data()) + font.size());
    const std::string_view text = first_group(line);
    return text.empty() ? text : text.substr(1, text.size() - 2);
}

} // namespace

std::string text_of(const PrintJob& job) {
    std::string all;
    for (const std::string& line : job.lines) {
        if (const std::string_view text = object_text(line); !text.empty()) {
            all.append(all.empty() ? "" : "\t").append(text);
        }
    }
    return all.empty() ? job.path : all;
}

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
