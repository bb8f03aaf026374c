#include "client/job_text.hpp"
#include "client/printer_commands.hpp"

#include <future>
#include <limits>

namespace linefeed::client {

namespace {

/// Those that print something, or are about to; of a single printer, that one.
Result<std::vector<std::string>> printers_to_stop(Service& service, const StopOptions& options) {
    if (!options.printer.empty()) {
        return std::vector{options.printer}; // nothing is asked before: it may be urgent
    }
    const auto printers = service.list("/api/v1/printers", std::numeric_limits<std::size_t>::max());
    if (!printers) {
        return printers.error();
    }
    std::vector<std::string> busy;
    std::string names;
    for (const Json& printer : *printers) {
        if (printers->size() == 1 || text(printer, "phase") != "idle") {
            busy.push_back(text(printer, "name"));
            names += (names.empty() ? "" : ", ") + busy.back();
        }
    }
    if (busy.size() > 1 && !options.all) {
        return Failure{FailureKind::usage, "several printers are printing: name one of " + names + ", or say --all"};
    }
    return busy;
}

/// The jobs of a printer that stand now and could go on.
Result<std::vector<Json>> standing_jobs(Service& service, const std::string& printer) {
    constexpr std::size_t most = 10;
    return service.list("/api/v1/jobs?printer=" + api::url_encoded(printer) + "&phase=stopped,in_doubt&limit=10", most);
}

/// Stops all at the same time, and waits for each: no line goes on because another one's printer does not answer.
std::vector<Result<Json>> stop_each(const Service& service, const std::vector<std::string>& printers) {
    std::vector<std::future<Result<Json>>> stops;
    for (const std::string& printer : printers) {
        stops.push_back(std::async(std::launch::async, [&service, &printer] {
            return service.again().post_at_once(printer_path(printer, "/stop"));
        }));
    }
    std::vector<Result<Json>> answers;
    for (auto& answer : stops) {
        answers.push_back(answer.get());
    }
    return answers;
}

void show_stopped(const Json& stopped) {
    for (const Json& printer : stopped) {
        show(text(printer, "printer") + ": stopped\n");
        for (const Json& job : items(printer, "jobs")) {
            show("  " + job_line(job) + '\n');
        }
    }
}

/// The first failure is told at the end, behind what was stopped.
Result<ExitCode> stop(Service& service, const StopOptions& options) {
    const auto printers = printers_to_stop(service, options);
    if (!printers) {
        return printers.error();
    }
    if (printers->empty() && !options.common.json) {
        show("no printer prints\n");
    }
    const std::vector<Result<Json>> answers = stop_each(service, *printers);
    std::optional<Failure> failed;
    ExitCode code = ExitCode::done;
    Json stopped = Json::array();
    for (std::size_t i = 0; i < printers->size(); ++i) {
        const std::string& printer = (*printers)[i];
        if (!answers[i]) {
            if (failed) {
                say(printer + ": " + answers[i].error().message);
            }
            failed = failed.value_or(answers[i].error());
            continue;
        }
        const auto jobs = standing_jobs(service, printer);
        if (!jobs) {
            return jobs.error();
        }
        stopped.push_back({{"printer", printer}, {"jobs", *jobs}});
        for (const Json& job : *jobs) {
            code = text(job, "phase") == "in_doubt" ? ExitCode::in_doubt : code;
        }
    }
    if (options.common.json && !failed) {
        show_json(stopped);
    } else if (!options.common.json) {
        show_stopped(stopped);
    }
    if (failed) {
        return *failed;
    }
    return code;
}

} // namespace

ExitCode run_stop(const StopOptions& options) {
    return run_with_service(options.common, [&](Service& service) { return stop(service, options); });
}

} // namespace linefeed::client
