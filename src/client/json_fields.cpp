#include "client/json_fields.hpp"

#include "cli/wall_time.hpp"

namespace linefeed::client {

const Json& member(const Json& object, std::string_view name) {
    static const Json nothing;
    if (!object.is_object()) {
        return nothing;
    }
    const auto found = object.find(std::string{name});
    return found == object.end() ? nothing : *found;
}

std::string text(const Json& object, std::string_view name) {
    const Json& value = member(object, name);
    return value.is_string() ? value.get<std::string>() : std::string{};
}

std::optional<std::int64_t> whole(const Json& object, std::string_view name) {
    const Json& value = member(object, name);
    return value.is_number_integer() ? std::optional{value.get<std::int64_t>()} : std::nullopt;
}

std::int64_t number(const Json& object, std::string_view name) {
    return whole(object, name).value_or(0);
}

std::optional<double> real(const Json& object, std::string_view name) {
    const Json& value = member(object, name);
    return value.is_number() ? std::optional{value.get<double>()} : std::nullopt;
}

bool flag(const Json& object, std::string_view name) {
    const Json& value = member(object, name);
    return value.is_boolean() && value.get<bool>();
}

const Json& items(const Json& object, std::string_view name) {
    static const Json none = Json::array();
    const Json& value = member(object, name);
    return value.is_array() ? value : none;
}

std::string number_text(const Json& object, std::string_view name) {
    const auto value = whole(object, name);
    return value ? std::to_string(*value) : std::string{};
}

std::string range_text(const Json& range) {
    const auto first = whole(range, "first");
    const auto last = whole(range, "last");
    if (!first || !last) {
        return {};
    }
    return *first == *last ? std::to_string(*first) : std::to_string(*first) + '-' + std::to_string(*last);
}

std::string local_time(const Json& object, std::string_view name) {
    const auto ns = whole(object, name);
    return ns ? cli::format_local_time(*ns) : std::string{};
}

} // namespace linefeed::client
