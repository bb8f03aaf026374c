#include "config/collections.hpp"

namespace linefeed::config {

namespace {

/// `a,b` as items that stand where the variable does.
std::vector<Node> split_at_commas(const Node& node) {
    std::vector<Node> items;
    std::string_view rest = node.text;
    while (!node.text.empty()) {
        const std::size_t comma = rest.find(',');
        Node item = node;
        item.text = rest.substr(0, comma);
        items.push_back(std::move(item));
        if (comma == std::string_view::npos) {
            break;
        }
        rest.remove_prefix(comma + 1);
    }
    return items;
}

} // namespace

std::optional<std::vector<Node>> read_items(const Node& node, const std::string& key, Context& context,
                                            std::size_t max_items) {
    const bool from_variable = !node.place.variable.empty();
    if (node.kind != Node::Kind::sequence && !from_variable) {
        refuse_value(node, key, "a list", context, node.kind == Node::Kind::nothing ? "; write [] for none" : "");
        return std::nullopt;
    }
    std::vector<Node> items = from_variable ? split_at_commas(node) : node.items;
    if (items.size() > max_items) {
        context.refuse(node.place, key, "more than " + std::to_string(max_items) + " items");
        return std::nullopt;
    }
    return items;
}

const std::vector<Entry>* read_entries(const Node& node, const std::string& key, Context& context,
                                       std::size_t max_entries) {
    if (node.kind != Node::Kind::mapping) {
        refuse_value(node, key, "a mapping", context, node.kind == Node::Kind::nothing ? "; write {} for none" : "");
        return nullptr;
    }
    if (node.entries.size() > max_entries) {
        context.refuse(node.place, key, "more than " + std::to_string(max_entries) + " entries");
        return nullptr;
    }
    return &node.entries;
}

bool ErrorNumberKey::read(const Entry& entry, const std::string& key, Context& context, std::uint32_t& out) {
    const char* const end = entry.key.data() + entry.key.size();
    std::uint32_t number = 0;
    const auto [stop, error] = std::from_chars(entry.key.data(), end, number);
    if (error != std::errc{} || stop != end || entry.key.front() == '0' || number > maximum) {
        context.refuse(entry.place, key,
                       "expected an error number from 1 to " + std::to_string(maximum) + " as key, found " +
                           in_quotes(entry.key));
        return false;
    }
    out = number;
    return true;
}

bool ColumnKey::read(const Entry& entry, const std::string& key, Context& context, std::string& out) {
    if (entry.key.empty()) {
        context.refuse(entry.place, key, "expected the name or number of a column as key");
        return false;
    }
    out = entry.key;
    return true;
}

} // namespace linefeed::config
