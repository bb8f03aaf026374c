// Lists and mappings of values that are no sections of their own.
#pragma once

#include "config/values.hpp"

#include <algorithm>
#include <charconv>
#include <map>

namespace linefeed::config {

/// The items of a list; of a variable of the environment, separated by commas (empty = none).
[[nodiscard]] std::optional<std::vector<Node>> read_items(const Node& node, const std::string& key, Context& context,
                                                          std::size_t max_items);
/// The entries of a mapping; nullptr = refused.
[[nodiscard]] const std::vector<Entry>* read_entries(const Node& node, const std::string& key, Context& context,
                                                     std::size_t max_entries);

/// A list without doubles, in order.
template <typename Kind>
struct ListOf {
    using T = std::vector<typename Kind::T>;
    Kind kind;
    std::size_t max_items;

    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, T& out) const {
        const auto items = read_items(node, key, context, max_items);
        if (!items) {
            return false;
        }
        T values;
        for (std::size_t i = 0; i < items->size(); ++i) {
            const std::string item_key = key + '[' + std::to_string(i + 1) + ']';
            typename Kind::T value{};
            if (!kind.read((*items)[i], item_key, context, value)) {
                continue;
            }
            if (std::find(values.begin(), values.end(), value) != values.end()) {
                context.refuse((*items)[i].place, item_key, describe((*items)[i]) + " is in the list already");
                continue;
            }
            values.push_back(std::move(value));
        }
        out = std::move(values);
        return true;
    }
    [[nodiscard]] Json write(const T& values) const {
        Json list = Json::array();
        for (const auto& value : values) {
            list.push_back(kind.write(value));
        }
        return list;
    }
    [[nodiscard]] Expectation expects() const { return {"list", {}, 0, max_items}; }
};
template <typename Kind>
ListOf(Kind, std::size_t) -> ListOf<Kind>;

/// Keys that are error numbers.
struct ErrorNumberKey {
    using T = std::uint32_t;
    static constexpr std::uint32_t maximum = (std::uint32_t{1} << 25U) - 1; ///< bits 24…0
    [[nodiscard]] static bool read(const Entry& entry, const std::string& key, Context& context, std::uint32_t& out);
    [[nodiscard]] static std::string write(std::uint32_t number) { return std::to_string(number); }
};

/// Keys that are column names, or numbers from 1.
struct ColumnKey {
    using T = std::string;
    [[nodiscard]] static bool read(const Entry& entry, const std::string& key, Context& context, std::string& out);
    [[nodiscard]] static std::string write(const std::string& name) { return name; }
};

/// A mapping with keys of any number.
template <typename Key, typename Kind>
struct MapOf {
    using T = std::map<typename Key::T, typename Kind::T>;
    Kind kind;
    std::size_t max_entries;

    [[nodiscard]] bool read(const Node& node, const std::string& key, Context& context, T& out) const {
        const auto* const entries = read_entries(node, key, context, max_entries);
        if (entries == nullptr) {
            return false;
        }
        T values;
        for (const Entry& entry : *entries) {
            const std::string entry_key = join(key, entry.key);
            typename Key::T name{};
            typename Kind::T value{};
            const bool named = Key::read(entry, entry_key, context, name);
            if (kind.read(entry.value, entry_key, context, value) && named) {
                values.emplace(std::move(name), std::move(value)); // doubled keys are reported: the first counts
            }
        }
        out = std::move(values);
        return true;
    }
    [[nodiscard]] Json write(const T& values) const {
        Json mapping = Json::object();
        for (const auto& [name, value] : values) {
            mapping[Key::write(name)] = kind.write(value);
        }
        return mapping;
    }
    [[nodiscard]] Expectation expects() const { return {"mapping", {}, 0, max_entries}; }
};

} // namespace linefeed::config
