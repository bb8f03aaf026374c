#include "config/yaml_tree.hpp"

#include "base/assert.hpp"
#include "protocol/charset.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <unordered_map>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/node/node.h> // parser.h only declares it
#include <yaml-cpp/parser.h>

namespace linefeed::config {

namespace {

/// Lines of the text, to turn the byte offsets of yaml-cpp into columns as an editor shows them.
class Lines {
public:
    explicit Lines(std::string_view text)
        : text_(text) {
        while (true) {
            const std::size_t end = text.find('\n');
            lines_.push_back(text.substr(0, end));
            if (end == std::string_view::npos) {
                return;
            }
            text.remove_prefix(end + 1);
        }
    }

    /// yaml-cpp counts from 0, columns in bytes; its null mark is -1.
    [[nodiscard]] Place place(const YAML::Mark& mark) const {
        if (mark.is_null() || static_cast<std::size_t>(mark.line) >= lines_.size()) {
            return {};
        }
        const std::string_view line = lines_[static_cast<std::size_t>(mark.line)];
        const std::string_view before = line.substr(0, static_cast<std::size_t>(std::max(mark.column, 0)));
        const auto characters = std::count_if(before.begin(), before.end(), [](char byte) {
            return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; // not a continuation byte
        });
        return {static_cast<std::uint32_t>(mark.line) + 1, static_cast<std::uint32_t>(characters) + 1, {}};
    }

    /// The text from the mark on.
    [[nodiscard]] std::string_view from(const YAML::Mark& mark) const {
        if (mark.is_null() || static_cast<std::size_t>(mark.line) >= lines_.size()) {
            return {};
        }
        const auto line = lines_[static_cast<std::size_t>(mark.line)].data() - text_.data();
        return text_.substr(std::min(static_cast<std::size_t>(line + mark.column), text_.size()));
    }

private:
    std::string_view text_;
    std::vector<std::string_view> lines_;
};

/// Whether a text that begins with a quote has the quote that ends it. yaml-cpp takes the end of the file for one, and
/// everything up to there for the value.
bool quote_is_closed(std::string_view text) {
    const char quote = text.front();
    for (std::size_t i = 1; i < text.size(); ++i) {
        if (quote == '"' && text[i] == '\\') {
            ++i;
        } else if (text[i] == quote) {
            if (quote == '"' || i + 1 == text.size() || text[i + 1] != quote) {
                return true;
            }
            ++i; // two single quotes stand for one
        }
    }
    return false;
}

/// Ends the parse: the tree would be too deep.
struct TooDeep {};

/// Builds the tree out of yaml-cpp's events. Flow: parse, then take().
class TreeBuilder final : public YAML::EventHandler {
public:
    TreeBuilder(const Lines& lines, const std::string& file, Problems& problems)
        : lines_(lines)
        , file_(file)
        , problems_(problems) {}

    [[nodiscard]] Node take() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        complete(begin(mark, "?", anchor, Node::Kind::nothing));
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
        complete(refused(lines_.place(mark), "aliases (*name) are not supported: write the value out"));
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        Node node = begin(mark, tag, anchor, Node::Kind::scalar);
        node.text = value;
        node.plain = tag == "?";
        const std::string_view written = lines_.from(mark);
        if ((written.starts_with('"') || written.starts_with('\'')) && !quote_is_closed(written)) {
            node = refused(node.place, "not valid YAML: the quote is not closed");
        }
        complete(std::move(node));
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value /*style*/) override {
        open(begin(mark, tag, anchor, Node::Kind::sequence));
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value /*style*/) override {
        open(begin(mark, tag, anchor, Node::Kind::mapping));
    }
    void OnMapEnd() override { close(); }

private:
    /// A mapping or sequence that is not complete yet.
    struct Open {
        Node node;
        /// Of a mapping: the key whose value comes next.
        std::optional<Node> key{};
    };

    [[nodiscard]] std::string path() const {
        std::string path;
        for (const Open& open : open_) {
            if (open.key) {
                path = join(path, open.key->text);
            } else if (open.node.kind == Node::Kind::sequence) {
                path += '[' + std::to_string(open.node.items.size() + 1) + ']';
            }
        }
        return path;
    }

    Node refused(const Place& place, std::string message) {
        problems_.add({file_, place, path(), std::move(message)});
        Node node;
        node.kind = Node::Kind::unusable;
        node.place = place;
        return node;
    }

    Node begin(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, Node::Kind kind) {
        const Place place = lines_.place(mark);
        if (anchor != YAML::NullAnchor) {
            return refused(place, "anchors (&name) are not supported: write each value out");
        }
        if (!tag.empty() && tag != "?" && tag != "!") {
            return refused(place, "tags (" + in_quotes(tag) + ") are not supported: leave it out");
        }
        Node node;
        node.kind = kind;
        node.place = place;
        return node;
    }

    void open(Node node) {
        if (open_.size() == max_depth) {
            (void)refused(node.place, "more than " + std::to_string(max_depth) + " lists and mappings in each other");
            throw TooDeep{};
        }
        open_.push_back({std::move(node)});
    }

    void close() {
        LINEFEED_ASSERT(!open_.empty());
        Node node = std::move(open_.back().node);
        open_.pop_back();
        complete(std::move(node));
    }

    /// A node with all that is in it: the root, an item, a key or the value of a key. What is in an unusable one is not
    /// kept.
    void complete(Node node) {
        if (open_.empty()) {
            root_ = std::move(node);
            return;
        }
        Open& parent = open_.back();
        if (parent.node.kind == Node::Kind::sequence) {
            parent.node.items.push_back(std::move(node));
        } else if (parent.node.kind == Node::Kind::mapping) {
            add_to_mapping(parent, std::move(node));
        }
    }

    void add_to_mapping(Open& parent, Node node) {
        if (!parent.key) {
            if (node.kind != Node::Kind::scalar && node.kind != Node::Kind::unusable) {
                node = refused(node.place, "a key must be a text");
            }
            parent.key = std::move(node);
            return;
        }
        if (parent.key->kind == Node::Kind::scalar) {
            if (node.kind == Node::Kind::nothing) {
                node.place = parent.key->place; // yaml-cpp's is that of the next thing in the file
            }
            parent.node.entries.push_back({parent.key->text, parent.key->place, std::move(node)});
        }
        parent.key.reset();
    }

    const Lines& lines_;
    const std::string& file_;
    Problems& problems_;
    std::vector<Open> open_; // at most max_depth
    Node root_;
};

/// Reports every key that a mapping has a second time.
void check_doubled(const Node& node, const std::string& path, const std::string& file, Problems& problems) {
    std::unordered_map<std::string_view, const Entry*> first;
    for (const Entry& entry : node.entries) {
        const auto [known, is_new] = first.emplace(entry.key, &entry);
        const std::string key = join(path, entry.key);
        if (!is_new) {
            problems.add({file, entry.place, key,
                          "doubled key: it stands in line " + std::to_string(known->second->place.line) + " already"});
        }
        check_doubled(entry.value, key, file, problems);
    }
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        check_doubled(node.items[i], path + '[' + std::to_string(i + 1) + ']', file, problems);
    }
}

/// The first byte that cannot be part of a configuration, and why; nothing if all can.
struct BadByte {
    Place place;
    std::string reason;
};

std::optional<BadByte> find_bad_byte(std::string_view text) {
    Place place{1, 1, {}};
    while (!text.empty()) {
        const auto character = protocol::decode_utf8(text);
        if (!character) {
            return BadByte{place, "not UTF-8: save the file as UTF-8"};
        }
        const char32_t code = character->code_point;
        if ((code < 0x20 && code != '\t' && code != '\n' && code != '\r') || (code >= 0x7F && code < 0xA0)) {
            return BadByte{place, "a control character: " + in_quotes(text.substr(0, character->bytes))};
        }
        ++place.column;
        if (code == '\n') {
            ++place.line;
            place.column = 1;
        }
        text.remove_prefix(character->bytes);
    }
    return std::nullopt;
}

/// yaml-cpp's words in ours: one sentence without a capital.
std::string syntax_message(const YAML::Exception& error) {
    return "not valid YAML: " + error.msg;
}

} // namespace

const Node* Node::find(std::string_view key) const {
    const auto entry =
        std::find_if(entries.begin(), entries.end(), [&](const Entry& candidate) { return candidate.key == key; });
    return entry == entries.end() ? nullptr : &entry->value;
}

std::string join(std::string_view parent, std::string_view key) {
    return parent.empty() ? std::string{key} : std::string{parent} + '.' + std::string{key};
}

Node read_yaml(std::string_view text, const std::string& file, Problems& problems) {
    Node unusable;
    unusable.kind = Node::Kind::unusable;
    if (text.size() > max_file_bytes) {
        problems.add({file, {}, {}, "larger than " + std::to_string(max_file_bytes >> 10U) + " KiB"});
        return unusable;
    }
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        text.remove_prefix(byte_order_mark.size());
    }
    if (const auto bad = find_bad_byte(text)) {
        problems.add({file, bad->place, {}, bad->reason});
        return unusable;
    }
    const Lines lines{text};
    TreeBuilder builder{lines, file, problems};
    std::istringstream stream{std::string{text}};
    try {
        YAML::Parser parser{stream};
        if (!parser.HandleNextDocument(builder)) {
            return {};
        }
        Node root = builder.take();
        TreeBuilder rest{lines, file, problems};
        if (parser.HandleNextDocument(rest)) {
            problems.add({file, {}, {}, "more than one document: leave the second \"---\" out"});
        }
        check_doubled(root, {}, file, problems);
        return root;
    } catch (const YAML::Exception& error) {
        problems.add({file, lines.place(error.mark), {}, syntax_message(error)});
    } catch (const TooDeep&) {
        return unusable; // reported where it was found
    }
    return unusable;
}

} // namespace linefeed::config
