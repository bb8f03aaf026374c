#include "config/settings_json.hpp"

#include "config/sections.hpp"

namespace linefeed::config {

namespace {

/// Visitor that writes each value; what is absent is left out.
struct Writer {
    Json& out;

    template <typename T, typename Kind>
    void value(const char* key, const T& member, const Kind& kind, const Rules& = {}) {
        if (Json written = kind.write(member); !written.is_null()) {
            out[key] = std::move(written);
        }
    }
    template <typename T>
    void section(const char* key, const T& member) {
        Json inner = Json::object();
        Writer writer{inner};
        visit(writer, member);
        out[key] = std::move(inner);
    }
    template <typename Element>
    void named(const char* key, const std::vector<Element>& elements, const Rules& = {}) {
        Json mapping = Json::object();
        for (const Element& element : elements) {
            Json inner = Json::object();
            Writer writer{inner};
            visit(writer, element);
            mapping[name_of(element)] = std::move(inner);
        }
        out[key] = std::move(mapping);
    }
};

template <typename Root>
Json write(const Root& root) {
    Json json = Json::object();
    Writer writer{json};
    visit(writer, root);
    return json;
}

} // namespace

Json to_json(const Settings& settings) {
    return write(settings);
}

Json to_json(const ErrorTable& table) {
    return write(table);
}

} // namespace linefeed::config
