// Reads a section of settings from a node, by its description (config/sections.hpp).
#pragma once

#include "config/sections.hpp"

#include <set>

namespace linefeed::config {

/// Visitor that lists the keys of a section.
struct KeyNames {
    std::vector<std::string> names{};

    template <typename T, typename Kind>
    void value(const char* key, T&, const Kind&, const Rules& = {}) {
        names.emplace_back(key);
    }
    template <typename T>
    void section(const char* key, T&) {
        names.emplace_back(key);
    }
    template <typename T>
    void named(const char* key, T&, const Rules& = {}) {
        names.emplace_back(key);
    }
};

/// Refuses what is no mapping, and keys that are not among `known`. False = it is no mapping.
[[nodiscard]] bool check_section(const Node& node, const std::string& path, const std::vector<std::string>& known,
                                 Context& context);
/// Refuses a name that an earlier element has, apart from case and punctuation. `words` are those of the earlier ones.
void check_unlike(const Entry& entry, const std::string& key, std::set<std::string>& words, Context& context);

template <typename S>
void read_section(S& section, const Node& node, const std::string& path, Context& context);

/// Visitor that takes each value from the node, where the node has it.
class ValueReader {
public:
    ValueReader(const Node& node, const std::string& path, Context& context)
        : node_(node)
        , path_(path)
        , context_(context) {}

    template <typename T, typename Kind>
    void value(const char* key, T& member, const Kind& kind, const Rules& rules = {}) {
        static_assert(std::same_as<T, typename Kind::T>);
        const std::string path = join(path_, key);
        const Node* const found = node_.find(key);
        if (found == nullptr) {
            if (rules.required) {
                context_.refuse(node_.place, path, "missing: this key must be there");
            }
            return;
        }
        if (kind.read(*found, path, context_, member)) {
            context_.places[path] = found->place;
        }
    }

    template <typename T>
    void section(const char* key, T& member) {
        if (const Node* const found = node_.find(key)) {
            read_section(member, *found, join(path_, key), context_);
        }
    }

    template <typename Element>
    void named(const char* key, std::vector<Element>& elements, const Rules& = {}) {
        const Node* const found = node_.find(key);
        const std::string path = join(path_, key);
        const auto* const entries = found == nullptr ? nullptr : read_entries(*found, path, context_, max_elements);
        if (entries == nullptr) {
            return;
        }
        std::set<std::string> words;
        for (const Entry& entry : *entries) {
            const std::string element_path = join(path, entry.key);
            Element element;
            if (!set_name(element, entry, element_path, context_)) {
                continue;
            }
            if (&entry.value != found->find(entry.key)) {
                continue; // a doubled key, which is reported: the first counts
            }
            check_unlike(entry, element_path, words, context_);
            context_.places[element_path] = entry.place;
            read_section(element, entry.value, element_path, context_);
            elements.push_back(std::move(element));
        }
    }

private:
    const Node& node_;
    const std::string& path_;
    Context& context_;
};

template <typename S>
void read_section(S& section, const Node& node, const std::string& path, Context& context) {
    KeyNames keys;
    visit(keys, section);
    if (check_section(node, path, keys.names, context)) {
        ValueReader reader{node, path, context};
        visit(reader, section);
    }
}

} // namespace linefeed::config
