#include "client/file_commands.hpp"

#include "cli/signals.hpp"
#include "client/printer_files_access.hpp"
#include "printer/backup.hpp"
#include "printer/job_commands.hpp"
#include "printer/local_file.hpp"
#include "printer/picture.hpp"
#include "printer/printer_path.hpp"
#include "printer/tasks.hpp"
#include "protocol/printable.hpp"
#include "protocol/profile.hpp"

#include <algorithm>
#include <iostream>
#include <unistd.h>

namespace linefeed::client {

namespace fs = std::filesystem;
using printer::NewFile;

namespace {

/// A line on the terminal that is written over and over; nothing where stderr is none.
class ProgressLine {
public:
    void show(const std::string& words) {
        if (shown_ || ::isatty(STDERR_FILENO) != 0) {
            std::cerr << "\r\x1b[K" << protocol::printable(words) << std::flush;
            shown_ = true;
        }
    }
    ~ProgressLine() {
        if (shown_) {
            std::cerr << "\r\x1b[K" << std::flush;
        }
    }
    ProgressLine() = default;
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

private:
    bool shown_ = false;
};

/// Ctrl-C cancels.
printer::TransferOptions with_progress(cli::SignalWatch& signals, ProgressLine& line) {
    printer::TransferOptions options;
    options.on_progress = [&](const printer::TransferProgress& progress) {
        line.show(std::to_string(progress.blocks) + " of " + std::to_string(progress.total) + " blocks" +
                  (progress.repeated > 0 ? ", " + std::to_string(progress.repeated) + " repeated" : ""));
        return signals.take() == 0;
    };
    return options;
}

Result<std::string> file_name_in(const PrinterOptions& options, const std::string& path) {
    const auto profile = named_profile(options.direct);
    return profile ? printer::printer_file(path, profile->escapes) : profile.error();
}

std::string last_part(std::string_view path) {
    return std::string{path.substr(path.rfind('\\') + 1)};
}

Result<ExitCode> shown(const PrinterOptions& options, const Json& json, const std::string& words) {
    if (options.common.json) {
        show_json(json);
    } else {
        show(words + '\n');
    }
    return ExitCode::done;
}

Result<void> write_file(const fs::path& path, std::string_view bytes, bool replace) {
    auto file = NewFile::create(path, replace ? NewFile::Existing::replace : NewFile::Existing::refuse);
    auto written = file ? file->write(bytes) : file.error();
    return written ? file->commit() : written;
}

/// What is done with the printer's files, directly or over the service.
Result<ExitCode> with_files(const PrinterOptions& options, const printer::TransferOptions& transfer,
                            const std::function<Result<ExitCode>(printer::PrinterFiles&)>& run) {
    if (is_address(options.printer)) {
        const auto connected = connect_directly(options.printer, options.direct);
        if (!connected) {
            return connected.error();
        }
        printer::ConversationFiles files{**connected, transfer};
        return run(files);
    }
    auto files = service_files(options);
    return files ? run(*files) : files.error();
}

Result<Json> answer_of(const PrinterOptions& options, std::string_view task) {
    return task_answer({options, printer::find_task(task), {}, true});
}

/// Half a restore would be neither the one nor the other.
Result<void> check_standing(const PrinterOptions& options) {
    const auto status = answer_of(options, "status");
    return status && text(*status, "machine") == to_string(protocol::MachineState::printing)
               ? Failure{FailureKind::stopped,
                         options.printer + ": the printer prints: stop it first; nothing is written"}
               : Result<void>{};
}

Result<printer::Picture> picture_of(const Json& answer) {
    printer::Picture picture;
    const Json& rows = member(answer, "rows");
    picture.height = static_cast<std::uint32_t>(rows.size());
    for (const Json& row : rows) {
        const std::string dots = row.is_string() ? row.get<std::string>() : std::string{};
        if (dots.empty() || (picture.width != 0 && dots.size() != picture.width)) {
            return Failure{FailureKind::internal, "the service answers with no picture"};
        }
        picture.width = static_cast<std::uint32_t>(dots.size());
    }
    constexpr std::uint32_t bits = 8;
    const std::size_t bytes_per_stroke = (picture.height + bits - 1) / bits;
    picture.strokes.assign(bytes_per_stroke * picture.width, '\0');
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        const std::string dots = rows[y].get<std::string>();
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            if (dots[x] == '#') {
                char& byte = picture.strokes[x * bytes_per_stroke + y / bits];
                byte = static_cast<char>(static_cast<unsigned char>(byte) | 1U << y % bits);
            }
        }
    }
    return picture;
}

} // namespace

ExitCode run_file_get(const FileOptions& options) {
    cli::SignalWatch signals;
    ProgressLine line;
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        const auto path = file_name_in(options.printer, options.path);
        if (!path) {
            return path.error();
        }
        const fs::path local = options.local.empty() ? fs::path{printer::path_text(last_part(*path))} : options.local;
        return with_files(
            options.printer, with_progress(signals, line), [&](printer::PrinterFiles& files) -> Result<ExitCode> {
                const auto bytes = files.read(*path);
                if (!bytes) {
                    return bytes.error();
                }
                if (bytes->empty()) {
                    return Failure{FailureKind::input,
                                   printer::path_text(*path) +
                                       ": there is no such file, or it is empty: the printer answers alike"};
                }
                if (options.local == "-") {
                    show(*bytes);
                    return ExitCode::done;
                }
                if (auto written = write_file(local, *bytes, options.replace); !written) {
                    return written.error();
                }
                return shown(options.printer,
                             {{"path", printer::path_text(*path)},
                              {"file", local.string()},
                              {"bytes", bytes->size()},
                              {"sha256", printer::sha256_hex(*bytes)}},
                             local.string() + ": " + std::to_string(bytes->size()) + " bytes");
            });
    });
}

ExitCode run_file_put(const FileOptions& options) {
    cli::SignalWatch signals;
    ProgressLine line;
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        const auto path = file_name_in(options.printer, options.path);
        const auto bytes = path ? printer::read_file(options.local, printer::max_file_bytes) : path.error();
        if (!bytes) {
            return bytes.error();
        }
        Result<void> put;
        if (is_address(options.printer.printer)) {
            const auto connected = connect_directly(options.printer.printer, options.printer.direct);
            put = connected
                      ? printer::put_file(**connected, *path, *bytes, options.replace, with_progress(signals, line))
                      : connected.error();
        } else {
            auto files = service_files(options.printer);
            put = files ? files->send(*path, options.local, options.replace) : files.error();
        }
        return put ? shown(options.printer,
                           {{"path", printer::path_text(*path)},
                            {"bytes", bytes->size()},
                            {"sha256", printer::sha256_hex(*bytes)}},
                           printer::path_text(*path) + ": " + std::to_string(bytes->size()) + " bytes")
                   : put.error();
    });
}

ExitCode run_backup(const FolderOptions& options) {
    cli::SignalWatch signals;
    ProgressLine line;
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        return with_files(options.printer, {}, [&](printer::PrinterFiles& files) -> Result<ExitCode> {
            const auto report = printer::back_up(files, options.folder, [&](const printer::BackupProgress& progress) {
                line.show(std::to_string(progress.files) + " of " + std::to_string(progress.total) +
                          " files: " + progress.path);
                return signals.take() == 0;
            });
            if (!report) {
                return report.error();
            }
            std::size_t saved = report->manifest.files.size();
            for (const printer::SavedFile& file : report->manifest.files) {
                if (file.empty_or_unreadable()) {
                    --saved;
                    say(printer::path_text(file.path) + ": empty, or it cannot be read: the printer answers alike");
                }
            }
            return shown(
                options.printer,
                {{"folder", options.folder.string()}, {"files", saved}, {"taken_before", report->taken_before}},
                options.folder.string() + ": " + std::to_string(saved) + " files");
        });
    });
}

ExitCode run_restore(const FolderOptions& options) {
    cli::SignalWatch signals;
    ProgressLine line;
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        if (const auto whole = printer::check_backup(options.folder); !whole) {
            return whole.error();
        }
        const auto yes = confirm("Files of " + options.printer.printer + " that differ from " +
                                     options.folder.string() + " are replaced. Do it",
                                 options.yes, options.printer.common.json);
        if (!yes || !*yes) {
            return yes ? Result<ExitCode>{ExitCode::stopped} : yes.error();
        }
        if (auto standing = check_standing(options.printer); !standing) {
            return standing.error();
        }
        printer::RestoreOptions restore;
        restore.other_printer = options.other_printer;
        restore.on_progress = [&](const printer::BackupProgress& progress) {
            line.show(std::to_string(progress.files) + " of " + std::to_string(progress.total) +
                      " files: " + progress.path);
            return signals.take() == 0;
        };
        return with_files(options.printer, {}, [&](printer::PrinterFiles& files) -> Result<ExitCode> {
            const auto report = printer::restore(files, options.folder, restore);
            if (!report) {
                return report.error();
            }
            for (const std::string& kept : report->skipped) {
                say(kept + ": empty or unreadable when it was saved; the printer's own is kept");
            }
            return shown(options.printer,
                         {{"written", report->written}, {"alike", report->alike}, {"kept", report->skipped}},
                         std::to_string(report->written) + " files written and read back, " +
                             std::to_string(report->alike) + " were alike");
        });
    });
}

ExitCode run_script_get(const ScriptOptions& options) {
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        const auto answer = answer_of(options.printer, "script get");
        if (!answer) {
            return answer.error();
        }
        std::string lines = "BEGINLJSCRIPT\n";
        std::string safe;
        for (const Json& script_line : member(*answer, "lines")) {
            lines += script_line.get<std::string>() + '\n';
            safe += protocol::printable(script_line.get<std::string>()) + '\n';
        }
        lines += "ENDLJSCRIPT\n";
        if (!options.file.empty()) {
            if (auto written = write_file(options.file, lines, options.replace); !written) {
                return written.error();
            }
        }
        if (options.printer.common.json) {
            show_json(*answer);
        } else if (options.file.empty()) {
            show("BEGINLJSCRIPT\n" + safe + "ENDLJSCRIPT\n");
        }
        return ExitCode::done;
    });
}

ExitCode run_script_send(const ScriptOptions& options) {
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        constexpr std::uint64_t max_script_bytes = std::uint64_t{1} << 20U;
        const auto script = printer::read_file(options.file, max_script_bytes);
        if (!script) {
            return script.error();
        }
        const auto yes = confirm("The current job of " + options.printer.printer +
                                     " is replaced by the script and cannot be brought back. Do it",
                                 options.yes, options.printer.common.json);
        if (!yes || !*yes) {
            return yes ? Result<ExitCode>{ExitCode::stopped} : yes.error();
        }
        const auto answer =
            task_answer({options.printer, printer::find_task("script send"), {{"script", *script}}, true});
        if (!answer) {
            return answer.error();
        }
        if (member(*answer, "reads_back_alike") == false) {
            say("the printer gives the script back in its own way: compare with script get");
        }
        return shown(options.printer, *answer, "loaded: " + text(*answer, "loaded"));
    });
}

ExitCode run_preview(const PreviewOptions& options) {
    return run_command(options.printer.common.json, [&]() -> Result<ExitCode> {
        const auto answer = answer_of(options.printer, "preview");
        if (!answer) {
            return answer.error();
        }
        const auto picture = picture_of(*answer);
        if (!picture) {
            return picture.error();
        }
        if (!options.png.empty()) {
            const auto png = printer::to_png(*picture, options.scale);
            const auto written = png ? write_file(options.png, *png, options.replace) : png.error();
            if (!written) {
                return written.error();
            }
        }
        if (options.printer.common.json) {
            show_json(*answer);
        } else if (options.png.empty()) {
            // Where there is no terminal, nothing has to fit: each row of dots is a line.
            const auto columns =
                static_cast<std::uint32_t>(stdout_screen().columns.value_or(std::max(picture->width, 1U)));
            show(printer::to_text(*picture, columns,
                                  options.ascii ? printer::Drawing::ascii : printer::Drawing::unicode));
        }
        return ExitCode::done;
    });
}

} // namespace linefeed::client
