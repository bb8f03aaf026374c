// The steps of `linefeed print`, spread over several files; for them only.
#pragma once

#include "cli/job_selection.hpp"
#include "cli/print_command.hpp"
#include "cli/progress_view.hpp"
#include "cli/signals.hpp"
#include "daemon/job_run.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace linefeed::cli {

/// Flow: construct, run().
class PrintCommand {
public:
    explicit PrintCommand(const PrintOptions& options)
        : options_(options)
        , view_(options.json) {}

    Result<ExitCode> run();

private:
    // print_command.cpp: from the options to the job, and from its outcome to the report
    Result<ExitCode> run(const std::filesystem::path& spool_path, const link::PrinterAddress& printer);
    [[nodiscard]] daemon::JobRunSettings run_settings() const;
    Result<ExitCode> print(spool::Spool& spool, const daemon::JobRunSettings& settings);
    Result<ExitCode> report(spool::Spool& spool, feeder::Outcome outcome);
    [[nodiscard]] Result<void> check_escapes(spool::Spool& spool) const;
    /// What --from and --to leave of the job; up to where it can reach while its end is not known. FailureKind::usage
    /// if they are wrong.
    [[nodiscard]] Result<RecordRange> wanted_range() const;

    // print_import.cpp: the import, before and while it is printed
    Result<void> find_job(spool::Spool& spool);
    bool show_import(std::uint64_t rows, double fraction);
    Result<void> refresh_job(spool::Spool& spool);
    Result<void> import_through(spool::Spool& spool, RecordNumber needed);
    Result<void> import_first_records(spool::Spool& spool);
    Result<void> finish_import(spool::Spool& spool);
    void tell_empty_fields(const intake::ImportReport& report);
    [[nodiscard]] bool end_open() const { return import_ && !import_->end_known(); }

    // print_runs.cpp: runs and the questions between them
    Result<std::optional<feeder::Outcome>> settle_other_jobs(spool::Spool& spool,
                                                             const daemon::JobRunSettings& settings);
    Result<feeder::Outcome> print_runs(spool::Spool& spool, const daemon::JobRunSettings& settings);
    Result<bool> settle_doubt(spool::Spool& spool);
    bool wait_for_answer();
    Result<bool> ask_operator(spool::Spool& spool);
    void watch(daemon::JobRun& run);

    const PrintOptions& options_;
    std::optional<daemon::RunThreads> threads_; ///< of print()
    SignalWatch signals_;
    ProgressView view_;
    spool::Job job_;                                ///< as far as it is known
    std::unique_ptr<daemon::RunningImport> import_; ///< of the job, while it runs
    std::chrono::steady_clock::time_point import_begun_ = std::chrono::steady_clock::now();
    intake::ImportReport bad_rows_; ///< when a bad row has ended it
    bool began_open_ = false;       ///< the end of the file was not known when --to should have been checked
    bool interrupted_ = false;
    bool word_counts_ = true;
    std::string detail_; ///< of the last run
};

} // namespace linefeed::cli
