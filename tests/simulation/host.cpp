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
    , wanted_(RecordRange::closed(RecordNumber{context.scenario.first()}, RecordNumber{context.scenario.last()}))
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

void Host::import_job() {
    const Scenario& scenario = context_.scenario;
    LINEFEED_ASSERT(open_spool());
    spool::JobSpec spec;
    spec.source.path = "/records.csv";
    spec.base = RecordNumber{scenario.base};
    auto import = spool_->begin_import(spec);
    LINEFEED_ASSERT(import.has_value());
    const protocol::MailRecordEncoder encoder{{protocol::Charset::latin1}, protocol::EscapeMode::backslash};
    RecordPage page;
    std::string text;
    for (std::uint32_t number = scenario.first(); number <= scenario.last(); ++number) {
        if (page.ends.empty()) {
            page.first = RecordNumber{number};
        }
        scenario.text_of(number, text);
        const std::size_t tab = text.find('\t');
        const std::array<std::string_view, 2> fields{std::string_view{text}.substr(0, tab),
                                                     tab == std::string::npos ? ""
                                                                              : std::string_view{text}.substr(tab + 1)};
        LINEFEED_ASSERT(
            encoder.append(page.frames, RecordNumber{number}, {fields.data(), tab == std::string::npos ? 1U : 2U})
                .has_value());
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
        if (page.ends.size() == scenario.page_records || number == scenario.last()) {
            LINEFEED_ASSERT(import->add(page).has_value());
            page.ends.clear();
            page.frames.clear();
        }
    }
    const auto job = import->commit("");
    LINEFEED_ASSERT(job.has_value());
    job_ = job->id;
}

void Host::start(const daemon::OperatorWord& word) {
    LINEFEED_ASSERT(!running());
    ++context_.counts.starts;
    context_.trace.note(context_.now, "program starts", word.given() ? 1 : 0);
    refusals_before_ = RamDisk::instance().refusals();
    word_ = word;
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
    next_run();
}

/// The loop of PrintCommand::print_runs(), and what print() tells behind it.
void Host::next_run() {
    while (!interrupted_) {
        auto open = store::find_open_issue(*spool_, job_);
        const auto state = spool_->ledger_state(job_);
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
            const auto job = spool_->job(job_);
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
        if (!*open && state->next_printable(wanted_).empty()) {
            break;
        }
        begin_run(*open);
        return;
    }
    const auto state = spool_->ledger_state(job_);
    const bool between_two_runs = interrupted_ && state && !state->next_printable(wanted_).empty();
    end_process(between_two_runs ? OutcomeCode::stop_requested : ending_.code);
}

void Host::end_process(OutcomeCode code) {
    context_.trace.note(context_.now, "program ends", static_cast<std::uint64_t>(code));
    context_.trace.say(context_.now, "told", feeder::to_string(code));
    ending_.code = code;
    ending_.in_doubt.clear();
    ending_.complete = false;
    records_open_ = true;
    knows_of_gap_ = false;
    if (spool_) {
        if (const auto state = spool_->ledger_state(job_)) {
            records_open_ = state->count(spool::RecordState::open) > RecordCount{0};
            const auto open = store::find_open_issue(*spool_, job_);
            knows_of_gap_ = open && *open && (*open)->facts.unclear;
            judge_.check_ledger(*state);
            ending_.in_doubt = state->ranges(spool::RecordState::in_doubt);
            for (const RecordRange& doubt : ending_.in_doubt) {
                context_.counts.in_doubt += doubt.count().value();
            }
            ending_.complete = state->next_printable(wanted_).empty() && ending_.in_doubt.empty() &&
                               state->count(spool::RecordState::open) == RecordCount{0};
            const bool told_complete = code == OutcomeCode::finished || code == OutcomeCode::nothing_to_print;
            if (told_complete) {
                judge_.check_finished(*state);
            }
        }
    }
    spool_.reset();
    RamDisk::instance().process_gone();
    context_.after(random_.spread(Duration{std::chrono::milliseconds{20}}, Duration{std::chrono::seconds{40}}),
                   EventKind::operator_acts);
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
    const auto state = spool_->ledger_state(job_);
    if (!state) {
        judge_.violation("the ledger cannot be read: " + state.error().message);
        return;
    }
    judge_.check_ledger(*state);
    judge_.check_finished(*state);
    // Issued = what the intents name = the sum of all states; here, all records.
    RecordCount issued;
    if (const auto rows = spool_->ledger_rows(job_, 0, 10'000'000)) {
        for (const spool::LedgerRow& row : *rows) {
            issued += row.entry.kind == spool::LedgerKind::intent ? row.entry.range.count() : RecordCount{0};
        }
    }
    RecordCount known;
    for (const spool::LedgerSegment& segment : state->segments()) {
        known += segment.range.count();
    }
    if (known != wanted_.count() || issued < known) {
        judge_.violation("the ledger's sum is wrong");
    }
    spool_.reset();
    RamDisk::instance().process_gone();
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
    ending_ = {OutcomeCode::link_lost, {}, false}; // the operator is told nothing
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
