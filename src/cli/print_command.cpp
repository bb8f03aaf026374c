#include "cli/print_command.hpp"

#include "cli/dry_run.hpp"
#include "cli/job_selection.hpp"
#include "cli/print_report.hpp"
#include "cli/progress_view.hpp"
#include "cli/record_text.hpp"
#include "cli/signals.hpp"
#include "cli/wall_time.hpp"
#include "daemon/job_run.hpp"

#include <chrono>
#include <iostream>
#include <poll.h>
#include <unistd.h>

namespace linefeed::cli {

namespace {

class PrintCommand {
public:
    explicit PrintCommand(const PrintOptions& options)
        : options_(options)
        , view_(options.json) {}

    Result<ExitCode> run();

private:
    Result<ExitCode> run(const std::filesystem::path& spool_path, const link::PrinterAddress& printer);
    Result<spool::Job> find_job(spool::Spool& spool);
    [[nodiscard]] Result<RecordRange> wanted_range(const spool::Job& job) const;
    Result<ExitCode> print(spool::Spool& spool, const spool::Job& job, RecordRange wanted,
                           const daemon::JobRunSettings& settings);
    Result<std::optional<feeder::Outcome>> settle_other_jobs(spool::Spool& spool, const spool::Job& job,
                                                             const daemon::JobRunSettings& settings);
    Result<feeder::Outcome> print_runs(spool::Spool& spool, const spool::Job& job, RecordRange wanted,
                                       const daemon::JobRunSettings& settings);
    Result<bool> settle_doubt(spool::Spool& spool, const spool::Job& job);
    bool wait_for_answer();
    Result<bool> ask_operator(spool::Spool& spool, const spool::Job& job);
    void watch(daemon::JobRun& run, RecordRange wanted);
    [[nodiscard]] daemon::JobRunSettings run_settings() const;

    const PrintOptions& options_;
    std::optional<daemon::RunThreads> threads_; ///< of print()
    SignalWatch signals_;
    ProgressView view_;
    bool interrupted_ = false;
    bool word_counts_ = true;
    std::string detail_; ///< of the last run
};

daemon::JobRunSettings PrintCommand::run_settings() const {
    daemon::JobRunSettings settings;
    settings.session.escapes = options_.profile.escapes;
    settings.session.reply_timeout = std::chrono::milliseconds{options_.reply_timeout_ms};
    settings.session.feeder.open_nozzle = options_.open_nozzle;
    for (const std::uint32_t code : options_.acknowledge) {
        settings.session.feeder.acknowledge.push_back(code);
    }
    settings.connect_timeout = std::chrono::milliseconds{options_.connect_timeout_ms};
    return settings;
}

Result<ExitCode> PrintCommand::run() {
    if (options_.dry_run) {
        const auto temporary = TemporaryDirectory::make();
        return temporary ? run(temporary->path() / "spool.db", {}) : Result<ExitCode>{temporary.error()};
    }
    const auto address = link::parse_printer_address(options_.printer);
    if (!address) {
        return address.error();
    }
    return run(options_.spool, *address);
}

Result<ExitCode> PrintCommand::run(const std::filesystem::path& spool_path, const link::PrinterAddress& printer) {
    auto spool = spool::Spool::open(spool_path, {wall_clock_ns, {}});
    if (!spool) {
        return spool.error();
    }
    const auto job = find_job(*spool);
    if (!job) {
        return job.error();
    }
    const auto wanted = wanted_range(*job);
    if (!wanted) {
        return wanted.error();
    }
    if (options_.dry_run) {
        return show_dry_run(options_, *spool, *job, *wanted);
    }
    const auto endpoints = link::resolve(printer);
    if (!endpoints) {
        return endpoints.error();
    }
    daemon::JobRunSettings settings = run_settings();
    settings.printer = printer;
    settings.endpoints = *endpoints;
    settings.session.charsets = record_format(*job).charsets;
    return print(*spool, *job, *wanted, settings);
}

Result<spool::Job> PrintCommand::find_job(spool::Spool& spool) {
    const auto begun = std::chrono::steady_clock::now();
    auto selection = select_job(options_, spool, [&](const intake::ImportReport& report, double fraction) {
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        view_.update({"importing", fraction, std::to_string(report.rows) + " rows",
                      static_cast<double>(report.rows) / std::max(seconds, 1e-3),
                      fraction > 0 ? std::optional{seconds / fraction - seconds} : std::nullopt});
        interrupted_ = interrupted_ || signals_.take() > 0;
        return !interrupted_;
    });
    view_.finish();
    if (!selection) {
        return interrupted_ ? Failure{FailureKind::stopped,
                                      "interrupted during the import: nothing is imported, nothing is printed"}
                            : selection.error();
    }
    if (selection->report.bad_rows > 0) {
        show_bad_rows(selection->report, options_.file.string(), !selection->job, options_.json);
    }
    if (!selection->job) {
        return Failure{FailureKind::input, {}}; // said already
    }
    if (selection->report.rows_with_empty_field > 0) {
        view_.message(std::to_string(selection->report.rows_with_empty_field) +
                      " records have an empty field: the printer may show the placeholder of its job there");
    }
    if (selection->imported && !options_.json && !options_.dry_run) {
        view_.message("imported " + std::to_string(selection->job->records.count().value()) + " records from " +
                      printable(options_.file.string()) + " as job " +
                      std::to_string(static_cast<std::int64_t>(selection->job->id)));
    }
    return *selection->job;
}

Result<RecordRange> PrintCommand::wanted_range(const spool::Job& job) const {
    const RecordNumber from = options_.from ? RecordNumber{*options_.from} : job.records.first();
    const RecordNumber to = options_.to ? RecordNumber{*options_.to} : job.records.last();
    const auto records =
        std::to_string(job.records.first().value()) + " to " + std::to_string(job.records.last().value());
    if (!job.records.contains(from)) {
        return Failure{FailureKind::usage,
                       "--from " + std::to_string(from.value()) + ": the file has the records " + records};
    }
    if (!job.records.contains(to)) {
        return Failure{FailureKind::usage,
                       "--to " + std::to_string(to.value()) + ": the file has the records " + records};
    }
    if (to < from) {
        return Failure{FailureKind::usage, "--to lies before --from"};
    }
    return RecordRange::closed(from, to);
}

/// Other jobs may have records in this printer whose fate only it knows, until it is flushed: they are settled first.
/// The outcome is that of a printer which could not be asked; absent = nothing stands in the way.
Result<std::optional<feeder::Outcome>> PrintCommand::settle_other_jobs(spool::Spool& spool, const spool::Job& job,
                                                                       const daemon::JobRunSettings& settings) {
    const auto open_jobs = spool.jobs_with_open_records();
    if (!open_jobs) {
        return open_jobs.error();
    }
    for (const spool::JobId other : *open_jobs) {
        const auto open = daemon::find_open_issue(spool, other);
        const auto other_job = spool.job(other);
        if (!open || !other_job) {
            return open ? other_job.error() : open.error();
        }
        if (other == job.id || !*open || !*other_job || (*open)->printer != link::to_string(settings.printer)) {
            continue;
        }
        view_.message("job " + std::to_string(static_cast<std::int64_t>(other)) +
                      " may have records in this printer: asking how far it came");
        daemon::JobRun run{*threads_, spool, **other_job, {}, *open, settings};
        run.start();
        watch(run, {});
        run.join();
        const auto left = daemon::find_open_issue(spool, other);
        if (!left) {
            return left.error();
        }
        if (*left) {
            detail_ = run.detail();
            return std::optional{run.outcome()};
        }
    }
    return std::optional<feeder::Outcome>{};
}

/// Waits until a line stands at the terminal. False if Ctrl-C comes first.
bool PrintCommand::wait_for_answer() {
    constexpr int wait_ms = 100;
    while (!interrupted_) {
        pollfd terminal{STDIN_FILENO, POLLIN, 0};
        if (::poll(&terminal, 1, wait_ms) > 0) {
            return true;
        }
        interrupted_ = signals_.take() > 0;
    }
    return false;
}

/// Whether records wait for an operator, and he can be asked. True if his word is in the ledger now.
Result<bool> PrintCommand::ask_operator(spool::Spool& spool, const spool::Job& job) {
    if (options_.json || ::isatty(STDIN_FILENO) == 0 || ::isatty(STDERR_FILENO) == 0) {
        return false;
    }
    const auto report = make_report(spool, job, job.records, {.code = feeder::OutcomeCode::records_in_doubt}, {});
    if (!report) {
        return report.error();
    }
    show_doubtful(*report);
    OperatorWord word;
    if (report->doubt_hole.empty()) {
        std::cerr << "Which record is on the last product? Its number or text (nothing = decide later): ";
    } else {
        std::cerr << "The last product does not tell which of them are printed: " << report->doubt_hole
                  << ".\nWhich of these records are on products? N-M,N or none (nothing = decide later): ";
    }
    std::cerr.flush();
    std::string answer;
    if (!wait_for_answer() || !std::getline(std::cin, answer) || answer.empty()) {
        return false;
    }
    if (report->doubt_hole.empty()) {
        word.last_printed = answer;
    } else {
        word.printed = answer;
    }
    if (const auto settled = settle_by_operator(spool, job, word); !settled) {
        return settled.error();
    }
    return true;
}

Result<bool> PrintCommand::settle_doubt(spool::Spool& spool, const spool::Job& job) {
    if (!options_.operator_word.given()) {
        return ask_operator(spool, job);
    }
    if (!word_counts_) {
        return false;
    }
    word_counts_ = false;
    if (const auto settled = settle_by_operator(spool, job, options_.operator_word); !settled) {
        return settled.error();
    }
    return true;
}

/// One run after the other until nothing is left to print, or something stands in the way.
Result<feeder::Outcome> PrintCommand::print_runs(spool::Spool& spool, const spool::Job& job, RecordRange wanted,
                                                 const daemon::JobRunSettings& settings) {
    feeder::Outcome outcome{.code = feeder::OutcomeCode::nothing_to_print};
    while (!interrupted_) {
        auto open = daemon::find_open_issue(spool, job.id);
        const auto state = spool.ledger_state(job.id);
        if (!open || !state) {
            return open ? state.error() : open.error();
        }
        if (!*open && state->count(spool::RecordState::in_doubt) > RecordCount{0}) {
            outcome.code = feeder::OutcomeCode::records_in_doubt;
            const auto settled = settle_doubt(spool, job);
            if (!settled) {
                return settled.error();
            }
            if (!*settled) {
                return outcome;
            }
            outcome.code = feeder::OutcomeCode::nothing_to_print;
            continue;
        }
        if (!*open && state->next_printable(wanted).empty()) {
            return outcome;
        }
        daemon::JobRun run{*threads_, spool, job, wanted, *open, settings};
        run.start();
        watch(run, wanted);
        run.join();
        outcome = run.outcome();
        detail_ = run.detail();
        word_counts_ = word_counts_ && !outcome.issued; // what the operator saw is true until something more is printed
        const bool doubt_to_settle = outcome.code == feeder::OutcomeCode::records_in_doubt && !outcome.issued;
        if (outcome.code != feeder::OutcomeCode::finished && !doubt_to_settle) {
            return outcome;
        }
    }
    return outcome;
}

Result<ExitCode> PrintCommand::print(spool::Spool& spool, const spool::Job& job, RecordRange wanted,
                                     const daemon::JobRunSettings& settings) {
    daemon::FeedThread feed{options_.real_time};
    daemon::StoreThread store{spool};
    threads_.emplace(daemon::RunThreads{feed, store});
    if (const std::string granted = feed.start(); !granted.empty()) {
        view_.message(granted);
    }
    const auto hindrance = settle_other_jobs(spool, job, settings);
    if (!hindrance) {
        return hindrance.error();
    }
    const auto outcome = *hindrance ? Result<feeder::Outcome>{**hindrance} : print_runs(spool, job, wanted, settings);
    if (!outcome) {
        return outcome.error();
    }
    feeder::Outcome told = *outcome;
    const bool good = told.code == feeder::OutcomeCode::finished || told.code == feeder::OutcomeCode::nothing_to_print;
    if (interrupted_ && good) {
        const auto state = spool.ledger_state(job.id);
        if (!state) {
            return state.error();
        }
        if (!state->next_printable(wanted).empty()) {
            told.code = feeder::OutcomeCode::stop_requested; // between two runs
        }
    }
    if (told.code == feeder::OutcomeCode::nothing_to_print) {
        detail_ = "all records of " + options_.file.string() + " in this range are printed already";
    }
    const auto report = make_report(spool, job, wanted, told, detail_);
    if (!report) {
        return report.error();
    }
    show_report(*report, options_.json);
    return report->code;
}

void PrintCommand::watch(daemon::JobRun& run, RecordRange wanted) {
    constexpr int wait_ms = 100;
    while (!run.finished()) {
        run.wait(wait_ms);
        for (const feeder::Notice& notice : run.take_notices()) {
            view_.message(printable(feeder::describe(notice)));
        }
        if (signals_.take() > 0) {
            view_.message(interrupted_ ? "still stopping" : "stopping the line");
            interrupted_ = true;
            run.request_stop();
        }
        const daemon::RunProgress progress = run.progress();
        if (progress.printing && !progress.range.empty()) {
            const std::uint64_t left = (wanted.last() - progress.printed_through).value();
            view_.update({"printing", 1.0 - static_cast<double>(left) / static_cast<double>(wanted.count().value()),
                          "record " + std::to_string(progress.printed_through.value()) + " of " +
                              std::to_string(wanted.last().value()),
                          progress.rate_per_s,
                          progress.rate_per_s > 0 ? std::optional{static_cast<double>(left) / progress.rate_per_s}
                                                  : std::nullopt});
        }
    }
    view_.finish();
}

} // namespace

ExitCode run_print(const PrintOptions& options) {
    PrintCommand command{options};
    const auto result = command.run();
    if (result) {
        return *result;
    }
    if (!result.error().message.empty()) {
        show_failure(result.error(), options.json);
    }
    return exit_code(result.error().kind);
}

} // namespace linefeed::cli
