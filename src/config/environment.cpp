#include "config/environment.hpp"

#include "config/keys.hpp"
#include "config/names.hpp"
#include "protocol/charset.hpp"

#include <algorithm>
#include <map>

namespace linefeed::config {

namespace {

constexpr std::string_view prefix = "LINEFEED_";

using Path = std::vector<std::string>;

Path split_path(std::string_view path) {
    Path words;
    while (true) {
        const std::size_t dot = path.find('.');
        words.emplace_back(path.substr(0, dot));
        if (dot == std::string_view::npos) {
            return words;
        }
        path.remove_prefix(dot + 1);
    }
}

std::string variable_of(const Path& path) {
    std::string name{prefix};
    for (const std::string& word : path) {
        name += (name.size() == prefix.size() ? "" : "_") + variable_word(word);
    }
    return name;
}

/// Every variable that would be a setting, with the elements that the file has.
std::map<std::string, Path> known_variables(const Node& root) {
    std::map<std::string, Path> variables;
    const auto add = [&](Path path) {
        std::string name = variable_of(path);
        variables.emplace(std::move(name), std::move(path));
    };
    for (const KeyInfo& key : known_keys()) {
        if (key.type == "section" || key.type == "elements" || key.type == "mapping") {
            continue;
        }
        Path path = split_path(key.path);
        const auto wildcard = std::find(path.begin(), path.end(), "*");
        if (wildcard == path.end()) {
            add(std::move(path));
            continue;
        }
        const Node* const elements = root.find(path.front());
        if (elements == nullptr) {
            continue;
        }
        for (const Entry& element : elements->entries) {
            *wildcard = element.key;
            add(path);
        }
    }
    return variables;
}

/// The place in the tree, made where it is missing; nullptr if something else than a mapping is in the way, which is a
/// problem of the file.
Node* make_place(Node& root, const Path& path) {
    Node* node = &root;
    for (const std::string& word : path) {
        if (node->kind == Node::Kind::nothing) {
            node->kind = Node::Kind::mapping;
        }
        if (node->kind != Node::Kind::mapping) {
            return nullptr;
        }
        auto entry = std::find_if(node->entries.begin(), node->entries.end(),
                                  [&](const Entry& candidate) { return candidate.key == word; });
        if (entry == node->entries.end()) {
            entry = node->entries.insert(entry, Entry{word, node->place, {}});
        }
        node = &entry->value;
    }
    return node;
}

/// Whether the first word of the variable is that of a section or setting.
bool looks_like_setting(std::string_view name) {
    const std::vector<KeyInfo>& keys = known_keys();
    return std::any_of(keys.begin(), keys.end(), [&](const KeyInfo& key) {
        const std::string word = std::string{prefix} + variable_word(key.path.substr(0, key.path.find('.')));
        return name == word || name.starts_with(word + '_');
    });
}

void refuse_unknown(const std::string& name, const std::map<std::string, Path>& known, Context& context) {
    std::vector<std::string> names;
    names.reserve(known.size());
    for (const auto& entry : known) {
        names.push_back(entry.first);
    }
    const std::string meant = did_you_mean(name, names);
    if (!meant.empty() || looks_like_setting(name)) {
        context.refuse(
            {0, 0, name}, {},
            "no setting has this name" +
                (meant.empty() ? "; it is LINEFEED_ and the key path in capitals, with _ in between" : meant));
    }
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const auto character = protocol::decode_utf8(text);
        if (!character) {
            return false;
        }
        text.remove_prefix(character->bytes);
    }
    return true;
}

} // namespace

Environment read_environment(const char* const* variables) {
    Environment environment;
    for (; variables != nullptr && *variables != nullptr; ++variables) {
        const std::string_view variable{*variables};
        const std::size_t equals = variable.find('=');
        if (variable.starts_with(prefix) && equals != std::string_view::npos) {
            environment.emplace_back(variable.substr(0, equals), variable.substr(equals + 1));
        }
    }
    std::sort(environment.begin(), environment.end());
    return environment;
}

void apply_environment(const Environment& environment, Node& root, Context& context) {
    const std::map<std::string, Path> known = known_variables(root);
    for (const auto& [name, value] : environment) {
        if (!name.starts_with(prefix)) {
            continue;
        }
        const auto variable = known.find(name);
        if (variable == known.end()) {
            refuse_unknown(name, known, context);
            continue;
        }
        if (!is_utf8(value)) {
            context.refuse({0, 0, name}, {}, "not UTF-8");
            continue;
        }
        if (Node* const place = make_place(root, variable->second)) {
            *place = {};
            place->kind = Node::Kind::scalar;
            place->text = value;
            place->place = {0, 0, name};
        }
    }
}

} // namespace linefeed::config
