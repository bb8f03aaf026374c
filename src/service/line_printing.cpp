// From the order to print a job to the reason why it ended. The same steps as `linefeed print`, without a terminal:
// what an operator has to decide is left to him.
#include "daemon/events.hpp"
#include "daemon/record_text.hpp"
#include "service/line.hpp"

namespace linefeed::service {

namespace event_kind = daemon::event_kind;
using daemon::JobRun;
using feeder::OutcomeCode;
using spool::RecordState;
using store::OpenIssue;

namespace {

/// What is known of the job before a run, and of the records that an earlier run has left open.
struct Before {
    JobFacts facts;
    std::optional<OpenIssue> open;
};

Result<Before> look(SpoolAccess& access, spool::JobId job) {
    return access.write([job](spool::Spool& spool) -> Result<Before> {
        auto facts = read_facts(spool, job);
        auto open = store::find_open_issue(spool, job);
        if (!facts || !open) {
            return facts ? open.error() : facts.error();
        }
        return Before{std::move(*facts), std::move(*open)};
    });
}

/// An earlier run that may still be printing can be gone on with up to where it was to end.
RecordRange wanted_records(const Before& before) {
    const RecordRange all = before.facts.job.records;
    return before.open ? RecordRange::closed(all.first(), before.open->of(before.facts.job.id)->run_range.last()) : all;
}

} // namespace

void Line::print(spool::JobId job) {
    auto ending = print_runs(job);
    if (!ending) {
        const bool reachable = ending.error().kind != FailureKind::unreachable;
        const OutcomeCode code = reachable ? OutcomeCode::storage_failed : OutcomeCode::unreachable;
        ending = Ending{at_work(), {.code = code, .issued = false}, ending.error().message};
    }
    conclude(*ending);
    ending->noise_only = false; // nothing goes on
    let_go_of_follower(*ending, words_of(*ending));
}

Result<daemon::JobRunSettings> Line::run_settings(const spool::Job& job) {
    const SharedSettings all = settings();
    const config::PrinterSettings& own = *all->printer(printer_);
    const auto endpoints = link::resolve(own.address);
    if (!endpoints) {
        return endpoints.error();
    }
    daemon::JobRunSettings settings;
    settings.connect_timeout = own.connect_timeout;
    settings.meters = &meters_;
    settings.frames = &frames_;
    settings.session.escapes = known_profile(own).escapes;
    settings.session.charsets = daemon::record_format(job).charsets;
    settings.session.reply_timeout = own.reply_timeout;
    settings.session.feeder.pacing = own.pacing;
    settings.session.feeder.open_nozzle = own.open_nozzle;
    settings.session.feeder.acknowledge = all->acknowledged(own);
    settings.session.feeder.stop_on = all->stopping(own);
    daemon::use_line(settings, own.address, *endpoints, daemon::record_bytes(job));
    return settings;
}

/// One run after the other until nothing is left to print, or something stands in the way.
Result<Ending> Line::print_runs(spool::JobId job) {
    auto before = look(services_.access, job);
    if (!before) {
        return before.error();
    }
    if (is_stop_requested()) { // before anything was said to the printer, or while it was kept for something else
        return Ending{job, {.code = OutcomeCode::stop_requested, .issued = false}, {}};
    }
    if (auto hindered = ask_about_others(before->facts.job); !hindered || *hindered) {
        return hindered ? Result<Ending>{std::move(**hindered)} : hindered.error();
    }
    if (auto hindered = check_printer(before->facts.job, before->open.has_value()); !hindered || *hindered) {
        return hindered ? Result<Ending>{std::move(**hindered)} : hindered.error();
    }
    auto settings = run_settings(before->facts.job); // the printer may have told its profile just now
    if (!settings) {
        return settings.error();
    }
    Ending ending{job, {.code = OutcomeCode::nothing_to_print, .issued = false}, {}};
    Means means{*settings, {}, follower_wanted(before->facts.job, *settings)};
    if (const std::string words = daemon::line_words(means.settings.printer, daemon::record_bytes(before->facts.job));
        !words.empty()) {
        event(event_kind::printer_notice, job, words);
    }
    while (true) {
        before = look(services_.access, ending.job); // another than at first if that has followed
        if (!before) {
            return before.error();
        }
        const bool told = !before->open;
        if (told && before->facts.in(RecordState::in_doubt) > RecordCount{0}) {
            ending.outcome.code = OutcomeCode::records_in_doubt;
            return ending;
        }
        if (told && before->facts.next().empty() && goes_on_with_follower()) {
            ending.job = at_work();
            continue;
        }
        if (told && before->facts.next().empty()) {
            ending.outcome.code = OutcomeCode::finished;
            return ending;
        }
        if (is_stop_requested()) {
            ending.outcome.code = OutcomeCode::stop_requested;
            return ending;
        }
        ending = run(before->facts, wanted_records(*before), before->open, means);
        const bool goes_on =
            ending.noise_only || ending.outcome.code == OutcomeCode::finished ||
            (ending.outcome.code == OutcomeCode::records_in_doubt && !ending.outcome.issued) ||
            (ending.outcome.code == OutcomeCode::nothing_to_print && before->open); // the earlier run printed all
        if (!goes_on) {
            return ending;
        }
    }
}

bool Line::is_stop_requested() const {
    const std::lock_guard lock{mutex_};
    return stop_requested_;
}

Ending Line::run(const JobFacts& facts, RecordRange wanted, const std::optional<OpenIssue>& open, Means& means) {
    JobRun run{services_.threads, services_.spool, facts.job, wanted, open, means.settings};
    {
        const std::lock_guard lock{mutex_};
        records_ = facts.job.records;
    }
    run.start();
    watch(run, [&] { look_after_chain(run, means.follower); });
    run.join();
    follow(run.progress());
    Ending ending{at_work(), run.outcome(), run.detail()};
    ending.noise_only = means.patience.goes_on(ending.outcome, run.progress(), means.settings);
    if (ending.noise_only) {
        event(event_kind::printer_warning, ending.job, feeder::describe(ending.outcome) + "; going on");
    }
    conclude_earlier(words_of(ending));
    let_go_of_follower(ending, words_of(ending));
    return ending;
}

/// Until the run is finished. A stop that was asked for before it reaches it as well.
void Line::watch(JobRun& run, const std::function<void()>& meanwhile) {
    constexpr int wait_ms = 200;
    {
        const std::lock_guard lock{mutex_};
        run_ = &run;
        if (stop_requested_) {
            run.request_stop();
        }
    }
    while (!run.finished()) {
        run.wait(wait_ms);
        for (const feeder::Notice& notice : run.take_notices()) {
            take_notice(notice, at_work());
        }
        meanwhile();
    }
    const std::lock_guard lock{mutex_};
    hear(run.progress());
    if (run.progress().machine) {
        watch_.heard(*run.progress().machine);
    }
    run_ = nullptr;
}

void Line::take_notice(const feeder::Notice& notice, spool::JobId job) {
    using feeder::NoticeCode;
    if (!notice.error.none()) {
        frames_.keep(); // what was said before it
    }
    switch (notice.code) {
    case NoticeCode::printing_started:
        event(event_kind::job_printing, job, "printing");
        return;
    case NoticeCode::follower_printing: // follow() tells it
        return;
    case NoticeCode::supply_low: {
        const std::lock_guard lock{mutex_};
        supply_low_ = true;
        break;
    }
    case NoticeCode::printer_warning:
    case NoticeCode::error_acknowledged:
    case NoticeCode::stop_point_ignored:
    case NoticeCode::entries_differ:
        break;
    case NoticeCode::taken_over:
    case NoticeCode::found_printing:
    case NoticeCode::nozzle_opening:
        event(event_kind::printer_notice, job, feeder::describe(notice));
        return;
    }
    event(event_kind::printer_warning, job, feeder::describe(notice));
}

} // namespace linefeed::service
