#include "printer/backup.hpp"

#include "printer/local_file.hpp"
#include "printer/printer_path.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

namespace linefeed::printer {

namespace fs = std::filesystem;

namespace {

constexpr unsigned max_depth = 8;
constexpr std::size_t max_files = 65536;
constexpr std::uint64_t max_manifest_bytes = std::uint64_t{64} << 20U;

std::string utc_now() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
    gmtime_r(&now, &parts);
    std::array<char, 32> text{};
    const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return {text.data(), size};
}

Result<void> make_directories(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    return error ? Result<void>{Failure{FailureKind::storage, path.string() + ": " + error.message()}} : Result<void>{};
}

Result<void> write_whole(const fs::path& path, std::string_view bytes) {
    auto file = NewFile::create(path, NewFile::Existing::replace);
    if (!file) {
        return file.error();
    }
    auto written = file->write(bytes);
    return written ? file->commit() : written;
}

Result<void> add_files(PrinterFiles& printer, const std::string& directory, unsigned depth,
                       std::vector<std::string>& paths) {
    const auto entries = printer.list(directory);
    if (!entries) {
        return entries.error();
    }
    for (const protocol::DirectoryEntry& entry : *entries) {
        const std::string path = directory + '\\' + entry.name;
        if (paths.size() == max_files || (entry.is_directory && depth == max_depth)) {
            return Failure{FailureKind::input, path_text(path) + ": the printer lists more than any printer holds"};
        }
        const auto readable = printer_file(path_text(path), protocol::EscapeMode::backslash);
        if (!readable || *readable != path) {
            return Failure{FailureKind::input, path_text(path) + ": this is no name of a file"};
        }
        if (!entry.is_directory) {
            paths.push_back(path);
        } else if (auto added = add_files(printer, path, depth + 1, paths); !added) {
            return added;
        }
    }
    return {};
}

Result<std::vector<std::string>> all_files(PrinterFiles& printer) {
    std::vector<std::string> paths;
    for (const std::string_view directory : default_directories) {
        if (auto added = add_files(printer, std::string{directory}, 0, paths); !added) {
            return added.error();
        }
    }
    return paths.empty() ? Result<std::vector<std::string>>{Failure{FailureKind::input, "the printer lists no file"}}
                         : Result<std::vector<std::string>>{std::move(paths)};
}

Result<SavedPrinter> saved_printer(PrinterFiles& printer) {
    const auto identity = printer.identity();
    return identity ? Result<SavedPrinter>{SavedPrinter{identity->type, identity->serial_number, identity->firmware}}
                    : identity.error();
}

std::string name_of(const SavedPrinter& printer) {
    return path_text(printer.type) + " no. " + path_text(printer.serial_number);
}

/// A file of the backup is as the manifest says.
Result<void> check_saved(const fs::path& folder, const SavedFile& file) {
    if (file.empty_or_unreadable()) {
        return {};
    }
    const auto bytes = read_file(folder / saved_as(file.path), max_file_bytes);
    if (!bytes) {
        return bytes.error();
    }
    if (bytes->size() != file.size || sha256_hex(*bytes) != file.sha256) {
        return Failure{FailureKind::input,
                       (folder / saved_as(file.path)).string() + ": it is not the file that was saved"};
    }
    return {};
}

/// Flow: run() once.
class Backup {
public:
    Backup(PrinterFiles& printer, const fs::path& folder, const OnBackup& on_progress)
        : printer_(printer)
        , folder_(folder)
        , on_progress_(on_progress) {}

    Result<BackupReport> run() {
        if (auto begun = begin(); !begun) {
            return begun.error();
        }
        const auto paths = all_files(printer_);
        if (!paths) {
            return paths.error();
        }
        for (const std::string& path : *paths) {
            if (auto saved = save(path); !saved) {
                return saved.error();
            }
            const BackupProgress progress{report_.manifest.files.size(), paths->size(), path_text(path)};
            if (!on_progress_(progress)) {
                return Failure{FailureKind::stopped, "the backup was broken off; it can go on into the same folder"};
            }
        }
        return finish();
    }

private:
    Result<void> begin() {
        std::error_code ignored;
        if (fs::exists(folder_ / manifest_name, ignored)) {
            return Failure{FailureKind::usage,
                           folder_.string() + ": it holds a whole backup already; choose another folder"};
        }
        const auto printer = saved_printer(printer_);
        if (!printer) {
            return printer.error();
        }
        const auto job = printer_.loaded_job();
        if (!job) {
            return job.error();
        }
        report_.manifest = {*printer, utc_now(), *job, {}};
        if (auto made = make_directories(folder_); !made) {
            return made;
        }
        return fs::exists(folder_ / partial_name, ignored) ? go_on() : begin_anew();
    }

    Result<void> begin_anew() {
        if (auto written = write_whole(folder_ / partial_name, partial_head(report_.manifest)); !written) {
            return written;
        }
        return open_partial();
    }

    /// What an earlier run has saved, as far as it is still so.
    Result<void> go_on() {
        const auto text = read_file(folder_ / partial_name, max_manifest_bytes);
        const auto earlier = text ? parse_partial(*text) : text.error();
        if (!earlier) {
            return begin_anew();
        }
        if (earlier->printer != report_.manifest.printer) {
            return Failure{FailureKind::usage,
                           folder_.string() + ": it holds the beginning of a backup of " + name_of(earlier->printer)};
        }
        std::string lines = partial_head(report_.manifest);
        for (const SavedFile& file : earlier->files) {
            if (!file.empty_or_unreadable() && check_saved(folder_, file)) {
                earlier_[file.path] = file;
                lines += partial_line(file);
            }
        }
        auto written = write_whole(folder_ / partial_name, lines);
        return written ? open_partial() : written;
    }

    Result<void> open_partial() {
        partial_.open(folder_ / partial_name, std::ios::binary | std::ios::app);
        return partial_ ? Result<void>{} : cannot_write();
    }

    [[nodiscard]] Failure cannot_write() const {
        return {FailureKind::storage, (folder_ / partial_name).string() + ": it cannot be written"};
    }

    Result<void> save(const std::string& path) {
        if (const auto earlier = earlier_.find(path); earlier != earlier_.end()) {
            ++report_.taken_before;
            report_.manifest.files.push_back(earlier->second);
            return {};
        }
        const auto bytes = printer_.read(path);
        if (!bytes) {
            return bytes.error();
        }
        const SavedFile file{path, bytes->size(), sha256_hex(*bytes)};
        if (!bytes->empty()) {
            const fs::path local = folder_ / saved_as(path);
            auto made = make_directories(local.parent_path());
            if (made) {
                made = write_whole(local, *bytes);
            }
            if (!made) {
                return made;
            }
        }
        report_.manifest.files.push_back(file);
        partial_ << partial_line(file) << std::flush;
        return partial_ ? Result<void>{} : cannot_write();
    }

    Result<BackupReport> finish() {
        if (auto written = write_whole(folder_ / manifest_name, manifest_json(report_.manifest)); !written) {
            return written.error();
        }
        partial_.close();
        std::error_code ignored;
        fs::remove(folder_ / partial_name, ignored);
        return std::move(report_);
    }

    PrinterFiles& printer_;
    const fs::path& folder_;
    const OnBackup& on_progress_;
    std::map<std::string, SavedFile> earlier_;
    std::ofstream partial_;
    BackupReport report_;
};

/// True: it had to be written.
Result<bool> restore_file(PrinterFiles& printer, const std::string& path, const std::string& bytes) {
    const auto before = printer.read(path);
    if (!before) {
        return before.error();
    }
    if (*before == bytes) {
        return false;
    }
    if (auto written = printer.write(path, bytes); !written) {
        return written.error();
    }
    const auto after = printer.read(path);
    if (!after) {
        return after.error();
    }
    if (*after != bytes) {
        return Failure{FailureKind::stopped, path_text(path) + ": the printer does not give back what was written"};
    }
    return true;
}

/// The printer cannot deliver an empty file: so one is made, but never in the place of a file that is there.
Result<void> restore_empty(PrinterFiles& printer, const std::string& path, RestoreReport& report) {
    const auto there = printer.exists(path);
    if (!there) {
        return there.error();
    }
    if (*there) {
        report.skipped.push_back(path_text(path));
        return {};
    }
    ++report.written;
    return printer.write(path, {});
}

Result<void> restore_one(PrinterFiles& printer, const fs::path& folder, const SavedFile& file, RestoreReport& report) {
    if (file.empty_or_unreadable()) {
        return restore_empty(printer, file.path, report);
    }
    const auto bytes = read_file(folder / saved_as(file.path), max_file_bytes);
    if (!bytes) {
        return bytes.error();
    }
    const auto written = restore_file(printer, file.path, *bytes);
    if (!written) {
        return written.error();
    }
    ++(*written ? report.written : report.alike);
    return {};
}

} // namespace

Result<BackupReport> back_up(PrinterFiles& printer, const fs::path& folder, const OnBackup& on_progress) {
    return Backup{printer, folder, on_progress}.run();
}

Result<Manifest> check_backup(const fs::path& folder) {
    const auto text = read_file(folder / manifest_name, max_manifest_bytes);
    if (!text) {
        return text.error();
    }
    auto manifest = parse_manifest(*text);
    if (!manifest) {
        return manifest;
    }
    for (const SavedFile& file : manifest->files) {
        if (auto checked = check_saved(folder, file); !checked) {
            return checked.error();
        }
    }
    return manifest;
}

Result<RestoreReport> restore(PrinterFiles& printer, const fs::path& folder, const RestoreOptions& options) {
    const auto manifest = check_backup(folder);
    if (!manifest) {
        return manifest.error();
    }
    const auto identity = saved_printer(printer);
    if (!identity) {
        return identity.error();
    }
    if (identity->serial_number != manifest->printer.serial_number && !options.other_printer) {
        return Failure{FailureKind::usage, "the backup is of " + name_of(manifest->printer) + ", this is " +
                                               name_of(*identity) + ": say --other-printer if that is meant"};
    }
    RestoreReport report;
    std::size_t done = 0;
    for (const SavedFile& file : manifest->files) {
        if (auto restored = restore_one(printer, folder, file, report); !restored) {
            return restored.error();
        }
        if (!options.on_progress({++done, manifest->files.size(), path_text(file.path)})) {
            return Failure{FailureKind::stopped, "the restore was broken off; begun again it goes on"};
        }
    }
    return report;
}

} // namespace linefeed::printer
