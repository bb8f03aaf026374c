#include "client/service_text.hpp"

#include "cli/progress_view.hpp"
#include "client/printer_text.hpp"
#include "client/table.hpp"

namespace linefeed::client {

namespace {

Colour colour_of_kind(const std::string& kind) {
    for (const char* bad : {"printer.error", "job.in_doubt", "storage.failed", "folder.failed", "folder.down"}) {
        if (kind == bad) {
            return Colour::bad;
        }
    }
    for (const char* warning : {"printer.warning", "job.stopped", "service.reload_refused", "service.stopping"}) {
        if (kind == warning) {
            return Colour::warning;
        }
    }
    return kind == "job.finished" || kind == "job.printing" ? Colour::good : Colour::none;
}

} // namespace

std::string status_text(const Json& status, const Screen& screen) {
    Facts facts;
    facts.add("linefeed", {text(status, "version"), Colour::strong});
    facts.add("up since", {local_time(status, "started_ns")});
    facts.add("real time", {text(status, "real_time")});
    const bool ready = flag(status, "ready");
    facts.add("state", {ready ? "ready" : "not ready", ready ? Colour::good : Colour::bad});
    Json unwell = Json::array();
    for (const Json& check : items(status, "checks")) {
        if (text(check, "severity") != "ok") {
            unwell.push_back(check);
        }
    }
    return facts.text(screen) + (unwell.empty() ? "" : findings_text(unwell, screen));
}

std::string event_text(const Json& event, const Screen& screen) {
    const std::string kind = text(event, "kind");
    std::string about = text(event, "printer");
    const auto add = [&](const std::string& words) { about += (about.empty() ? "" : ", ") + words; };
    if (const auto job = whole(event, "job")) {
        add("job " + std::to_string(*job));
    }
    if (const auto record = whole(event, "record")) {
        add("record " + std::to_string(*record));
    }
    return local_time(event, "time_ns") + "  " + coloured(cli::printable(kind), colour_of_kind(kind), screen) +
           (about.empty() ? "" : "  " + cli::printable(about)) + "  " + cli::printable(text(event, "message")) + '\n';
}

std::string audit_text(const std::vector<Json>& entries, const Screen& screen) {
    Table table{{{"TIME"}, {"WHO"}, {"WHAT"}, {""}, {"", false, false}, {"DETAIL", false, true}}};
    for (const Json& entry : entries) {
        const Json& detail = member(entry, "detail");
        const bool done = flag(entry, "done");
        table.add({{local_time(entry, "time_ns")},
                   {text(entry, "who")},
                   {text(entry, "what")},
                   {text(entry, "object")},
                   {done ? "done" : "refused", done ? Colour::none : Colour::warning},
                   {detail.is_null() ? "" : detail.dump(-1, ' ', false, Json::error_handler_t::replace)}});
    }
    return table.text(screen);
}

std::string folders_text(const std::vector<Json>& folders, const Screen& screen) {
    Table table{{{"FOLDER"},
                 {"STATE"},
                 {"PRINTER"},
                 {"LAYOUT"},
                 {"IMPORTED", true, false},
                 {"AGAIN", true, false},
                 {"FAILED", true, false},
                 {"PATH", false, true}}};
    std::string more;
    for (const Json& folder : folders) {
        const bool works = flag(folder, "works");
        const std::string name = cli::printable(text(folder, "name"));
        table.add({{text(folder, "name"), Colour::strong},
                   {works ? "works" : "does not work", works ? Colour::good : Colour::bad},
                   {text(folder, "printer")},
                   {text(folder, "layout")},
                   {number_text(folder, "imported")},
                   {number_text(folder, "duplicates")},
                   {number_text(folder, "failed"), number(folder, "failed") > 0 ? Colour::warning : Colour::none},
                   {text(folder, "path")}});
        if (const std::string message = text(folder, "message"); !message.empty()) {
            more += name + ": " + cli::printable(message) + '\n';
        }
        for (const Json& file : items(folder, "staying")) {
            more += name + ": " + cli::printable(text(file, "name")) +
                    " stays for now: " + cli::printable(text(file, "why")) + '\n';
        }
    }
    return table.text(screen) + more;
}

} // namespace linefeed::client
