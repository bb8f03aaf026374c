#include "cli/print_command.hpp"

#include "cli/dry_run.hpp"
#include "cli/print_flow.hpp"
#include "cli/print_report.hpp"
#include "cli/printer_profile.hpp"
#include "daemon/line_use.hpp"
#include "daemon/record_text.hpp"
#include "daemon/wall_clock.hpp"
#include "store/store_thread.hpp"

#include <algorithm>
#include <chrono>

namespace linefeed::cli {

daemon::JobRunSettings PrintCommand::run_settings() const {
    daemon::JobRunSettings settings;
    settings.session.escapes = options_.layout.profile.escapes;
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
    auto spool = spool::Spool::open(spool_path, {daemon::wall_clock_ns, {}});
    if (!spool) {
        return spool.error();
    }
    if (const auto found = find_job(*spool); !found) {
        return found.error();
    }
    began_open_ = end_open();
    const auto first =
        options_.from && end_open() ? import_through(*spool, RecordNumber{*options_.from}) : Result<void>{};
    const auto wanted = first ? wanted_range() : Result<RecordRange>{first.error()};
    if (!wanted) {
        return wanted.error();
    }
    if (options_.dry_run) {
        return show_dry_run(options_, *spool, job_, *wanted);
    }
    const auto endpoints = link::resolve(printer);
    if (!endpoints) {
        return endpoints.error();
    }
    if (const auto fits = check_escapes(*spool); !fits) {
        import_.reset(); // before the spool
        return fits.error();
    }
    daemon::JobRunSettings settings = run_settings();
    settings.session.charsets = daemon::record_format(job_).charsets;
    daemon::use_line(settings, printer, *endpoints, daemon::record_bytes(job_));
    if (const std::string words = daemon::line_words(printer, daemon::record_bytes(job_)); !words.empty()) {
        view_.message(words);
    }
    if (options_.expected_rate) {
        const auto bytes = daemon::record_bytes(job_);
        if (const auto too_little = daemon::shortfall(printer, bytes, *options_.expected_rate)) {
            view_.message("warning: " + too_little->words + ". " + too_little->advice);
        }
    }
    auto code = print(*spool, settings);
    import_.reset(); // before the spool
    return code;
}

/// Whether the printer knows the escapes that `^` and `\\` of the records are sent with. It is asked only if there are
/// some; one that does not tell is taken at the word of its profile.
Result<void> PrintCommand::check_escapes(spool::Spool& spool) const {
    const protocol::Profile& profile = options_.layout.profile;
    const bool trusted = profile.own.escapes || profile.escapes == protocol::EscapeMode::none;
    const auto needed = trusted ? Result<bool>{false} : spool.has_escapes(job_.id);
    if (!needed || !*needed) {
        return needed ? Result<void>{} : needed.error();
    }
    const auto told = ask_profile(options_);
    if (!told || told->escapes == profile.escapes) {
        return {};
    }
    return Failure{FailureKind::input,
                   options_.file.string() + " has records with ^ or \\, and the printer says that it is a " +
                       std::string{told->name} + ", which knows no escapes: they would come out wrong. Take these " +
                       "characters out; or, if this printer knows them, say --profile " + std::string{profile.name} +
                       ",escapes=on"};
}

Result<RecordRange> PrintCommand::wanted_range() const {
    const RecordNumber end = end_open() ? import_->bound() : job_.records.last();
    const RecordNumber from = options_.from ? RecordNumber{*options_.from} : job_.records.first();
    RecordNumber to = options_.to ? RecordNumber{*options_.to} : end;
    if (began_open_) {
        to = std::min(to, end);
    }
    const auto records =
        std::to_string(job_.records.first().value()) + " to " + std::to_string(job_.records.last().value());
    if (!job_.records.contains(from)) {
        return Failure{FailureKind::usage,
                       "--from " + std::to_string(from.value()) + ": the file has the records " + records};
    }
    if (to < job_.records.first() || end < to) {
        return Failure{FailureKind::usage,
                       "--to " + std::to_string(to.value()) + ": the file has the records " + records};
    }
    if (to < from) {
        return Failure{FailureKind::usage, "--to lies before --from"};
    }
    return RecordRange::closed(from, to);
}

Result<ExitCode> PrintCommand::print(spool::Spool& spool, const daemon::JobRunSettings& settings) {
    daemon::FeedThread feed{options_.real_time};
    store::StoreThread store{spool};
    threads_.emplace(daemon::RunThreads{feed, store});
    if (const std::string granted = feed.start(); !granted.empty()) {
        view_.message(granted);
    }
    const auto hindrance = settle_other_jobs(spool, settings);
    if (!hindrance) {
        return hindrance.error();
    }
    const auto outcome = *hindrance ? Result<feeder::Outcome>{**hindrance} : print_runs(spool, settings);
    if (!outcome) {
        return outcome.error();
    }
    return report(spool, *outcome);
}

/// What has come of it, once the import is over or given up.
Result<ExitCode> PrintCommand::report(spool::Spool& spool, feeder::Outcome told) {
    const auto is_good = [&] {
        return told.code == feeder::OutcomeCode::finished || told.code == feeder::OutcomeCode::nothing_to_print;
    };
    const auto imported = is_good() && !interrupted_ ? finish_import(spool) : Result<void>{};
    if (!imported && !interrupted_) {
        return imported.error();
    }
    const std::optional<Failure> failed = import_ ? import_->failure() : std::nullopt;
    import_.reset();
    if (const auto refreshed = refresh_job(spool); !refreshed) {
        return refreshed.error();
    }
    const auto wanted = wanted_range();
    if (!wanted) {
        return wanted.error();
    }
    const auto state = spool.ledger_state(job_.id);
    if (!state) {
        return state.error();
    }
    const bool importing = job_.state == spool::ImportState::importing;
    if (interrupted_ && is_good() && (importing || !state->next_printable(*wanted).empty())) {
        told.code = feeder::OutcomeCode::stop_requested; // between two runs
    }
    if (told.code == feeder::OutcomeCode::nothing_to_print) {
        detail_ = "all records of " + options_.file.string() + " in this range are printed already";
    }
    auto report = make_report(spool, job_, *wanted, told, detail_);
    if (!report) {
        return report.error();
    }
    if (failed && failed->kind != FailureKind::storage) {
        reject(*report, *failed);
    } else if (is_good() && job_.state == spool::ImportState::stopped && report->next.empty()) {
        reject(*report, bad_rows_, options_.file.string());
    } else if (began_open_ && !importing && options_.to && *options_.to > job_.records.last().value()) {
        view_.message("the file ends with record " + std::to_string(job_.records.last().value()) + ", before --to");
    }
    show_report(*report, options_.json);
    return report->code;
}

ExitCode run_print(const PrintOptions& asked) {
    PrintOptions options = asked;
    if (protocol::is_automatic(options.layout.profile) && !options.dry_run) {
        const auto profile = ask_profile(options);
        if (!profile) {
            show_failure(profile.error(), options.json);
            return exit_code(profile.error().kind);
        }
        options.layout.profile = *profile;
    }
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
