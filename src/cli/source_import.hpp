// From the options of `linefeed print` to an import: how the file is read, and the import itself, whole before anything
// is printed or running meanwhile.
#pragma once

#include "base/failure.hpp"
#include "cli/print_options.hpp"
#include "daemon/running_import.hpp"
#include "intake/import.hpp"
#include "spool/spool.hpp"

#include <functional>
#include <memory>
#include <string>

namespace linefeed::cli {

/// Progress of an import: rows so far and the fraction of the file; false cancels.
using ImportProgress = std::function<bool(std::uint64_t rows, double fraction)>;

/// Imports the file to its end.
[[nodiscard]] Result<intake::ImportOutcome> import_whole(const PrintOptions& options, spool::Spool& spool,
                                                         const spool::JobSpec& spec, const ImportProgress& on_progress);

/// Starts an import that runs while its records are printed.
[[nodiscard]] Result<std::unique_ptr<daemon::RunningImport>>
start_import(const PrintOptions& options, spool::Spool& spool, const spool::JobSpec& spec);
/// Goes on with the import of `job`; `source` is what its file is like now.
[[nodiscard]] Result<std::unique_ptr<daemon::RunningImport>> go_on_with_import(const PrintOptions& options,
                                                                               spool::Spool& spool,
                                                                               const spool::Job& job,
                                                                               const spool::SourceFingerprint& source);

/// Writes what the import gives until `enough` or it is over. FailureKind::stopped if `on_progress` says so, and why if
/// it fails.
[[nodiscard]] Result<void> import_on(daemon::RunningImport& import, const std::function<bool()>& enough,
                                     const ImportProgress& on_progress);

} // namespace linefeed::cli
