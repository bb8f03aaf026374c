// Every key that a configuration can have: for the environment, for reloads, and to hold the published schema to.
#pragma once

#include "config/reload.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::config {

struct KeyInfo {
    std::string path; ///< e.g. "printers.*.queue.autostart"; `*` stands for a name
    std::string type; ///< as in Expectation; "section", or "elements" for a mapping of names to sections
    std::vector<std::string> allowed{}; ///< of a choice
    std::optional<std::uint64_t>
        minimum{}; ///< durations in nanoseconds, sizes in bytes, texts in bytes, lists in items
    std::optional<std::uint64_t> maximum{};
    std::string standard{}; ///< the value if the key is left out, as JSON; empty = none
    bool required = false;
    Applies applies = Applies::at_once;
};

/// Of the configuration, in its order.
[[nodiscard]] const std::vector<KeyInfo>& known_keys();
/// Of the table of error numbers.
[[nodiscard]] const std::vector<KeyInfo>& known_error_table_keys();

/// `path` with each name of an element replaced by `*`.
[[nodiscard]] std::string with_wildcards(const std::string& path);

} // namespace linefeed::config
