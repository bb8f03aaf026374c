#include "client/job_text.hpp"

#include "cli/progress_view.hpp"
#include "client/table.hpp"

#include <algorithm>

namespace linefeed::client {

namespace {

Colour colour_of(const std::string& phase) {
    if (phase == "printing" || phase == "arming") {
        return Colour::good;
    }
    if (phase == "in_doubt" || phase == "failed") {
        return Colour::bad;
    }
    if (phase == "stopped" || phase == "stopping") {
        return Colour::warning;
    }
    return phase == "finished" || phase == "cancelled" ? Colour::faint : Colour::none;
}

Cell phase_cell(const Json& job) {
    std::string phase = text(job, "phase");
    const Colour colour = colour_of(phase);
    std::replace(phase.begin(), phase.end(), '_', ' ');
    return {std::move(phase), colour};
}

std::string of_records(const Json& job) {
    const Json& records = member(job, "records");
    return number_text(job, "printed") + " of " + std::to_string(number(records, "count"));
}

/// Nothing for 0.
std::string some(const Json& job, std::string_view name) {
    return number(job, name) == 0 ? std::string{} : number_text(job, name);
}

std::string joined_fields(const Json& record) {
    std::string fields;
    for (const Json& field : items(record, "fields")) {
        fields += (fields.empty() ? "" : " | ") + (field.is_string() ? field.get<std::string>() : std::string{});
    }
    return fields;
}

} // namespace

std::string jobs_text(const std::vector<Json>& jobs, const Screen& screen) {
    const bool doubt =
        std::any_of(jobs.begin(), jobs.end(), [](const Json& job) { return number(job, "in_doubt") > 0; });
    std::vector<Column> columns{{"JOB", true, false}, {"STATE"}, {"PRINTER"}, {"PRINTED", true, false}};
    if (doubt) {
        columns.push_back({"IN DOUBT", true, false});
    }
    columns.insert(columns.end(), {{"CREATED"}, {"NAME", false, true}, {"", false, true}});
    Table table{columns};
    for (const Json& job : jobs) {
        std::vector<Cell> row{{number_text(job, "id")}, phase_cell(job), {text(job, "printer")}, {of_records(job)}};
        if (doubt) {
            row.push_back({some(job, "in_doubt"), Colour::bad});
        }
        const auto place = whole(job, "place");
        row.push_back({local_time(job, "created_ns")});
        row.push_back({text(job, "name")});
        row.push_back({place ? "place " + std::to_string(*place) + " in the queue" : text(job, "message")});
        table.add(std::move(row));
    }
    return table.text(screen);
}

std::string job_text(const Json& job, const Screen& screen) {
    Facts facts;
    facts.add("job", {number_text(job, "id"), Colour::strong});
    facts.add("name", {text(job, "name")});
    facts.add("source", {text(job, "source")});
    facts.add("state", phase_cell(job));
    facts.add("", {text(job, "message")});
    facts.add("printer", {text(job, "printer")});
    facts.add("place in queue", {number_text(job, "place")});
    facts.add("starts by itself", {flag(job, "autostart") ? "yes, if the printer's queue does so" : ""});
    facts.add("layout", {text(job, "layout")});
    facts.add("records", {range_text(member(job, "records"))});
    facts.add("printed", {of_records(job)});
    facts.add("last printed", {number_text(job, "last_printed")});
    facts.add("next to print", {range_text(member(job, "next"))});
    facts.add("in doubt", {some(job, "in_doubt"), Colour::bad});
    facts.add("fate open", {some(job, "open"), Colour::warning});
    facts.add("skipped", {some(job, "skipped")});
    facts.add("created", {local_time(job, "created_ns") + " by " + text(job, "created_by")});
    return facts.text(screen);
}

std::string job_line(const Json& job) {
    std::string line = "job " + number_text(job, "id") + " (" + text(job, "name") + "): " + phase_cell(job).text +
                       ", " + of_records(job) + " records printed";
    if (number(job, "in_doubt") > 0) {
        line += ", " + number_text(job, "in_doubt") + " in doubt";
    }
    if (const auto next = whole(member(job, "next"), "first")) {
        line += ", next " + std::to_string(*next);
    }
    if (const std::string message = text(job, "message"); !message.empty()) {
        line += "; " + message;
    }
    return cli::printable(line);
}

std::string doubt_text(const Json& doubt, std::int64_t job, const Screen& screen) {
    const Json& records = items(doubt, "records");
    const std::int64_t count = number(doubt, "count");
    if (count == 0) {
        return "job " + std::to_string(job) + " has no record in doubt\n";
    }
    Table table{{{"IN DOUBT", true, false}, {"WHAT IS ON IT", false, true}}};
    for (const Json& record : records) {
        table.add({{number_text(record, "number")}, {joined_fields(record)}});
    }
    std::string out = table.text(screen);
    if (const auto shown = static_cast<std::int64_t>(records.size()); shown < count) {
        out += "and " + std::to_string(count - shown) + " more: linefeed ledger " + std::to_string(job) + '\n';
    }
    const std::string settle = "linefeed settle " + std::to_string(job);
    if (const std::string hole = text(doubt, "hole"); !hole.empty()) {
        return out + "the last product does not tell which of them are printed: " + cli::printable(hole) +
               "\nto go on: look which of these records are on products: " + settle +
               " --printed N-M,N (or none); or " + settle + " --in-doubt skip or reprint\n";
    }
    return out + "to go on: look at the last product: " + settle + " --last-printed NUMBER (or its text); or " +
           settle + " --in-doubt skip or reprint\n";
}

} // namespace linefeed::client
