// The printer's files, its job, and what the product will look like, as tasks. Contents of files do not go as JSON: see
// file_transfer.hpp.
#include "printer/exchange.hpp"
#include "printer/file_transfer.hpp"
#include "printer/job_commands.hpp"
#include "printer/picture.hpp"
#include "printer/printer_path.hpp"
#include "printer/tasks.hpp"
#include "protocol/printable.hpp"

#include <array>

namespace linefeed::printer {

using protocol::DirectoryEntry;
using protocol::Group;
using protocol::Parameter;

namespace {

constexpr CommandId asks(std::string_view code) {
    return {Group::inquiry, code};
}
constexpr CommandId transfers(std::string_view code) {
    return {Group::parameter, code};
}
constexpr CommandId file(std::string_view code) {
    return {Group::file, code};
}

std::string shown(std::string_view bytes) {
    return protocol::printable(path_text(bytes));
}

Json entries_json(const std::vector<DirectoryEntry>& entries) {
    Json json = Json::array();
    for (const DirectoryEntry& entry : entries) {
        json.push_back({{"name", shown(entry.name)}, {"directory", entry.is_directory}});
    }
    return json;
}

/// Those of the default directories that the printer has.
Result<std::vector<DirectoryEntry>> present_directories(PrinterClient& printer) {
    std::vector<DirectoryEntry> present;
    for (const std::string_view directory : default_directories) {
        const auto there = list_files(printer, std::string{directory});
        if (!there) {
            return there.error();
        }
        if (!there->empty()) {
            present.push_back({std::string{directory}, true});
        }
    }
    return present;
}

Result<std::vector<DirectoryEntry>> entries_at(PrinterClient& printer, const std::string& path) {
    auto there = list_files(printer, path);
    if (!there) {
        return there;
    }
    if (there->empty()) {
        return Failure{FailureKind::input, path_text(path) + ": there is no such file or directory"};
    }
    const bool jokers = path.find_first_of("*?") != std::string::npos;
    return !jokers && there->front().is_directory ? list_directory(printer, path) : there;
}

Result<Json> list(PrinterClient& printer, const Order& order) {
    if (!order.arguments.has("path")) {
        const auto present = present_directories(printer);
        return present ? json_result({{"path", ""}, {"entries", entries_json(*present)}}) : present.error();
    }
    const auto path = printer_path(order.arguments.text("path"), printer.settings().profile.escapes);
    if (!path) {
        return path.error();
    }
    const auto entries = entries_at(printer, *path);
    return entries ? json_result({{"path", shown(*path)}, {"entries", entries_json(*entries)}}) : entries.error();
}

Result<Json> remove(PrinterClient& printer, const Order& order) {
    const auto path = printer_file(order.arguments.text("path"), printer.settings().profile.escapes);
    if (!path) {
        return path.error();
    }
    const auto removed = remove_file(printer, *path);
    return removed ? json_result({{"deleted", shown(*path)}}) : removed.error();
}

Result<Json> jobs(PrinterClient& printer, const Order& /*order*/) {
    Json paths = Json::array();
    for (const std::string_view directory : default_directories) {
        if (!directory.ends_with("\\Jobs")) {
            continue;
        }
        const auto there = list_files(printer, std::string{directory});
        const auto entries = there && !there->empty() ? list_directory(printer, std::string{directory}) : there;
        if (!entries) {
            return entries.error();
        }
        for (const DirectoryEntry& entry : *entries) {
            if (!entry.is_directory) {
                paths.push_back(shown(std::string{directory} + '\\' + entry.name));
            }
        }
    }
    const auto loaded = printer.ask<protocol::JobName>(Parameter::JL);
    return json_result({{"loaded", loaded ? Json(shown(loaded->path)) : Json{}}, {"jobs", std::move(paths)}});
}

Result<Json> load(PrinterClient& printer, const Order& order) {
    const auto path = printer_job(order.arguments.text("job"), printer.settings().profile.escapes);
    if (!path) {
        return path.error();
    }
    const auto loaded = load_job(printer, *path);
    return loaded ? json_result({{"loaded", shown(*loaded)}}) : loaded.error();
}

Result<Json> get_script(PrinterClient& printer, const Order& /*order*/) {
    const auto lines = read_script(printer);
    if (!lines) {
        return lines.error();
    }
    Json json = Json::array();
    for (const std::string& line : *lines) {
        json.push_back(path_text(line));
    }
    return json_result({{"lines", std::move(json)}});
}

Result<Json> put_script(PrinterClient& printer, const Order& order) {
    const auto bytes = path_bytes(order.arguments.text("script"));
    if (!bytes) {
        return Failure{FailureKind::input, "the script has a character that Windows-1252 does not have"};
    }
    const auto lines = script_lines(*bytes, printer.settings().profile.escapes);
    if (!lines) {
        return lines.error();
    }
    const auto sent = send_script(printer, *lines);
    return sent ? json_result({{"loaded", shown(sent->job)},
                               {"lines", lines->size()},
                               {"reads_back_alike", sent->reads_back_alike}})
                : sent.error();
}

Result<Json> preview(PrinterClient& printer, const Order& /*order*/) {
    const auto picture = ask_picture(printer);
    if (!picture) {
        return picture.error();
    }
    Json rows = Json::array();
    for (std::uint32_t y = 0; y < picture->height; ++y) {
        std::string row;
        for (std::uint32_t x = 0; x < picture->width; ++x) {
            row.push_back(picture->dot(x, y) ? '#' : '.');
        }
        rows.push_back(std::move(row));
    }
    return json_result({{"width", picture->width},
                        {"height", picture->height},
                        {"job_id", picture->job_id},
                        {"rows", std::move(rows)}});
}

constexpr std::array list_uses{file("RD"), file("DI")};
constexpr std::array remove_uses{file("DF"), file("RD"), file("DI")};
constexpr std::array jobs_uses{file("RD"), file("DI"), asks("JL"), transfers("JL")};
constexpr std::array load_uses{transfers("JL"), asks("JL"), file("RD"), file("DI"), asks("RS"), transfers("RS")};
constexpr std::array get_script_uses{asks("JB"), CommandId{Group::script, "BEGINLJSCRIPT"},
                                     CommandId{Group::script, ""}, CommandId{Group::script, "ENDLJSCRIPT"}};
constexpr std::array put_script_uses{CommandId{Group::script, "BEGINLJSCRIPT"}, CommandId{Group::script, ""},
                                     CommandId{Group::script, "ENDLJSCRIPT"}, asks("JB"), asks("JL")};
constexpr std::array preview_uses{asks("GW"),
                                  transfers("GW"),
                                  transfers("SW"),
                                  CommandId{Group::action, "EN"},
                                  CommandId{Group::action, "W1"},
                                  CommandId{Group::action, "W0"}};

constexpr std::array list_arguments{
    Argument{.name = "path", .help = "Path in the printer, * as joker; default: its directories", .positional = true}};
constexpr std::array remove_arguments{
    Argument{.name = "path", .help = "Path in the printer", .required = true, .positional = true}};
constexpr std::array load_arguments{Argument{
    .name = "job", .help = "Path of the job; a name alone is one in the flash", .required = true, .positional = true}};
constexpr std::array put_script_arguments{
    Argument{.name = "script", .help = "The lines of the script", .required = true, .positional = true}};

constexpr std::array all{
    Task{"files ls", Task::Kind::look, "List files of the printer", list_uses, list_arguments, list},
    Task{"files rm", Task::Kind::change, "Delete a file of the printer", remove_uses, remove_arguments, remove},
    Task{"jobs", Task::Kind::look, "Jobs in the printer, and which one is loaded", jobs_uses, {}, jobs},
    Task{"load", Task::Kind::change, "Load a job and read back whether it is", load_uses, load_arguments, load},
    Task{"script get", Task::Kind::look, "The current job as a script", get_script_uses, {}, get_script},
    Task{"script send", Task::Kind::change, "Send a script, which replaces the current job", put_script_uses,
         put_script_arguments, put_script},
    Task{"preview", Task::Kind::look, "What the product will look like, dot by dot", preview_uses, {}, preview},
};

} // namespace

std::span<const Task> file_tasks() {
    return all;
}

} // namespace linefeed::printer
