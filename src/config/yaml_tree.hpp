// A YAML file as a tree that keeps what a strict reader must know and yaml-cpp's own nodes lose: where each value
// stands, whether it was quoted, and keys that come twice. yaml-cpp stays in yaml_tree.cpp.
#pragma once

#include "config/problem.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace linefeed::config {

struct Entry;

struct Node {
    enum class Kind {
        nothing, ///< a key without value, `~` or `null`
        scalar,
        sequence,
        mapping,
        unusable, ///< a problem was reported for it already: to be passed over in silence
    };
    Kind kind = Kind::nothing;
    std::string text{};         ///< of a scalar, quotes undone
    bool plain = true;          ///< a scalar without quotes
    Place place{};              ///< of the first character
    std::vector<Node> items{};  ///< of a sequence
    std::vector<Entry> entries; ///< of a mapping, in order; may hold a key twice

    /// The value of the first entry with that key; nullptr = none.
    [[nodiscard]] const Node* find(std::string_view key) const;
};

struct Entry {
    std::string key;
    Place place; ///< of the key
    Node value;
};

inline constexpr std::size_t max_file_bytes = std::size_t{1} << 20U;
inline constexpr std::size_t max_depth = 16; ///< of mappings and sequences in each other

/// Reads one document. What is wrong with the text as such goes to `problems`, with `file` as its file: not UTF-8,
/// syntax, more than one document, anchors and aliases, tags, keys that are no text, doubled keys, too deep, too large.
/// Where the syntax is wrong, the node is unusable.
[[nodiscard]] Node read_yaml(std::string_view text, const std::string& file, Problems& problems);

/// `parent.key`, or `key` alone.
[[nodiscard]] std::string join(std::string_view parent, std::string_view key);

} // namespace linefeed::config
