#include "api/json_text.hpp"

#include "protocol/charset.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <set>

namespace linefeed::api {

namespace {

void append_hex(std::string& out, char byte) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    const auto value = static_cast<unsigned char>(byte);
    out += "\\x";
    out += digits[value >> 4U];
    out += digits[value & 0xFU];
}

/// Whether a member comes twice, in any object of the text. JSON leaves open what that means, so it means nothing.
class DoubledMembers {
public:
    bool operator()(int /*depth*/, Json::parse_event_t event, const Json& parsed) {
        switch (event) {
        case Json::parse_event_t::object_start:
            members_.emplace_back();
            break;
        case Json::parse_event_t::object_end:
            members_.pop_back();
            break;
        case Json::parse_event_t::key:
            if (!members_.back().insert(parsed.get<std::string>()).second && doubled_.empty()) {
                doubled_ = parsed.get<std::string>();
            }
            break;
        case Json::parse_event_t::array_start:
        case Json::parse_event_t::array_end:
        case Json::parse_event_t::value:
            break;
        }
        return true;
    }
    [[nodiscard]] const std::string& doubled() const { return doubled_; }

private:
    std::vector<std::set<std::string>> members_;
    std::string doubled_;
};

} // namespace

std::string visible(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        if (const auto character = protocol::decode_utf8(text)) {
            out += text.substr(0, character->bytes);
            text.remove_prefix(character->bytes);
        } else {
            append_hex(out, text.front());
            text.remove_prefix(1);
        }
    }
    return out;
}

std::string visible_ascii(std::string_view bytes) {
    std::string out;
    for (const char byte : bytes) {
        if (byte >= ' ' && byte <= '~' && byte != '\\') {
            out += byte;
        } else {
            append_hex(out, byte);
        }
    }
    return out;
}

std::string dump(const Json& json) {
    return json.dump();
}

Json parsed_object(std::string_view text) {
    Json json = Json::parse(text, nullptr, false);
    return json.is_object() ? json : Json(nullptr);
}

std::string rfc3339(std::int64_t ns) {
    constexpr std::int64_t ns_per_s = 1'000'000'000;
    constexpr std::int64_t ns_per_ms = 1'000'000;
    const std::time_t seconds = ns / ns_per_s;
    std::tm utc{};
    ::gmtime_r(&seconds, &utc);
    char text[48];
    const std::size_t size = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
    std::snprintf(text + size, sizeof text - size, ".%03dZ", static_cast<int>(ns % ns_per_s / ns_per_ms));
    return text;
}

Checked<BodyReader> BodyReader::parse(std::string_view text) {
    if (text.empty()) {
        return BodyReader{Json::object()};
    }
    DoubledMembers doubled;
    Json json = Json::parse(text, std::ref(doubled), false);
    if (!json.is_object()) {
        return Problem{ProblemType::malformed,
                       json.is_discarded() ? "the body is not valid JSON" : "the body is JSON, but not an object",
                       "send one JSON object, as /api/v1/openapi.yaml shows it"};
    }
    if (!doubled.doubled().empty()) {
        return Problem{ProblemType::malformed, "the member \"" + doubled.doubled() + "\" comes twice",
                       "send each member once"};
    }
    return BodyReader{std::move(json)};
}

const Json* BodyReader::take(std::string_view member) {
    known_.emplace_back(member);
    const auto found = object_.find(member);
    return found == object_.end() ? nullptr : &*found;
}

void BodyReader::refuse(std::string_view member, std::string_view expected) {
    if (wrong_.empty()) {
        wrong_ = '"' + std::string{member} + "\" must be " + std::string{expected};
    }
}

std::optional<std::string> BodyReader::text(std::string_view member) {
    const Json* const value = take(member);
    if (value == nullptr) {
        return std::nullopt;
    }
    if (!value->is_string()) {
        refuse(member, "a text");
        return std::nullopt;
    }
    return value->get<std::string>();
}

std::optional<bool> BodyReader::flag(std::string_view member) {
    const Json* const value = take(member);
    if (value == nullptr) {
        return std::nullopt;
    }
    if (!value->is_boolean()) {
        refuse(member, "true or false");
        return std::nullopt;
    }
    return value->get<bool>();
}

std::optional<std::int64_t> BodyReader::number(std::string_view member, std::int64_t least, std::int64_t most) {
    const Json* const value = take(member);
    if (value == nullptr) {
        return std::nullopt;
    }
    const bool fits =
        value->is_number_integer() &&
        (!value->is_number_unsigned() || value->get<std::uint64_t>() <= static_cast<std::uint64_t>(most)) &&
        value->get<std::int64_t>() >= least && value->get<std::int64_t>() <= most;
    if (!fits) {
        refuse(member, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
        return std::nullopt;
    }
    return value->get<std::int64_t>();
}

std::string BodyReader::required_text(std::string_view member) {
    const auto value = text(member);
    if (!value || value->empty()) {
        refuse(member, "given, as a text that is not empty");
    }
    return value.value_or("");
}

std::int64_t BodyReader::required_number(std::string_view member, std::int64_t least, std::int64_t most) {
    const auto value = number(member, least, most);
    if (!value) {
        refuse(member, "given, as a whole number");
    }
    return value.value_or(least);
}

bool BodyReader::required_flag(std::string_view member) {
    const auto value = flag(member);
    if (!value) {
        refuse(member, "given, as true or false");
    }
    return value.value_or(false);
}

Json BodyReader::rest() {
    Json rest = Json::object();
    for (const auto& [member, value] : object_.items()) {
        if (std::find(known_.begin(), known_.end(), member) == known_.end()) {
            rest[member] = value;
        }
    }
    for (const auto& [member, value] : rest.items()) {
        known_.push_back(member);
    }
    return rest;
}

Checked<void> BodyReader::finish() const {
    const auto refused = [](std::string detail, std::string advice) {
        return Problem{ProblemType::not_valid, std::move(detail), std::move(advice)};
    };
    if (!wrong_.empty()) {
        return refused(wrong_, "see /api/v1/openapi.yaml");
    }
    for (const auto& [member, value] : object_.items()) {
        if (std::find(known_.begin(), known_.end(), member) == known_.end()) {
            std::string allowed;
            for (const std::string& known : known_) {
                allowed += (allowed.empty() ? "" : ", ") + known;
            }
            return refused("there is no member \"" + member + "\" here",
                           allowed.empty() ? "send no member" : "there may be: " + allowed);
        }
    }
    return {};
}

} // namespace linefeed::api
