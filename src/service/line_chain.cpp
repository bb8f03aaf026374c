// One job behind the other without a stop of the line: the next one of the queue is claimed while the end of the job at
// work is near, offered to the run, and at work itself as soon as the run says so. A claimed job is on the line for all
// who look.
#include "daemon/events.hpp"
#include "daemon/line_use.hpp"
#include "service/line.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::service {

namespace event_kind = daemon::event_kind;
using daemon::JobPhase;

namespace {

/// Near enough to its end that the next job has to be at hand.
bool nears_end(const daemon::RunProgress& progress) {
    constexpr std::uint64_t least = 1024;
    constexpr double seconds = 10;
    if (!progress.printing || progress.range.empty()) {
        return false;
    }
    const RecordRange left = RecordRange::closed(progress.sent_through, progress.range.last());
    const auto ahead = static_cast<std::uint64_t>(progress.rate_per_s * seconds);
    return left.count() <= RecordCount{std::max(least, ahead) + 1};
}

} // namespace

FollowerWanted Line::follower_wanted(const spool::Job& job, const daemon::JobRunSettings& settings) {
    FollowerWanted wanted{.format = daemon::record_format(job),
                          .has_escapes = settings.session.escapes != protocol::EscapeMode::none};
    if (settings.printer.serial() != nullptr) {
        wanted.most_record_bytes = daemon::record_bytes(job);
    }
    return wanted;
}

Result<void> Line::take_follower(const spool::Job& job, spool::JobId behind,
                                 const std::function<Result<void>()>& write_down) {
    {
        const std::lock_guard lock{mutex_};
        if (!takes_follower(behind)) {
            return Failure{FailureKind::stopped, "nothing follows " + name_of(behind) + " without a stop"};
        }
        follower_ = Follower{job.id, job.records};
    }
    auto written = write_down();
    if (!written) {
        const std::lock_guard lock{mutex_};
        follower_.reset();
    }
    return written;
}

/// With mutex_ held.
bool Line::takes_follower(spool::JobId behind) const {
    const config::PrinterSettings* const own = settings_->printer(printer_);
    const bool chained = own != nullptr && own->queue.chain == config::Chain::seamless;
    return chained && active_ == behind && !follower_ && !finishing_ && !stop_requested_ && !held_ && !closing_;
}

std::vector<Line::Active> Line::on_line() const {
    const std::lock_guard lock{mutex_};
    if (!active_) {
        return {};
    }
    const bool printing = run_ != nullptr && run_->progress().printing;
    std::vector<Active> jobs{{*active_, printing ? JobPhase::printing : JobPhase::arming}};
    if (follower_) {
        jobs.push_back({follower_->job, JobPhase::arming});
    }
    if (finishing_) {
        jobs.push_back({*finishing_, JobPhase::printing});
    }
    if (stop_requested_) {
        std::ranges::for_each(jobs, [](Active& job) { job.phase = JobPhase::stopping; });
    }
    return jobs;
}

spool::JobId Line::at_work() const {
    const std::lock_guard lock{mutex_};
    return active_.value();
}

/// Now and then while a run is under way.
void Line::look_after_chain(daemon::JobRun& run, const FollowerWanted& wanted) {
    const daemon::RunProgress progress = run.progress();
    follow(progress);
    conclude_earlier({});
    look_for_follower(run, progress, wanted);
}

/// The follower is at work as soon as the run says so.
void Line::follow(const daemon::RunProgress& progress) {
    spool::JobId before{};
    {
        const std::lock_guard lock{mutex_};
        if (!follower_ || follower_->job != progress.job) {
            return;
        }
        before = active_.value();
        finishing_ = active_;
        active_ = follower_->job;
        records_ = follower_->records;
        follower_.reset();
        supply_low_ = false;
    }
    event(event_kind::job_started, progress.job, "follows " + name_of(before) + " without a stop of the line");
    event(event_kind::job_printing, progress.job, "printing");
}

/// A job may be dropped in the last second: until there is one, it is looked for again and again.
void Line::look_for_follower(daemon::JobRun& run, const daemon::RunProgress& progress, FollowerWanted wanted) {
    constexpr auto pause = std::chrono::seconds{1};
    const auto now = std::chrono::steady_clock::now();
    const bool takes = [&] {
        const std::lock_guard lock{mutex_};
        return takes_follower(progress.job);
    }();
    if (!takes || now < claim_at_ || !nears_end(progress)) {
        return;
    }
    wanted.behind = progress.job;
    wanted.run = progress.range;
    const auto claimed = services_.claim_follower(printer_, wanted);
    if (!claimed) {
        claim_at_ = now + pause;
        return;
    }
    event(event_kind::printer_notice, claimed->job.id,
          "is to follow " + name_of(wanted.behind) + " without a stop of the line");
    const std::lock_guard lock{mutex_};
    if (!stop_requested_) {
        run.offer_follower(claimed->job);
    }
}

/// The job before the one at work is over when the ledger says so, which may take a moment. `words` = those of the run,
/// behind whose end the ledger will not say more.
void Line::conclude_earlier(const std::optional<std::string>& words) {
    const auto job = [this] {
        const std::lock_guard lock{mutex_};
        return finishing_;
    }();
    if (!job) {
        return;
    }
    if (!words) {
        const auto facts = services_.access.read([&](spool::Spool& spool) { return read_facts(spool, *job); });
        if (!facts || phase_of(*facts, {}) != JobPhase::finished) {
            return;
        }
    }
    close_job(*job, words.value_or(std::string{}));
    const std::lock_guard lock{mutex_};
    finishing_.reset();
}

/// The run has ended by noise just behind the end of the job: the follower, which has begun, goes on by itself.
bool Line::goes_on_with_follower() {
    daemon::RunProgress progress;
    {
        const std::lock_guard lock{mutex_};
        if (!follower_) {
            return false;
        }
        progress.job = follower_->job;
    }
    follow(progress);
    conclude_earlier(std::string{});
    return true;
}

/// A follower that is not at work when the run is over waits in its queue as before, if nothing of it can be on a
/// product. Otherwise it stands; but where the run goes on at once, what it finds out is waited for.
void Line::let_go_of_follower(const Ending& ending, const std::string& words) {
    const auto follower = [this] {
        const std::lock_guard lock{mutex_};
        return follower_;
    }();
    if (!follower) {
        return;
    }
    const auto released = services_.access.write([&](spool::Spool& spool) -> Result<bool> {
        const auto facts = read_facts(spool, follower->job);
        if (!facts || !facts->untouched()) {
            return facts ? Result<bool>{false} : facts.error();
        }
        spool::Ticket ticket = facts->ticket_or_new();
        ticket.begun = false;
        ticket.message.clear();
        auto written = spool.write_ticket(ticket);
        return written ? Result<bool>{true} : written.error();
    });
    if (!released) {
        event(event_kind::storage_failed, follower->job, released.error().message);
    } else if (*released) {
        event(event_kind::printer_notice, follower->job, "does not follow without a stop: it waits in its queue again");
    } else if (ending.noise_only) {
        return;
    } else {
        close_job(follower->job, words);
    }
    const std::lock_guard lock{mutex_};
    follower_.reset();
}

} // namespace linefeed::service
