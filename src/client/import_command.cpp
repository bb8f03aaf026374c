#include "client/import_command.hpp"

#include "cli/print_report.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace linefeed::client {

namespace {

enum class SourceKind { csv, sqlite };

/// FailureKind::usage if the file cannot be read: nothing was asked of the service yet.
Result<SourceKind> kind_of(const std::filesystem::path& file) {
    constexpr std::string_view magic{"SQLite format 3\0", 16};
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        return Failure{FailureKind::input, file.string() + " is a directory"};
    }
    std::ifstream stream{file, std::ios::binary};
    if (!stream) {
        return Failure{FailureKind::input, "cannot read " + file.string() + ": " + std::strerror(errno)};
    }
    std::string head(magic.size(), '\0');
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    return head == magic ? SourceKind::sqlite : SourceKind::csv;
}

/// What was written to a database last may lie in a file beside it, which an upload would leave out.
Result<void> check_alone(const std::filesystem::path& file) {
    for (const char* suffix : {"-wal", "-journal"}) {
        std::filesystem::path companion = file;
        companion += suffix;
        std::error_code error;
        if (const auto size = std::filesystem::file_size(companion, error); !error && size > 0) {
            return Failure{FailureKind::input, file.string() + " is in use: " + companion.string() +
                                                   " holds a part of it. Close the program that writes it, or let the "
                                                   "service read the file itself (without --upload)"};
        }
    }
    return {};
}

std::string upload_target(const ImportOptions& options) {
    std::string target =
        "/api/v1/jobs?name=" + api::url_encoded(options.name.empty() ? options.file.filename().string() : options.name);
    for (const auto& [name, value] : {std::pair{"layout", &options.layout}, {"printer", &options.printer}}) {
        if (!value->empty()) {
            target += std::string{"&"} + name + '=' + api::url_encoded(*value);
        }
    }
    return target + (options.autostart ? "&autostart=true" : "") + (options.again ? "&again=true" : "");
}

Result<Json> upload(Service& service, const ImportOptions& options, SourceKind kind) {
    if (kind == SourceKind::csv) {
        return service.upload(upload_target(options), options.file, "text/csv");
    }
    if (const auto alone = check_alone(options.file); !alone) {
        return alone.error();
    }
    return service.upload(upload_target(options), options.file, "application/vnd.sqlite3");
}

Result<Json> read_there(Service& service, const ImportOptions& options) {
    std::error_code error;
    const std::filesystem::path file = std::filesystem::absolute(options.file, error);
    Json request{{"file", file.string()}};
    for (const auto& [name, value] :
         {std::pair{"name", &options.name}, {"layout", &options.layout}, {"printer", &options.printer}}) {
        if (!value->empty()) {
            request[name] = *value;
        }
    }
    if (options.autostart) {
        request["autostart"] = true;
    }
    if (options.again) {
        request["again"] = true;
    }
    return service.post("/api/v1/jobs", request);
}

void say_rows(const std::string& file, const Json& report) {
    const Json& reported = items(report, "reported");
    for (const Json& row : reported) {
        const std::string column = text(row, "column");
        say(file + ": line " + number_text(row, "line") + (column.empty() ? "" : ", column " + column) + ": " +
            text(row, "reason"));
    }
    const auto more = number(report, "bad_rows") - static_cast<std::int64_t>(reported.size());
    if (more > 0) {
        say(file + ": and " + std::to_string(more) + " more bad rows");
    }
}

/// The service has refused the file.
ExitCode refused(const ImportOptions& options, const Failure& failure, const Json& report, bool read_by_service) {
    say_rows(options.file.string(), report);
    cli::show_failure(failure, false);
    if (report.is_null() && read_by_service) {
        say("the service reads the file as its own user, with its own /tmp and without /home: --upload sends it the "
            "content instead");
    }
    if (options.common.json) {
        show_json({{"result", to_string(failure.kind)},
                   {"message", failure.message},
                   {"exit_code", static_cast<int>(cli::exit_code(failure.kind))},
                   {"import", report}});
    }
    return cli::exit_code(failure.kind);
}

void show_answer(const ImportOptions& options, const Json& answer) {
    const Json& report = member(answer, "report");
    const std::string job = "job " + number_text(answer, "job");
    if (flag(answer, "duplicate")) {
        show("not imported again: its content is " + job + " already (--again imports it once more)\n");
        return;
    }
    say_rows(options.file.string(), report);
    show("imported " + number_text(report, "records") + " records as " + job +
         (options.printer.empty() ? "" : ", in the queue of " + options.printer) + '\n');
}

} // namespace

ExitCode run_import(const ImportOptions& options) {
    return run_with_service(options.common, [&](Service& service) -> Result<ExitCode> {
        const auto kind = kind_of(options.file);
        if (!kind) {
            return kind.error();
        }
        const bool read_by_service = service.over_socket() && !options.upload;
        const auto answer = read_by_service ? read_there(service, options) : upload(service, options, *kind);
        if (!answer) {
            if (answer.error().kind != FailureKind::input) {
                return answer.error();
            }
            return refused(options, answer.error(), member(service.problem(), "report"), read_by_service);
        }
        if (options.common.json) {
            show_json(*answer);
        } else {
            show_answer(options, *answer);
        }
        return ExitCode::done;
    });
}

} // namespace linefeed::client
