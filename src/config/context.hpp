// What the reading of one file carries along.
#pragma once

#include "config/yaml_tree.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace linefeed::config {

struct Context {
    std::string file;                ///< as shown in problems
    std::filesystem::path directory; ///< what relative paths are relative to
    Problems problems{};
    std::map<std::string, Place> places{}; ///< of every value that was read, by key path

    void refuse(const Place& place, const std::string& key, std::string message) {
        problems.add({file, place, key, std::move(message)});
    }
    /// At the place where the key was read, or nowhere in particular.
    void refuse(const std::string& key, std::string message) {
        const auto place = places.find(key);
        refuse(place == places.end() ? Place{} : place->second, key, std::move(message));
    }
    [[nodiscard]] bool was_read(const std::string& key) const { return places.contains(key); }
};

/// `a list`, `a mapping`, `nothing`, or the value in quotes.
[[nodiscard]] std::string describe(const Node& node);

/// `expected EXPECTED, found …HINT`, unless the node is unusable.
void refuse_value(const Node& node, const std::string& key, const std::string& expected, Context& context,
                  const std::string& hint = {});

} // namespace linefeed::config
