// All files of a printer in a folder, and back: jobs, fonts and graphics of each of its devices. A backup that breaks
// off goes on where it was; so does a restore.
#pragma once

#include "base/failure.hpp"
#include "printer/backup_manifest.hpp"
#include "printer/printer_files.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace linefeed::printer {

/// How far it is.
struct BackupProgress {
    std::size_t files = 0; ///< done
    std::size_t total = 0;
    std::string path{}; ///< done last
};
/// Called for each file; false ends it, and FailureKind::stopped says that it can go on.
using OnBackup = std::function<bool(const BackupProgress&)>;

struct BackupReport {
    Manifest manifest;
    std::size_t taken_before = 0; ///< files that a backup which broke off had already
};

/// Reads every file into `folder`, which is made if it is not there, and writes the manifest last. FailureKind::usage:
/// the folder holds a whole backup, or one of another printer; ::storage: it cannot be written; ::input: there is no
/// file at all, or not room for the list; otherwise as download().
[[nodiscard]] Result<BackupReport> back_up(PrinterFiles& printer, const std::filesystem::path& folder,
                                           const OnBackup& on_progress);

struct RestoreReport {
    std::size_t written = 0;
    std::size_t alike = 0;              ///< in the printer already
    std::vector<std::string> skipped{}; ///< empty or unreadable when they were saved, and there is such a file: kept
};

struct RestoreOptions {
    bool other_printer = false; ///< also to one with another serial number
    OnBackup on_progress = [](const BackupProgress&) { return true; };
};

/// Reads manifest and files, and checks sizes and sums of all.  FailureKind::input, naming the first that is wrong.
[[nodiscard]] Result<Manifest> check_backup(const std::filesystem::path& folder);

/// Writes the files of a backup that are not in the printer with the same content, and reads each back. Files that the
/// backup does not have are left alone. Nothing is written unless the whole backup is sound. Fails as check_backup()
/// and upload(); ::usage: the backup is of another printer; ::stopped: what was written does not read back alike.
[[nodiscard]] Result<RestoreReport> restore(PrinterFiles& printer, const std::filesystem::path& folder,
                                            const RestoreOptions& options = {});

} // namespace linefeed::printer
