// Runs, one after the other, until nothing is left to print or something stands in the way, and the questions that only
// an operator can answer in between.
#include "cli/operator_name.hpp"
#include "cli/print_flow.hpp"
#include "cli/print_report.hpp"
#include "daemon/line_use.hpp"
#include "daemon/other_jobs.hpp"
#include "store/ledger_keeper.hpp"

#include <iostream>
#include <poll.h>
#include <unistd.h>

namespace linefeed::cli {

/// The outcome is that of a printer which could not be asked; absent = nothing stands in the way.
Result<std::optional<feeder::Outcome>> PrintCommand::settle_other_jobs(spool::Spool& spool,
                                                                       const daemon::JobRunSettings& settings) {
    const auto hindrance =
        daemon::settle_other_jobs(*threads_, spool, job_.id, settings, [this](daemon::JobRun& run, spool::JobId other) {
            view_.message("job " + std::to_string(static_cast<std::int64_t>(other)) +
                          " may have records in this printer: asking how far it came");
            watch(run);
        });
    if (!hindrance) {
        return hindrance.error();
    }
    if (!*hindrance) {
        return std::optional<feeder::Outcome>{};
    }
    detail_ = (*hindrance)->detail;
    return std::optional{(*hindrance)->outcome};
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
Result<bool> PrintCommand::ask_operator(spool::Spool& spool) {
    if (options_.json || ::isatty(STDIN_FILENO) == 0 || ::isatty(STDERR_FILENO) == 0) {
        return false;
    }
    const auto report = make_report(spool, job_, job_.records, {.code = feeder::OutcomeCode::records_in_doubt}, {});
    if (!report) {
        return report.error();
    }
    show_doubtful(*report);
    daemon::OperatorWord word;
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
    if (const auto settled = daemon::settle_by_operator(spool, job_, word, operator_name()); !settled) {
        return settled.error();
    }
    return true;
}

Result<bool> PrintCommand::settle_doubt(spool::Spool& spool) {
    if (!options_.operator_word.given()) {
        return ask_operator(spool);
    }
    if (!word_counts_) {
        return false;
    }
    word_counts_ = false;
    if (const auto settled = daemon::settle_by_operator(spool, job_, options_.operator_word, operator_name());
        !settled) {
        return settled.error();
    }
    return true;
}

/// One run after the other until nothing is left to print, or something stands in the way.
Result<feeder::Outcome> PrintCommand::print_runs(spool::Spool& spool, const daemon::JobRunSettings& given) {
    daemon::JobRunSettings settings = given;
    feeder::Outcome outcome{.code = feeder::OutcomeCode::nothing_to_print};
    daemon::NoisePatience patience;
    while (!interrupted_) {
        if (const auto ready = import_first_records(spool); !ready) {
            return interrupted_ ? Result<feeder::Outcome>{outcome} : ready.error();
        }
        auto open = store::find_open_issue(spool, job_.id);
        const auto state = spool.ledger_state(job_.id);
        const auto wanted = wanted_range();
        if (!open || !state || !wanted) {
            return !open ? open.error() : !state ? state.error() : wanted.error();
        }
        if (!*open && state->count(spool::RecordState::in_doubt) > RecordCount{0}) {
            outcome.code = feeder::OutcomeCode::records_in_doubt;
            const auto settled = settle_doubt(spool);
            if (!settled) {
                return settled.error();
            }
            if (!*settled) {
                return outcome;
            }
            outcome.code = feeder::OutcomeCode::nothing_to_print;
            continue;
        }
        if (!*open && state->next_printable(*wanted).empty()) {
            return outcome;
        }
        daemon::JobRun run{*threads_, spool, job_, *wanted, *open, settings, end_open() ? import_.get() : nullptr};
        run.start();
        watch(run);
        run.join();
        outcome = run.outcome();
        detail_ = run.detail();
        word_counts_ = word_counts_ && !outcome.issued; // what the operator saw is true until something more is printed
        if (import_ && import_->failure()) {
            return outcome;
        }
        const bool doubt_to_settle = outcome.code == feeder::OutcomeCode::records_in_doubt && !outcome.issued;
        // The earlier run may have printed all that is imported so far.
        const bool more_to_come = outcome.code == feeder::OutcomeCode::nothing_to_print && end_open();
        const bool noise_only = patience.goes_on(outcome, run.progress(), settings);
        if (noise_only) {
            view_.message(feeder::describe(outcome) + "; going on");
        }
        if (outcome.code != feeder::OutcomeCode::finished && !doubt_to_settle && !more_to_come && !noise_only) {
            return outcome;
        }
    }
    return outcome;
}

void PrintCommand::watch(daemon::JobRun& run) {
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
        if (!progress.printing || progress.range.empty()) {
            continue;
        }
        const auto printed = std::to_string(progress.printed_through.value());
        if (import_ && progress.range.last() == import_->bound()) { // nobody knows how many there will be
            view_.update({"printing", std::nullopt,
                          "record " + printed + ", " + std::to_string(import_->rows()) + " rows read so far",
                          progress.rate_per_s, std::nullopt});
            continue;
        }
        const RecordNumber first = options_.from ? RecordNumber{*options_.from} : job_.records.first();
        const double all = static_cast<double>((progress.range.last() - first).value()) + 1;
        const auto left = static_cast<double>((progress.range.last() - progress.printed_through).value());
        view_.update({"printing", 1.0 - left / all,
                      "record " + printed + " of " + std::to_string(progress.range.last().value()), progress.rate_per_s,
                      progress.rate_per_s > 0 ? std::optional{left / progress.rate_per_s} : std::nullopt});
    }
    view_.finish();
}

} // namespace linefeed::cli
