#include "printer/message_json.hpp"

#include "printer/printer_path.hpp"

#include <algorithm>

namespace linefeed::printer {

using protocol::printable;

namespace {

/// What is not a row of fields.
struct SpecialFields {
    Json operator()(const protocol::JobCounters& message) const {
        Json counters = Json::array();
        for (std::size_t i = 0; i < message.counters.size(); ++i) {
            counters.push_back({{"counter", i + 1},
                                {"value", message.counters[i].value},
                                {"done_repetitions", message.counters[i].done_repetitions}});
        }
        return {{"counters", std::move(counters)}};
    }
    Json operator()(const protocol::CounterReset& message) const {
        return {{"counter", message.counter}, {"start", message.start ? Json{*message.start} : Json{}}};
    }
    Json operator()(const protocol::ExternText& message) const {
        return {{"text", printable(path_text(message.text))}};
    }
    Json operator()(const protocol::WysiwygLine& message) const { return {{"bytes", message.bytes.size()}}; }
    Json operator()(const protocol::MailRecord& message) const {
        Json fields = Json::array();
        for (const std::string& field : message.fields) {
            fields.push_back(printable(field));
        }
        Json json{{"number", message.number.value()}, {"fields", std::move(fields)}};
        if (!message.properties.empty()) {
            std::string properties;
            append_properties(properties, message.properties);
            json["properties"] = properties;
        }
        return json;
    }
    Json operator()(const protocol::ErrorListBlock& message) const {
        Json errors = Json::array();
        for (const protocol::ErrorEntry& entry : message.entries) {
            errors.push_back(listed_error_json(entry));
        }
        return {{"first", message.first}, {"total", message.total}, {"errors", std::move(errors)}};
    }
    Json operator()(const protocol::EventListBlock& message) const {
        Json events = Json::array();
        for (const protocol::EventEntry& entry : message.entries) {
            events.push_back(event_json(entry));
        }
        return {{"first", message.first}, {"total", message.total}, {"events", std::move(events)}};
    }
    Json operator()(const protocol::ScriptLine& message) const { return {{"line", printable(message.text)}}; }
    Json operator()(const protocol::DirectoryBlock& message) const {
        Json entries = Json::array();
        for (const protocol::DirectoryEntry& entry : message.entries) {
            entries.push_back({{"name", printable(entry.name)}, {"directory", entry.is_directory}});
        }
        return {{"last", message.last}, {"entries", std::move(entries)}};
    }
    Json operator()(const protocol::FileBlock& message) const {
        return {{"block", message.number}, {"bytes", message.bytes.size()}, {"intact", message.intact()}};
    }
    Json operator()(const protocol::InquiryMessage& message) const {
        return message.argument.empty() ? Json::object() : Json{{"argument", printable(message.argument)}};
    }
    Json operator()(const protocol::ActionMessage& /*message*/) const { return Json::object(); }
    Json operator()(const protocol::UnknownMessage& message) const {
        return {{"payload", escaped_bytes(message.payload)}};
    }
    Json operator()(const protocol::MalformedMessage& message) const {
        return {{"problem", printable(message.reason)}, {"payload", escaped_bytes(message.payload)}};
    }
};

/// The values of `json` as "name value, name value".
void append_words(std::string& words, const Json& json) {
    for (const auto& [key, value] : json.items()) {
        if (key.ends_with("_code") || value.is_null()) {
            continue;
        }
        std::string name = key;
        std::ranges::replace(name, '_', ' ');
        words += (words.empty() ? "" : ", ") + name + ' ';
        if (value.is_boolean()) {
            words += value.get<bool>() ? "yes" : "no";
        } else if (value.is_string()) {
            words += value.get<std::string>();
        } else if (value.is_array()) {
            words += value.empty() ? "none" : value.front().is_string() ? value.dump() : std::to_string(value.size());
        } else if (value.is_object()) {
            words += value.contains("words") ? value["words"].get<std::string>() : value.dump();
        } else {
            words += value.dump();
        }
    }
}

/// What a message is about, as the command table says it.
struct Subject {
    std::string operator()(const protocol::ActionMessage& action) const { return words(action.action); }
    std::string operator()(const protocol::InquiryMessage& inquiry) const { return words(inquiry.parameter) + '?'; }
    std::string operator()(const protocol::ScriptLine& line) const {
        return line.is_begin() ? "a script begins" : line.is_end() ? "a script ends" : "script";
    }
    std::string operator()(const protocol::UnknownMessage& /*message*/) const { return "unknown command"; }
    std::string operator()(const protocol::MalformedMessage& /*message*/) const { return "not readable"; }
    std::string operator()(const protocol::MailRecord& /*message*/) const { return words(protocol::Parameter::MR); }
    std::string operator()(const protocol::FileBlock& /*message*/) const { return words(protocol::FileCommand::FT); }
    std::string operator()(const protocol::DirectoryBlock& /*message*/) const {
        return words(protocol::FileCommand::DI);
    }
    std::string operator()(const protocol::JobCounters& /*message*/) const { return words(protocol::Parameter::AC); }
    std::string operator()(const protocol::CounterReset& /*message*/) const { return words(protocol::Parameter::RC); }
    std::string operator()(const protocol::ExternText& /*message*/) const { return words(protocol::Parameter::ET); }
    std::string operator()(const protocol::WysiwygLine& /*message*/) const { return words(protocol::Parameter::GW); }
    std::string operator()(const protocol::ErrorListBlock& block) const { return words(block.list); }
    std::string operator()(const protocol::EventListBlock& block) const { return words(block.list); }
    template <protocol::DescribedParameter T>
    std::string operator()(const T& /*message*/) const {
        return words(T::parameter);
    }
    template <protocol::DescribedFile T>
    std::string operator()(const T& /*message*/) const {
        return words(T::command);
    }

private:
    template <typename Command>
    static std::string words(Command command) {
        return std::string{protocol::description(command)};
    }
};

std::string what_of(const protocol::Message& message) {
    return std::visit(Subject{}, message);
}

/// The fields of every kind of message.
struct Fields {
    Json operator()(const protocol::MachineStatus& status) const {
        Json fields = fields_of<protocol::MachineStatus>(status);
        fields["error"] = to_json(status.error);
        return fields;
    }
    template <typename T>
    Json operator()(const T& message) const {
        if constexpr (protocol::DescribedMessage<T>) {
            return fields_of<T>(message);
        } else {
            return SpecialFields{}(message);
        }
    }
};

} // namespace

Json to_json(const protocol::PrinterError& error) {
    if (error.none()) {
        return nullptr;
    }
    return {{"code", error.code()},
            {"code_without_bit_24", error.code_without_bit_24()},
            {"raw", error.raw},
            {"words", describe(error)},
            {"switches_off", error.switches_off()}};
}

Json to_json(const protocol::PrinterTime& time) {
    return to_string(time);
}

Json listed_error_json(const protocol::ErrorEntry& entry) {
    return {{"time", to_json(entry.time)}, {"code", entry.error.code()}, {"raw", entry.error.raw}};
}

Json event_json(const protocol::EventEntry& entry) {
    return {{"time", to_json(entry.time)},
            {"compressor_pulses", entry.compressor_pulses},
            {"solvent_sips", entry.solvent_sips},
            {"ink_sips", entry.ink_sips},
            {"mixing_ratio", entry.mixing_ratio},
            {"pressure_mbar", entry.pressure_mbar},
            {"diaphragm_position", entry.diaphragm_position},
            {"fall_time_ms", entry.fall_time_ms},
            {"machine", std::string{to_string(entry.machine)}},
            {"machine_code", static_cast<std::uint32_t>(entry.machine)}};
}

Json fields_of(const protocol::Message& message) {
    return std::visit(Fields{}, message);
}

std::string command_of(const protocol::Message& message) {
    std::string bytes;
    protocol::append_any_message(bytes, message, protocol::EscapeMode::backslash);
    constexpr std::size_t group = 2; // behind `^0`
    if (bytes.size() <= group || std::holds_alternative<protocol::UnknownMessage>(message)) {
        return {};
    }
    return std::holds_alternative<protocol::ScriptLine>(message) ? "*" : bytes.substr(group, 3);
}

Json to_json(const protocol::Message& message) {
    return {{"command", printable(command_of(message))}, {"what", what_of(message)}, {"fields", fields_of(message)}};
}

std::string in_words(const protocol::Message& message) {
    std::string words;
    append_words(words, fields_of(message));
    return words.empty() ? what_of(message) : what_of(message) + ": " + words;
}

std::string escaped_bytes(std::string_view bytes) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string out;
    for (const char byte : bytes) {
        const auto value = static_cast<unsigned char>(byte);
        if (byte == '\t') {
            out += "\\t";
        } else if (byte == '\\') {
            out += "\\\\";
        } else if (value < 0x20 || value >= 0x7F) {
            out.append("\\x").push_back(digits[value >> 4U]);
            out.push_back(digits[value & 0xFU]);
        } else {
            out.push_back(byte);
        }
    }
    return out;
}

std::optional<std::string> unescaped_bytes(std::string_view text) {
    const auto digit = [](char c) -> int {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                      : -1;
    };
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\') {
            out.push_back(text[i]);
            continue;
        }
        const std::string_view rest = text.substr(i + 1);
        if (rest.starts_with('t') || rest.starts_with('\\')) {
            out.push_back(rest.front() == 't' ? '\t' : '\\');
            i += 1;
        } else if (rest.size() >= 3 && rest.front() == 'x' && digit(rest[1]) >= 0 && digit(rest[2]) >= 0) {
            out.push_back(static_cast<char>(digit(rest[1]) * 16 + digit(rest[2])));
            i += 3;
        } else {
            return std::nullopt;
        }
    }
    return out;
}

} // namespace linefeed::printer
