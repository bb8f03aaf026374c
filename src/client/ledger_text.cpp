#include "client/ledger_text.hpp"

#include "base/assert.hpp"
#include "cli/progress_view.hpp"

#include <array>

namespace linefeed::client {

namespace {

constexpr std::array issued_states{"printed", "in_doubt", "skipped", "released", "unused", "open"};

std::int64_t count_of(const std::vector<Json>& history, std::string_view state) {
    std::int64_t count = 0;
    for (const Json& stretch : history) {
        count += text(stretch, "state") == state ? number(stretch, "count") : 0;
    }
    return count;
}

/// Neighbours with the same fate and run are one, whatever their evidence.
std::vector<Json> segments_of(const std::vector<Json>& history) {
    std::vector<Json> segments;
    for (const Json& stretch : history) {
        if (!segments.empty()) {
            Json& last = segments.back();
            if (text(last, "state") == text(stretch, "state") && number(last, "run") == number(stretch, "run") &&
                number(last, "last") + 1 == number(stretch, "first")) {
                last["last"] = number(stretch, "last");
                continue;
            }
        }
        segments.push_back({{"first", number(stretch, "first")},
                            {"last", number(stretch, "last")},
                            {"state", text(stretch, "state")},
                            {"run", number(stretch, "run")}});
    }
    return segments;
}

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    }
    return quoted + '"';
}

std::string joined(const Json& fields) {
    std::string all;
    bool first = true;
    for (const Json& field : fields) {
        all += (first ? "" : "\t") + (field.is_string() ? field.get<std::string>() : std::string{});
        first = false;
    }
    return all;
}

std::string evidence_of(const Json& stretch) {
    const Json& evidence = member(stretch, "evidence");
    return evidence.is_null() ? std::string{} : dump(evidence);
}

/// "5-9 and more", and how an operator settles it.
std::string doubt_line(const std::vector<Json>& history) {
    std::string first;
    bool more = false;
    for (const Json& stretch : history) {
        if (text(stretch, "state") == "in_doubt") {
            more = !first.empty();
            first = first.empty() ? range_text(stretch) : first;
        }
    }
    return "waiting for an operator: " + first + (more ? " and more" : "");
}

} // namespace

std::string ledger_text(const Json& job, const std::vector<Json>& history) {
    std::string out = "job " + number_text(job, "id") + ", " + cli::printable(text(job, "source")) + ", records " +
                      range_text(member(job, "records")) + '\n';
    std::int64_t issued = 0;
    std::string sum;
    for (const char* state : issued_states) {
        const std::int64_t count = count_of(history, state);
        issued += count;
        sum += (sum.empty() ? "" : " + ") + std::to_string(count) + ' ' + state;
    }
    out += "issued " + std::to_string(issued) + " = " + sum + '\n';
    for (const Json& segment : segments_of(history)) {
        out += "  " + number_text(segment, "first") + '-' + number_text(segment, "last") + "  " +
               cli::printable(text(segment, "state")) + "  (run " + number_text(segment, "run") + ")\n";
    }
    if (count_of(history, "in_doubt") > 0) {
        return out + doubt_line(history) +
               " (linefeed settle, or linefeed print, with --last-printed, --printed or "
               "--in-doubt)\n";
    }
    const std::string next = number_text(member(job, "next"), "first");
    return out + (next.empty() ? "nothing left to print\n" : "next to print: " + next + '\n');
}

Json ledger_json(const Json& job, const std::vector<Json>& history) {
    Json counts = Json::object();
    for (const char* state : issued_states) {
        counts[state] = count_of(history, state);
    }
    const Json& records = member(job, "records");
    return {{"job", number(job, "id")},        {"file", text(job, "source")}, {"first", number(records, "first")},
            {"last", number(records, "last")}, {"counts", std::move(counts)}, {"segments", segments_of(history)}};
}

std::string record_head(RecordFormat format) {
    return format == RecordFormat::csv ? "number,fields,state,not_before,not_after,run,evidence\r\n" : "";
}

std::string record_line(const Json& record, const Json& stretch, RecordFormat format) {
    const Json& fields = items(record, "fields");
    const std::string number = number_text(record, "number");
    const std::string state = text(stretch, "state");
    const std::string run = number_text(stretch, "run");
    switch (format) {
    case RecordFormat::table:
        return number + "  " + cli::printable(state) + "  " + local_time(stretch, "not_after_ns") + "  run " + run +
               "  " + cli::printable(joined(fields)) + "  " + cli::printable(evidence_of(stretch)) + '\n';
    case RecordFormat::csv:
        return number + ',' + csv_field(joined(fields)) + ',' + state + ',' + text(stretch, "not_before") + ',' +
               text(stretch, "not_after") + ',' + run + ',' + csv_field(evidence_of(stretch)) + "\r\n";
    case RecordFormat::json:
        return dump({{"number", member(record, "number")},
                     {"fields", fields},
                     {"state", state},
                     {"not_before", text(stretch, "not_before")},
                     {"not_after", text(stretch, "not_after")},
                     {"run", client::number(stretch, "run")},
                     {"evidence", member(stretch, "evidence")}}) +
               '\n';
    }
    assertion_failed("RecordFormat", __FILE__, __LINE__);
}

} // namespace linefeed::client
