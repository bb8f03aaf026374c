#include "client/watch_text.hpp"

#include "cli/progress_view.hpp"
#include "cli/wall_time.hpp"
#include "client/printer_text.hpp"
#include "client/service_text.hpp"
#include "client/table.hpp"

#include <algorithm>
#include <cstdio>

namespace linefeed::client {

namespace {

/// "52.1 % of 1000000, in doubt 3"
std::string progress_of(const WatchPicture& picture, const Json& printer) {
    const auto job = picture.jobs.find(whole(printer, "job").value_or(0));
    if (job == picture.jobs.end()) {
        return {};
    }
    const auto all = number(member(job->second, "records"), "count");
    if (all <= 0) {
        return {};
    }
    char percent[32];
    std::snprintf(percent, sizeof percent, "%.1f %%",
                  100.0 * static_cast<double>(number(job->second, "printed")) / static_cast<double>(all));
    return std::string{percent} + " of " + std::to_string(all);
}

std::string name_of_job(const WatchPicture& picture, const Json& printer) {
    const auto job = picture.jobs.find(whole(printer, "job").value_or(0));
    return job == picture.jobs.end() ? std::string{} : text(job->second, "name");
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

std::string table_of(const WatchPicture& picture, const Screen& screen) {
    Table table{{{"PRINTER"},
                 {"STATE"},
                 {"JOB", true, false},
                 {"PRINTED", true, false},
                 {"RATE", true, false},
                 {"FIFO", true, false},
                 {"FIFO LASTS", true, false},
                 {"DATA LEFT", true, false},
                 {"QUEUE", true, false},
                 {"NAME", false, true}}};
    for (const Json& printer : picture.printers) {
        const PrinterCells cells = printer_cells(printer);
        table.add({cells.name,
                   cells.state,
                   cells.job,
                   {progress_of(picture, printer)},
                   cells.rate,
                   cells.fifo,
                   cells.fifo_lasts,
                   cells.data_left,
                   cells.queue,
                   {name_of_job(picture, printer)}});
    }
    return table.text(screen);
}

} // namespace

std::string watch_text(const WatchPicture& picture, const Screen& screen) {
    const std::size_t columns = screen.columns.value_or(80);
    std::vector<std::string> lines{coloured(cut("linefeed at " + cli::printable(picture.service) + "   " +
                                                    cli::format_local_time(picture.now_ns) + "   Ctrl-C ends the view",
                                                columns),
                                            Colour::strong, screen)};
    if (!picture.trouble.empty()) {
        lines.push_back(coloured(cut(cli::printable(picture.trouble), columns), Colour::bad, screen));
    }
    lines.emplace_back();
    for (std::string& line : lines_of(table_of(picture, screen))) {
        lines.push_back(std::move(line));
    }
    for (const Json& printer : picture.printers) {
        for (const std::string& trouble : printer_trouble(printer)) {
            lines.push_back(
                coloured(cut(cli::printable(text(printer, "name")) + ": " + trouble, columns), Colour::bad, screen));
        }
    }
    lines.emplace_back();
    const Screen plain{.colours = false, .columns = screen.columns, .rows = screen.rows};
    const std::size_t room = screen.rows > lines.size() ? screen.rows - lines.size() : 0;
    const std::size_t shown = std::min(room, picture.events.size());
    for (auto event = picture.events.end() - static_cast<std::ptrdiff_t>(shown); event != picture.events.end();
         ++event) {
        std::string line = event_text(*event, plain);
        line.pop_back();
        lines.push_back(cut(line, columns));
    }
    lines.resize(std::min(lines.size(), screen.rows));
    std::string all;
    for (const std::string& line : lines) {
        all += (all.empty() ? "" : "\n") + line;
    }
    return all;
}

std::vector<std::string> watch_lines(const WatchPicture& picture) {
    std::vector<std::string> lines;
    for (const Json& printer : picture.printers) {
        const std::string progress = progress_of(picture, printer);
        lines.push_back(printer_line(printer) + (progress.empty() ? "" : ", printed " + progress));
    }
    return lines;
}

Json watch_json(const WatchPicture& picture) {
    Json jobs = Json::array();
    for (const auto& [id, job] : picture.jobs) {
        jobs.push_back(job);
    }
    return {{"time_ns", picture.now_ns}, {"printers", picture.printers}, {"jobs", std::move(jobs)}};
}

} // namespace linefeed::client
