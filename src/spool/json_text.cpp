#include "spool/json_text.hpp"

#include <nlohmann/json.hpp>

namespace linefeed::spool {

JsonObject& JsonObject::add(std::string_view key, std::string_view text) {
    return add_json(key, json_string(text));
}

JsonObject& JsonObject::add_json(std::string_view key, std::string_view json) {
    text_ += text_.size() > 1 ? ",\"" : "\"";
    text_.append(key).append("\":").append(json);
    return *this;
}

std::string json_string(std::string_view text) {
    // A single string is the one value whose destructor needs no memory.
    const nlohmann::json string(text);
    return string.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_array(const std::vector<std::string>& values) {
    std::string text = "[";
    for (const std::string& value : values) {
        text.append(text.size() > 1 ? "," : "").append(value);
    }
    return text + ']';
}

} // namespace linefeed::spool
