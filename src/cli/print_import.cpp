// The import as `linefeed print` sees it: whole before the first record is printed, or running meanwhile.
#include "cli/print_flow.hpp"
#include "cli/print_report.hpp"

#include <algorithm>
#include <chrono>

namespace linefeed::cli {

namespace {

/// So many records are imported before a run begins: enough for its first fill.
constexpr RecordCount first_records{256};

} // namespace

/// False if it is to be given up.
bool PrintCommand::show_import(std::uint64_t rows, double fraction) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - import_begun_).count();
    view_.update({"importing", fraction, std::to_string(rows) + " rows",
                  static_cast<double>(rows) / std::max(seconds, 1e-3),
                  fraction > 0 ? std::optional{seconds / fraction - seconds} : std::nullopt});
    interrupted_ = interrupted_ || signals_.take() > 0;
    return !interrupted_;
}

Result<void> PrintCommand::find_job(spool::Spool& spool) {
    auto selection = select_job(options_, spool,
                                [this](std::uint64_t rows, double fraction) { return show_import(rows, fraction); });
    view_.finish();
    if (!selection) {
        return interrupted_ ? Failure{FailureKind::stopped,
                                      "interrupted during the import: nothing is imported, nothing is printed"}
                            : selection.error();
    }
    const intake::ImportReport& report = selection->report;
    const bool stopped = selection->job && selection->refused;
    if (report.bad_rows > 0) {
        show_bad_rows(report, options_.file.string(), !selection->job || stopped, stopped ? &*selection->job : nullptr,
                      options_.json);
    }
    if (!selection->job || stopped) {
        return Failure{FailureKind::input, {}}; // said already
    }
    job_ = *selection->job;
    import_ = std::move(selection->running);
    if (report.rows_with_empty_field > 0) {
        tell_empty_fields(report);
    }
    if (selection->imported && !options_.json && !options_.dry_run) {
        const std::string what =
            import_ ? "importing " : "imported " + std::to_string(job_.records.count().value()) + " records from ";
        view_.message(what + printable(options_.file.string()) + " as job " +
                      std::to_string(static_cast<std::int64_t>(job_.id)) + (import_ ? " while it is printed" : ""));
    }
    return {};
}

void PrintCommand::tell_empty_fields(const intake::ImportReport& report) {
    view_.message(std::to_string(report.rows_with_empty_field) +
                  " records have an empty field: the printer may show the placeholder of its job there");
}

Result<void> PrintCommand::refresh_job(spool::Spool& spool) {
    const auto job = spool.job(job_.id);
    if (!job || !*job) {
        return job ? Failure{FailureKind::internal, "the job is gone"} : job.error();
    }
    job_ = **job;
    return {};
}

/// Imports on until the record `needed` is there, or there are no more.
Result<void> PrintCommand::import_through(spool::Spool& spool, RecordNumber needed) {
    const auto there = [&] {
        return !end_open() || (!import_->durable().empty() && import_->durable().last() >= needed);
    };
    const auto done =
        import_ ? import_on(*import_, there,
                            [this](std::uint64_t rows, double fraction) { return show_import(rows, fraction); })
                : Result<void>{};
    view_.finish();
    if (!done) {
        return done;
    }
    return refresh_job(spool);
}

/// What a run needs at its start: enough records behind all that was issued before.
Result<void> PrintCommand::import_first_records(spool::Spool& spool) {
    if (!end_open()) {
        return refresh_job(spool);
    }
    const auto state = spool.ledger_state(job_.id);
    const auto wanted = wanted_range();
    if (!state || !wanted) {
        return state ? wanted.error() : state.error();
    }
    RecordNumber first = wanted->first();
    if (const RecordRange next = state->next_printable(*wanted); !next.empty()) {
        first = next.first();
    }
    for (const RecordRange& open : state->ranges(spool::RecordState::open)) {
        first = std::max(first, open.last());
    }
    const RecordCount room = RecordNumber::max() - first;
    return import_through(spool, first + std::min(first_records, room));
}

/// Everything is printed that can be: what is left of the file is imported, or checked behind a bad row.
Result<void> PrintCommand::finish_import(spool::Spool& spool) {
    if (!import_) {
        return {};
    }
    const auto done = import_on(
        *import_, [] { return false; },
        [this](std::uint64_t rows, double fraction) { return show_import(rows, fraction); });
    view_.finish();
    if (!done) {
        return import_->failure() ? Result<void>{} : done; // told with the report
    }
    const intake::ImportReport& report = import_->report();
    if (import_->refused()) {
        bad_rows_ = report;
    } else if (report.bad_rows > 0) {
        show_bad_rows(report, options_.file.string(), false, nullptr, options_.json);
    }
    if (report.rows_with_empty_field > 0) {
        tell_empty_fields(report);
    }
    return refresh_job(spool);
}

} // namespace linefeed::cli
