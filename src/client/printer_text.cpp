#include "client/printer_text.hpp"

#include "cli/progress_view.hpp"
#include "cli/wall_time.hpp"

#include <array>
#include <cstdio>

namespace linefeed::client {

namespace {

Cell state_of(const Json& printer) {
    const std::string link = text(printer, "link");
    const std::string phase = text(printer, "phase");
    if (!member(printer, "error").is_null()) {
        return {phase == "idle" ? "error" : phase + ", error", Colour::bad};
    }
    if (phase == "idle") {
        const bool held = flag(printer, "held"); // stopped, and no queue starts by itself
        const std::string rest = held ? "stopped" : phase;
        if (flag(printer, "watched") && link == "down") { // otherwise there is no link between jobs
            return {rest + ", no link", Colour::bad};
        }
        if (flag(printer, "cover_open")) {
            return {rest + ", cover open", Colour::warning};
        }
        return held ? Cell{rest, Colour::warning} : Cell{rest};
    }
    return link == "up" ? Cell{phase, Colour::good} : Cell{phase + ", no link", Colour::bad};
}

/// What a probe has found that is not the same for every printer.
std::string habits_of(const Json& probe) {
    struct Habit {
        const char* key;
        const char* yes; ///< nullptr = goes without saying
        const char* no;
    };
    constexpr std::array habits{Habit{"keeps_stop_at", "keeps its stop point", "does not keep a stop point"},
                                Habit{"mailing_counts_print_gos", "counts PrintGos", nullptr},
                                Habit{"status_tells_job_changes", nullptr, "does not tell job changes"},
                                Habit{"total_counter", nullptr, "no total counter"},
                                Habit{"tank_levels", "tells tank levels", nullptr},
                                Habit{"doubled_backslashes", "doubles backslashes", nullptr},
                                Habit{"lengths_on", "lengths are on", nullptr},
                                Habit{"echo_on", "echo is on", nullptr},
                                Habit{"filled_blocks_on", "blocks are filled", nullptr}};
    std::string words;
    for (const Habit& habit : habits) {
        const Json& found = member(probe, habit.key);
        const char* const word = !found.is_boolean() ? nullptr : found.get<bool>() ? habit.yes : habit.no;
        words += word == nullptr ? std::string{} : (words.empty() ? "" : ", ") + std::string{word};
    }
    return words;
}

/// The queue behind the job that is on the line.
std::vector<Json> waiting_jobs(const Json& printer) {
    std::vector<Json> waiting;
    for (const Json& job : items(printer, "queue")) {
        if (job != member(printer, "job")) {
            waiting.push_back(job);
        }
    }
    return waiting;
}

std::string rate_of(const Json& figures) {
    const double rate = real(figures, "rate_per_s").value_or(0);
    if (rate <= 0) {
        return {};
    }
    char text[32];
    std::snprintf(text, sizeof text, "%.*f/s", rate < 10 ? 1 : 0, rate);
    return text;
}

std::string fifo_of(const Json& figures) {
    const auto depth = number(figures, "fifo_depth");
    return depth == 0 ? std::string{} : number_text(figures, "fifo_entries") + " of " + std::to_string(depth);
}

std::string time_of(const Json& figures, std::string_view name) {
    const auto seconds = real(figures, name);
    if (!seconds) {
        return {};
    }
    if (*seconds >= 10) {
        return cli::format_duration(*seconds);
    }
    char text[32];
    std::snprintf(text, sizeof text, *seconds < 1 ? "%.0f ms" : "%.1f s", *seconds < 1 ? *seconds * 1000 : *seconds);
    return text;
}

std::string error_line(const Json& error) {
    std::string line = "error " + text(error, "words"); // which begin with its number
    for (const char* more : {"meaning", "advice"}) {
        if (const std::string words = text(error, more); line.find(words) == std::string::npos) { // not said already
            line += "; " + words;
        }
    }
    return line;
}

Colour colour_of(const std::string& severity) {
    return severity == "ok" ? Colour::good : severity == "warning" ? Colour::warning : Colour::bad;
}

} // namespace

PrinterCells printer_cells(const Json& printer) {
    const Json& figures = member(printer, "figures");
    const std::size_t queue = waiting_jobs(printer).size();
    return {.name = {text(printer, "name"), Colour::strong},
            .state = state_of(printer),
            .job = {number_text(printer, "job")},
            .queue = {queue == 0 ? "" : std::to_string(queue)},
            .rate = {rate_of(figures)},
            .fifo = {fifo_of(figures)},
            .fifo_lasts = {time_of(figures, "time_to_empty_s")},
            .data_left = {time_of(figures, "data_left_s")}};
}

std::vector<std::string> printer_trouble(const Json& printer) {
    std::vector<std::string> lines;
    if (const Json& error = member(printer, "error"); !error.is_null()) {
        lines.push_back(cli::printable(error_line(error)));
    }
    for (const Json& warning : items(printer, "warnings")) {
        lines.push_back(cli::printable(warning.is_string() ? warning.get<std::string>() : std::string{}));
    }
    return lines;
}

std::string printers_text(const std::vector<Json>& printers, const Screen& screen) {
    Table table{{{"PRINTER"},
                 {"STATE"},
                 {"JOB", true, false},
                 {"QUEUE", true, false},
                 {"RATE", true, false},
                 {"FIFO", true, false},
                 {"DATA LEFT", true, false},
                 {"ADDRESS", false, true}}};
    std::string trouble;
    for (const Json& printer : printers) {
        const PrinterCells cells = printer_cells(printer);
        table.add({cells.name,
                   cells.state,
                   cells.job,
                   cells.queue,
                   cells.rate,
                   cells.fifo,
                   cells.data_left,
                   {text(printer, "address")}});
        for (const std::string& line : printer_trouble(printer)) {
            trouble += cli::printable(text(printer, "name")) + ": " + line + '\n';
        }
    }
    return table.text(screen) + trouble;
}

std::string printer_text(const Json& printer, const Screen& screen) {
    const Json& figures = member(printer, "figures");
    std::string queue;
    for (const Json& job : waiting_jobs(printer)) {
        queue += (queue.empty() ? "" : ", ") + job.dump();
    }
    Facts facts;
    facts.add("printer", {text(printer, "name"), Colour::strong});
    facts.add("address", {text(printer, "address")});
    facts.add("profile", {text(printer, "profile")});
    facts.add("state", state_of(printer));
    facts.add("link", {text(printer, "link")});
    facts.add("last heard", {local_time(printer, "heard_ns")});
    facts.add("machine", {text(printer, "machine")});
    facts.add("nozzle", {text(printer, "nozzle")});
    facts.add("head cover", {flag(printer, "cover_open") ? "open" : "", Colour::warning});
    facts.add("serial number", {text(printer, "serial_number")});
    const std::string known = text(printer, "known_serial_number");
    facts.add("known as", {known == text(printer, "serial_number") ? "" : known, Colour::warning});
    facts.add("firmware", {text(printer, "firmware")});
    if (const Json& probe = member(printer, "probe"); probe.is_object()) {
        facts.add("probed", {local_time(printer, "probed_ns") + ": " + habits_of(probe)});
    }
    facts.add("total prints", {number_text(printer, "total_prints")});
    facts.add("panel", {flag(printer, "panel_suspended") ? "suspended by linefeed" : "", Colour::warning});
    facts.add("job", {number_text(printer, "job")});
    facts.add("queue", {queue});
    facts.add("starts by itself", {flag(printer, "autostart") ? "yes" : "no"});
    facts.add("rate", {rate_of(figures)});
    facts.add("FIFO", {fifo_of(figures)});
    facts.add("credit", {number(figures, "fifo_depth") == 0 ? "" : number_text(figures, "credit")});
    facts.add("lead time", {time_of(figures, "lead_time_s")});
    facts.add("FIFO lasts", {time_of(figures, "time_to_empty_s")});
    facts.add("data left", {time_of(figures, "data_left_s")});
    for (const std::string& line : printer_trouble(printer)) {
        facts.add("attention", {line, Colour::bad});
    }
    return facts.text(screen);
}

std::string printer_line(const Json& printer) {
    const Json& figures = member(printer, "figures");
    std::string line = text(printer, "name") + ": " + state_of(printer).text;
    if (const auto job = whole(printer, "job")) {
        line += ", job " + std::to_string(*job);
    }
    if (const std::string rate = rate_of(figures); !rate.empty()) {
        line += ", " + rate;
    }
    if (const std::string fifo = fifo_of(figures); !fifo.empty()) {
        line += ", FIFO " + fifo;
    }
    if (const std::string left = time_of(figures, "data_left_s"); !left.empty()) {
        line += ", " + left + " left";
    }
    line = cli::printable(line);
    for (const std::string& trouble : printer_trouble(printer)) {
        line += "; " + trouble;
    }
    return line;
}

std::string frames_text(const std::vector<Json>& frames, const Screen& screen) {
    Table table{{{"TIME"}, {"", false, false}, {"BYTES", true, false}, {"FRAME", false, true}}};
    for (const Json& frame : frames) {
        const bool sent = text(frame, "direction") == "sent";
        table.add({{cli::format_local_clock(number(frame, "time_ns"))},
                   {sent ? "->" : "<-", sent ? Colour::none : Colour::good},
                   {number_text(frame, "size")},
                   {text(frame, "text")}});
    }
    return table.text(screen);
}

std::string findings_text(const Json& findings, const Screen& screen) {
    Table table{{{"", false, false}, {"", false, false}, {"", false, false}}};
    for (const Json& finding : findings) {
        const std::string severity = text(finding, "severity");
        table.add({{severity, colour_of(severity)}, {text(finding, "check")}, {text(finding, "words")}});
        if (const std::string advice = text(finding, "advice"); !advice.empty()) {
            table.add({{""}, {""}, {"-> " + advice, colour_of(severity)}});
        }
    }
    return table.text(screen);
}

} // namespace linefeed::client
