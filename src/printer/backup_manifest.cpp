#include "printer/backup_manifest.hpp"

#include "printer/json.hpp"
#include "printer/printer_path.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace linefeed::printer {

namespace {

constexpr int format = 1;
constexpr std::size_t sha256_digits = 64;

Failure wrong(const std::string& why) {
    return {FailureKind::input, "the manifest of the backup " + why};
}

Json head_json(const Manifest& manifest) {
    return {{"linefeed_backup", format},
            {"made", manifest.made},
            {"printer",
             {{"type", path_text(manifest.printer.type)},
              {"serial_number", path_text(manifest.printer.serial_number)},
              {"firmware", path_text(manifest.printer.firmware)}}},
            {"loaded_job", path_text(manifest.loaded_job)}};
}

Json file_json(const SavedFile& file) {
    Json json{{"path", path_text(file.path)}};
    if (!file.empty_or_unreadable()) {
        json["file"] = saved_as(file.path).string();
    } else {
        json["empty_or_unreadable"] = true;
    }
    json["size"] = file.size;
    json["sha256"] = file.sha256;
    return json;
}

std::string bytes_of(const std::string& text) {
    return path_bytes(text).value_or(text);
}

Result<Manifest> read_head(const Json& json) {
    const Json version = json.is_object() ? json.value("linefeed_backup", Json{}) : Json{};
    if (!version.is_number_integer()) {
        return wrong("is none");
    }
    if (version != format) {
        return wrong("has a format that this linefeed does not know: " + version.dump());
    }
    Manifest manifest;
    const Json printer = json.value("printer", Json::object());
    if (!printer.is_object()) {
        return wrong("names no printer");
    }
    const auto text = [](const Json& object, const char* name) {
        const Json value = object.value(name, Json{});
        return value.is_string() ? value.get<std::string>() : std::string{};
    };
    manifest.made = text(json, "made");
    manifest.printer = {bytes_of(text(printer, "type")), bytes_of(text(printer, "serial_number")),
                        bytes_of(text(printer, "firmware"))};
    manifest.loaded_job = bytes_of(text(json, "loaded_job"));
    return manifest;
}

Result<SavedFile> read_saved_file(const Json& json) {
    const Json path = json.is_object() ? json.value("path", Json{}) : Json{};
    const Json size = json.is_object() ? json.value("size", Json{}) : Json{};
    const Json sha256 = json.is_object() ? json.value("sha256", Json{}) : Json{};
    if (!path.is_string() || !size.is_number_unsigned() || !sha256.is_string() ||
        sha256.get<std::string>().size() != sha256_digits) {
        return wrong("has a file without path, size or sha256");
    }
    auto bytes = printer_file(path.get<std::string>(), protocol::EscapeMode::backslash);
    if (!bytes || !in_default_directory(*bytes)) {
        return wrong("has a file that lies in none of the printer's directories: " + path.get<std::string>());
    }
    return SavedFile{*std::move(bytes), size.get<std::uint64_t>(), sha256.get<std::string>()};
}

bool is_harmless(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == ' ';
}

} // namespace

std::string manifest_json(const Manifest& manifest) {
    constexpr int indent = 2;
    Json json = head_json(manifest);
    json["files"] = Json::array();
    for (const SavedFile& file : manifest.files) {
        json["files"].push_back(file_json(file));
    }
    return json.dump(indent) + '\n';
}

Result<Manifest> parse_manifest(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    auto manifest = read_head(json);
    if (!manifest) {
        return manifest;
    }
    const Json files = json.value("files", Json{});
    if (!files.is_array()) {
        return wrong("has no list of files");
    }
    std::set<std::string> paths;
    for (const Json& file : files) {
        auto saved = read_saved_file(file);
        if (!saved) {
            return saved.error();
        }
        if (!paths.insert(saved->path).second) {
            return wrong("has a file twice: " + path_text(saved->path));
        }
        manifest->files.push_back(*std::move(saved));
    }
    return manifest;
}

std::string partial_head(const Manifest& manifest) {
    return head_json(manifest).dump() + '\n';
}

std::string partial_line(const SavedFile& file) {
    return file_json(file).dump() + '\n';
}

Result<Manifest> parse_partial(std::string_view text) {
    const auto take_line = [&text]() -> std::optional<Json> {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) {
            return std::nullopt;
        }
        Json json = Json::parse(text.substr(0, end), nullptr, false);
        text.remove_prefix(end + 1);
        return json;
    };
    const auto head = take_line();
    auto manifest = head ? read_head(*head) : wrong("breaks off at its head");
    while (manifest) {
        const auto line = take_line();
        auto file = line ? read_saved_file(*line) : wrong("ends");
        if (!file) {
            break;
        }
        manifest->files.push_back(*std::move(file));
    }
    return manifest;
}

std::filesystem::path saved_as(std::string_view path) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string name = "files/";
    bool dots_allowed = false; // not in front
    for (const char c : path) {
        if (c == '\\') {
            name.push_back('/');
        } else if (is_harmless(c) || (c == '.' && dots_allowed)) {
            name.push_back(c);
        } else {
            const auto byte = static_cast<unsigned char>(c);
            name.append({'%', digits[byte >> 4U], digits[byte & 0xFU]});
        }
        dots_allowed = c != '\\';
    }
    return name;
}

} // namespace linefeed::printer
