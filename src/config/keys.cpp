#include "config/keys.hpp"

#include "config/sections.hpp"

namespace linefeed::config {

namespace {

/// Visitor that describes each key.
class KeyLister {
public:
    KeyLister(std::string path, std::vector<KeyInfo>& out)
        : path_(std::move(path))
        , out_(out) {}

    template <typename T, typename Kind>
    void value(const char* key, const T& member, const Kind& kind, const Rules& rules = {}) {
        Expectation expectation = kind.expects();
        std::string standard;
        if (!rules.required) {
            const Json written = kind.write(member);
            standard = written.is_null() ? std::string{} : written.dump();
        }
        out_.push_back({join(path_, key), std::move(expectation.type), std::move(expectation.allowed),
                        expectation.minimum, expectation.maximum, std::move(standard), rules.required, rules.applies});
    }
    template <typename T>
    void section(const char* key, const T& member) {
        out_.push_back({join(path_, key), "section"});
        KeyLister inner{join(path_, key), out_};
        visit(inner, member);
    }
    template <typename Element>
    void named(const char* key, const std::vector<Element>&, const Rules& rules = {}) {
        const std::string elements = join(path_, key);
        out_.push_back({elements, "elements"});
        out_.push_back({join(elements, "*"), "section"});
        out_.back().applies = rules.applies;
        KeyLister inner{join(elements, "*"), out_};
        const Element element{};
        visit(inner, element);
    }

private:
    std::string path_;
    std::vector<KeyInfo>& out_;
};

template <typename Root>
std::vector<KeyInfo> list_keys() {
    std::vector<KeyInfo> keys;
    KeyLister lister{{}, keys};
    const Root root{};
    visit(lister, root);
    return keys;
}

} // namespace

const std::vector<KeyInfo>& known_keys() {
    static const std::vector<KeyInfo> keys = list_keys<Settings>();
    return keys;
}

const std::vector<KeyInfo>& known_error_table_keys() {
    static const std::vector<KeyInfo> keys = list_keys<ErrorTable>();
    return keys;
}

std::string with_wildcards(const std::string& path) {
    for (const std::string_view elements : {"layouts.", "printers.", "folders."}) {
        if (path.starts_with(elements)) {
            const std::size_t end = path.find('.', elements.size());
            return std::string{elements} + '*' + (end == std::string::npos ? std::string{} : path.substr(end));
        }
    }
    return path;
}

} // namespace linefeed::config
