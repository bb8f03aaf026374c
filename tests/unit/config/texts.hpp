// What the loader says about a text, as people read it.
#pragma once

#include "config/load.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace linefeed::config {

inline std::vector<std::string> lines_of(const Problems& problems) {
    std::vector<std::string> lines;
    for (const Problem& problem : problems.kept()) {
        lines.push_back(to_string(problem));
    }
    return lines;
}

/// The refusals of a configuration in the file "f.yaml"; empty = accepted.
inline std::vector<std::string> refusals_of(std::string_view text, const Environment& environment = {}) {
    const auto settings = parse_settings(text, "f.yaml", environment);
    return settings ? std::vector<std::string>{} : lines_of(settings.error());
}

/// A configuration with one printer and one layout, and `more` behind it.
inline std::string with_printer(std::string_view more) {
    return "printers: {line1: {address: tcp://h:3000}}\nlayouts: {names: {}}\n" + std::string{more};
}

} // namespace linefeed::config
