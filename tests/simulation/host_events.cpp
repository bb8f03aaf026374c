// What happens to a run: connections, bytes, completions, time; carried out in the order of link::PrinterLink and
// daemon::JobRun.
#include "host_run.hpp"
#include "session/line_fit.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::simulation {

using session::Effects;
using session::Session;

namespace {

constexpr Duration connect_timeout = std::chrono::seconds{3};
constexpr std::size_t usual_record_bytes = 40;

} // namespace

bool Host::is_current(std::uint64_t generation) const {
    return run_ && run_->generation == generation;
}

std::optional<feeder::Phase> Host::phase() const {
    return run_ ? std::optional{run_->session.feeder().phase()} : std::nullopt;
}

bool Host::all_sent() const {
    return run_ && !run_->session.feeder().refill().range().empty() && run_->session.feeder().refill().all_sent();
}

std::optional<Instant> Host::taken_over() const {
    return run_ ? run_->taken_over : std::nullopt;
}

void Host::begin_run(const std::optional<store::OpenIssue>& open, spool::JobId job, RecordRange wanted) {
    ++context_.counts.runs;
    const feeder::FeederPlan plan = store::make_plan(open, job, wanted);
    session::SessionSettings settings;
    settings.feeder.open_nozzle = context_.scenario.open_nozzle;
    settings.charsets.resize(context_.scenario.two_fields ? 2 : 1, protocol::Charset::latin1);
    settings.line.crc = context_.scenario.crc;
    session::fit_to_line(settings, usual_record_bytes);
    settings.feeder.level_at_most = changed_by_noise_.session.feeder.level_at_most;
    const std::uint64_t generation = ++generation_;
    run_ = std::make_unique<Run>(
        settings, plan,
        VirtualStore{context_, random_.fork(generation),
                     store::StoreWork{*spool_, store::LedgerKeeper{*spool_, job, wanted, "tcp://printer:3000", open}},
                     generation},
        generation);
    const bool reachable = !wire_.down();
    context_.after(reachable ? 2 * wire_.latency() : connect_timeout, EventKind::connected, generation,
                   reachable ? 1 : 0);
}

void Host::connected(std::uint64_t generation, std::uint64_t success) {
    if (!is_current(generation) || run_->finished) {
        return;
    }
    if (success == 0 || wire_.down()) {
        run_->finished = true;
        run_->outcome = {feeder::OutcomeCode::unreachable, {}, {}, false};
        run_->store.push(feeder::End{run_->outcome});
        return;
    }
    run_->connection = wire_.open();
    run_->open = true;
    call([](Session& session, Instant now, Effects& effects) { session.on_connected(now, effects); });
}

void Host::receive(std::uint64_t connection, std::string_view bytes) {
    if (!run_ || !run_->open || run_->connection != connection) {
        return;
    }
    if (paused()) {
        run_->inbox += bytes;
        return;
    }
    call([bytes](Session& session, Instant now, Effects& effects) { session.on_received(bytes, now, effects); });
}

void Host::link_closed(std::uint64_t connection) {
    if (!run_ || !run_->open || run_->connection != connection) {
        return;
    }
    if (paused()) {
        run_->peer_closed = true;
        return;
    }
    context_.trace.note(context_.now, "link lost");
    run_->open = false;
    wire_.host_closes(connection);
    call([](Session& session, Instant now, Effects& effects) { session.on_closed(now, effects); });
}

Instant Host::wake_at() const {
    if (!run_ || !run_->open || paused()) {
        return Instant::max();
    }
    const auto wake = run_->session.next_wake();
    return wake ? std::max(*wake, context_.now) : Instant::max();
}

void Host::wake() {
    call([](Session& session, Instant now, Effects& effects) { session.on_time(now, effects); });
}

void Host::pause(Duration duration) {
    if (run_ && !paused()) {
        paused_until_ = context_.now + duration;
        context_.after(duration, EventKind::host_resumes, run_->generation);
    }
}

void Host::resume(std::uint64_t generation) {
    if (!is_current(generation)) {
        return;
    }
    const std::uint64_t first = random_.below(2);
    for (std::uint64_t turn = 0; turn < 2 && is_current(generation) && run_->open; ++turn) {
        if ((first + turn) % 2 == 0) {
            const std::string bytes = std::exchange(run_->inbox, {});
            if (!bytes.empty()) {
                receive(run_->connection, bytes);
            }
        } else if (const auto wake_due = run_->session.next_wake(); wake_due && *wake_due <= context_.now) {
            wake();
        }
    }
    if (is_current(generation)) {
        take_replies();
    }
    if (is_current(generation) && run_->peer_closed) {
        link_closed(run_->connection);
    }
    if (is_current(generation)) {
        write_step(generation);
    }
}

void Host::store_done(std::uint64_t generation) {
    if (!is_current(generation)) {
        return;
    }
    run_->store.done();
    take_replies();
    if (is_current(generation)) {
        run_->store.wake();
        if (run_->finished && run_->store.ended()) {
            run_over();
        }
    }
}

void Host::store_wake(std::uint64_t generation) {
    if (is_current(generation)) {
        run_->store.wake();
    }
}

void Host::take_replies() {
    for (store::StoreReply& reply : run_->store.take_replies()) {
        run_->replies.push_back(std::move(reply));
    }
    const std::uint64_t generation = run_->generation;
    while (is_current(generation) && !paused() && !run_->replies.empty()) {
        const store::StoreReply reply = run_->replies.front();
        run_->replies.erase(run_->replies.begin());
        if (run_->finished) {
            continue;
        }
        call([&reply](Session& session, Instant now, Effects& effects) {
            store::deliver(reply, session, now, effects);
        });
        if (is_current(generation)) {
            push_cumulative();
        }
    }
}

void Host::run_over() {
    const feeder::Outcome outcome = run_->outcome;
    context_.trace.note(context_.now, "run ends", static_cast<std::uint64_t>(outcome.code), outcome.issued ? 1 : 0);
    wire_.host_closes(run_->connection);
    const std::string storage_failure = run_->store.failure();
    const feeder::Feeder& feeder = run_->session.feeder();
    daemon::RunProgress progress;
    progress.range = feeder.refill().range();
    progress.printed_through = feeder.refill().printed_through();
    progress.rate_per_s = feeder.rate();
    progress.fifo_depth = feeder.mail().depth;
    const bool noise_only = patience_.goes_on(outcome, progress, changed_by_noise_);
    run_.reset();
    steps_to_live_.reset();
    paused_until_ = {};
    if (!storage_failure.empty()) {
        if (RamDisk::instance().refusals() == refusals_before_) {
            judge_.violation("the storage failed without a fault: " + storage_failure);
        }
        end_process(feeder::OutcomeCode::storage_failed);
        return;
    }
    ending_.code = outcome.code;
    word_counts_ = word_counts_ && !outcome.issued;
    if (asked_about_) { // next_run() sees what has become of it
        next_run();
        return;
    }
    const bool doubt_to_settle = outcome.code == feeder::OutcomeCode::records_in_doubt && !outcome.issued;
    if (outcome.code != feeder::OutcomeCode::finished && !doubt_to_settle && !noise_only) {
        end_process(outcome.code);
    } else {
        next_run();
    }
}

void Host::slow_disk(Duration duration) {
    if (run_) {
        run_->store.slow_until(context_.now + duration);
    }
}

} // namespace linefeed::simulation
