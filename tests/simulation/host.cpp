#include "host.hpp"

#include "host_run.hpp"
#include "protocol/mail_record.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>

namespace linefeed::simulation {

using feeder::OutcomeCode;

namespace {

/// Only the lock of the spool is a real file; all else is on the RAM disk.
std::string spool_path() {
    static const struct Directory {
        std::string path =
            std::filesystem::temp_directory_path() / ("linefeed_simulation." + std::to_string(::getpid()));
        Directory() { std::filesystem::create_directory(path); }
        ~Directory() { std::filesystem::remove_all(path); }
    } directory;
    return directory.path + "/spool.db";
}

} // namespace

Host::Host(Context& context, Judge& judge, Wire& wire, Random random)
    : context_(context)
    , judge_(judge)
    , wire_(wire)
    , random_(random)
    , path_(spool_path()) {}

Host::~Host() {
    run_.reset();
    RamDisk::instance().stop_after(0);
}

bool Host::open_spool() {
    if (spool_) {
        return true;
    }
    auto opened = spool::Spool::open(
        path_, {[this] { return wall_ns_ + context_.now.time_since_epoch().count(); }, ram_disk_vfs});
    if (!opened) {
        context_.trace.say(context_.now, "spool", opened.error().message);
        return false;
    }
    spool_.emplace(std::move(*opened));
    return true;
}

void Host::import_jobs() {
    LINEFEED_ASSERT(open_spool());
    for (const ScenarioJob& job : context_.scenario.jobs) {
        import(job);
    }
}

void Host::import(const ScenarioJob& ids) {
    const Scenario& scenario = context_.scenario;
    spool::JobSpec spec;
    spec.source.path = "/records.csv";
    spec.base = RecordNumber{ids.first - ids.behind - 1};
    auto import = spool_->begin_import(spec);
    LINEFEED_ASSERT(import.has_value());
    const protocol::MailRecordEncoder encoder{{protocol::Charset::latin1}, protocol::EscapeMode::backslash};
    RecordPage page;
    std::string text;
    for (std::uint32_t id = ids.first; id <= ids.last; ++id) {
        const RecordNumber number{id - ids.behind};
        if (page.ends.empty()) {
            page.first = number;
        }
        scenario.text_of(id, text);
        const std::size_t tab = text.find('\t');
        const std::array<std::string_view, 2> fields{std::string_view{text}.substr(0, tab),
                                                     tab == std::string::npos ? ""
                                                                              : std::string_view{text}.substr(tab + 1)};
        LINEFEED_ASSERT(
            encoder.append(page.frames, number, {fields.data(), tab == std::string::npos ? 1U : 2U}).has_value());
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
        if (page.ends.size() == scenario.page_records || id == ids.last) {
            LINEFEED_ASSERT(import->add(page).has_value());
            page.ends.clear();
            page.frames.clear();
        }
    }
    const auto job = import->commit("");
    LINEFEED_ASSERT(job.has_value());
    jobs_.push_back({job->id, job->records, ids});
}

/// The first that is not over, as a rule; a person may resume another that was begun.
std::size_t Host::next_job() {
    std::vector<std::size_t> begun;
    std::size_t first = jobs_.size();
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
        const auto state = spool_->ledger_state(jobs_[i].id);
        if (!state) {
            return 0;
        }
        if (state->count(spool::RecordState::in_doubt) > RecordCount{0} && word_counts_ &&
            context_.scenario.jobs[i].first == word_for_.first) {
            return i;
        }
        const bool over = state->next_printable(jobs_[i].numbers).empty() &&
                          state->ranges(spool::RecordState::open).empty() &&
                          state->ranges(spool::RecordState::in_doubt).empty();
        if (!over && first == jobs_.size()) {
            first = i;
        }
        if (!over && !state->segments().empty()) {
            begun.push_back(i);
        }
    }
    const bool another = begun.size() > 1 && random_.chance(0.3);
    return another ? begun[random_.below(begun.size())] : std::min(first, jobs_.size() - 1);
}

void Host::start(const daemon::OperatorWord& word) {
    LINEFEED_ASSERT(!running());
    ++context_.counts.starts;
    context_.trace.note(context_.now, "program starts", word.given() ? 1 : 0);
    refusals_before_ = RamDisk::instance().refusals();
    word_ = word;
    word_for_ = ending_.doubted;
    word_counts_ = word.given();
    patience_ = {};
    changed_by_noise_ = {};
    interrupted_ = false;
    ending_ = Ending{};
    ending_.code = OutcomeCode::nothing_to_print;
    if (!open_spool()) {
        end_process(OutcomeCode::storage_failed);
        return;
    }
    at_work_ = next_job();
    next_run();
}

/// Those that may have records in the printer, before it is flushed (daemon::settle_other_jobs()). True if a run has
/// begun, or the program has ended.
bool Host::ask_about_others() {
    for (const Job& other : jobs_) {
        if (other.id == jobs_[at_work_].id) {
            continue;
        }
        auto open = store::find_open_issue(*spool_, other.id);
        if (!open) {
            end_process(OutcomeCode::storage_failed);
            return true;
        }
        if (*open && asked_about_ == other.id) {
            end_process(ending_.code); // asked, and it is as open as before
            return true;
        }
        if (*open) {
            begin_run(*open, other.id, {});
            asked_about_ = other.id;
            return true;
        }
    }
    asked_about_.reset();
    return false;
}

/// The next job of the queue, as service::Line does.
void Host::offer_follower() {
    for (std::size_t i = at_work_ + 1; i < jobs_.size() && !asked_about_; ++i) {
        const auto state = spool_->ledger_state(jobs_[i].id);
        if (state && state->segments().empty()) {
            offered_ = i;
            run_->store.push(store::OfferFollower{jobs_[i].id, jobs_[i].numbers});
            return;
        }
    }
}

/// The loop of PrintCommand::print_runs(), and what print() tells behind it.
void Host::next_run() {
    while (!interrupted_) {
        if (ask_about_others()) {
            return;
        }
        const spool::JobId id = jobs_[at_work_].id;
        auto open = store::find_open_issue(*spool_, id);
        const auto state = spool_->ledger_state(id);
        if (!open || !state) {
            end_process(OutcomeCode::storage_failed);
            return;
        }
        if (!*open && state->count(spool::RecordState::in_doubt) > RecordCount{0}) {
            ending_.code = OutcomeCode::records_in_doubt;
            if (!word_counts_) {
                break;
            }
            word_counts_ = false;
            const auto job = spool_->job(id);
            LINEFEED_ASSERT(job && *job);
            if (const auto settled = daemon::settle_by_operator(*spool_, **job, word_, "operator"); !settled) {
                if (settled.error().kind != FailureKind::usage) {
                    end_process(OutcomeCode::storage_failed);
                    return;
                }
                const bool asks_for_ranges =
                    !word_.last_printed.empty() && settled.error().message.find("--printed") != std::string::npos;
                if (!asks_for_ranges) {
                    judge_.violation("the operator's word was refused: " + settled.error().message);
                }
                ending_.word_refused = true;
                break;
            }
            ending_.code = OutcomeCode::nothing_to_print;
            continue;
        }
        const RecordRange wanted = jobs_[at_work_].numbers;
        if (!*open && state->next_printable(wanted).empty()) {
            break;
        }
        begin_run(*open, id, wanted);
        offer_follower();
        return;
    }
    const Job& job = jobs_[at_work_];
    const auto state = spool_->ledger_state(job.id);
    const bool between_two_runs = interrupted_ && state && !state->next_printable(job.numbers).empty();
    end_process(between_two_runs ? OutcomeCode::stop_requested : ending_.code);
}

void Host::end_process(OutcomeCode code) {
    context_.trace.note(context_.now, "program ends", static_cast<std::uint64_t>(code));
    context_.trace.say(context_.now, "told", feeder::to_string(code));
    ending_.code = code;
    ending_.in_doubt.clear();
    ending_.complete = false;
    records_open_ = !spool_;
    knows_of_gap_ = false;
    asked_about_.reset();
    if (spool_) {
        ending_.complete = true;
        for (const Job& job : jobs_) {
            look_at_ledger(job);
        }
        const auto state = spool_->ledger_state(jobs_[at_work_].id);
        const bool told_complete = code == OutcomeCode::finished || code == OutcomeCode::nothing_to_print;
        if (state && told_complete) {
            judge_.check_finished(*state);
        }
    }
    spool_.reset();
    RamDisk::instance().process_gone();
    context_.after(random_.spread(Duration{std::chrono::milliseconds{20}}, Duration{std::chrono::seconds{40}}),
                   EventKind::operator_acts);
}

void Host::look_at_ledger(const Job& job) {
    const auto state = spool_->ledger_state(job.id);
    const auto open = store::find_open_issue(*spool_, job.id);
    if (!state || !open) {
        records_open_ = true;
        ending_.complete = false;
        return;
    }
    records_open_ = records_open_ || *open;
    knows_of_gap_ = knows_of_gap_ || (*open && (*open)->facts.unclear);
    judge_.check_ledger(*state, job.ids);
    const std::vector<RecordRange> doubt = state->ranges(spool::RecordState::in_doubt);
    if (ending_.in_doubt.empty() && !doubt.empty()) {
        ending_.doubted = job.ids;
        for (const RecordRange& range : doubt) {
            ending_.in_doubt.push_back({range.first() + RecordCount{job.ids.behind}, range.count()});
            context_.counts.in_doubt += range.count().value();
        }
    }
    ending_.complete = ending_.complete && state->next_printable(job.numbers).empty() && doubt.empty() && !*open;
}

void Host::check_spool() {
    LINEFEED_ASSERT(!running());
    if (!open_spool()) {
        judge_.violation("the spool cannot be opened");
        return;
    }
    if (const auto verified = spool_->verify_ledger(); !verified) {
        judge_.violation("the ledger's chain is broken: " + verified.error().message);
    }
    for (const Job& job : jobs_) {
        check_spool(job);
    }
    spool_.reset();
    RamDisk::instance().process_gone();
}

void Host::check_spool(const Job& job) {
    const auto state = spool_->ledger_state(job.id);
    if (!state) {
        judge_.violation("the ledger cannot be read: " + state.error().message);
        return;
    }
    judge_.check_ledger(*state, job.ids);
    judge_.check_finished(*state);
    // Issued = what the intents name = the sum of all states; here, all records.
    RecordCount issued;
    if (const auto rows = spool_->ledger_rows(job.id, 0, 10'000'000)) {
        for (const spool::LedgerRow& row : *rows) {
            issued += row.entry.kind == spool::LedgerKind::intent ? row.entry.range.count() : RecordCount{0};
        }
    }
    RecordCount known;
    for (const spool::LedgerSegment& segment : state->segments()) {
        known += segment.range.count();
    }
    if (known != job.numbers.count() || issued < known) {
        judge_.violation("the ledger's sum is wrong");
    }
}

void Host::request_stop() {
    if (run_ && !run_->finished) {
        interrupted_ = true;
        call([](session::Session& session, Instant now, session::Effects& effects) {
            session.request_stop(now, effects);
        });
    }
}

void Host::kill(std::uint64_t in_steps) {
    if (!run_) {
        return;
    }
    if (in_steps > 0) {
        steps_to_live_ = in_steps;
    } else {
        die();
    }
}

void Host::die() {
    context_.trace.note(context_.now, "process dies");
    judge_.host_died();
    steps_to_live_.reset();
    effects_.clear();
    if (run_) {
        run_->store.die();
        wire_.host_closes(run_->connection);
    }
    RamDisk::instance().stop_after(0);
    run_.reset();
    spool_.reset();
    RamDisk::instance().process_gone();
    paused_until_ = {};
    ending_ = {}; // the operator is told nothing
    ending_.code = OutcomeCode::link_lost;
    asked_about_.reset();
    records_open_ = true;
    knows_of_gap_ = false;
    context_.after(random_.spread(Duration{std::chrono::milliseconds{50}}, Duration{std::chrono::seconds{60}}),
                   EventKind::operator_acts);
}

void Host::lose_power() {
    if (run_) {
        wire_.cut(false); // nobody sends a FIN
        die();
    }
    RamDisk::instance().lose_power(random_);
}

} // namespace linefeed::simulation
