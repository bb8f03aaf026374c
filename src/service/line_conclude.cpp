// How a job on the line ends: what stands on its ticket, and which event tells it. The ledger says where it stands;
// here is only what a person needs besides.
#include "daemon/events.hpp"
#include "service/line.hpp"

namespace linefeed::service {

namespace event_kind = daemon::event_kind;
using feeder::OutcomeCode;

namespace {

bool shows_error(OutcomeCode code) {
    return code == OutcomeCode::printer_error || code == OutcomeCode::error_pending;
}

} // namespace

/// Why it ended, and what to do.
std::string Line::words_of(const Ending& ending) {
    if (ending.said) {
        return ending.words;
    }
    return feeder::describe(ending.outcome) + (ending.words.empty() ? "" : ": " + ending.words);
}

/// Writes down why the job at work ended.
void Line::conclude(const Ending& given) {
    Ending ending = given;
    ending.words = words_of(given);
    {
        const std::lock_guard lock{mutex_};
        last_ending_ = ending;
        supply_low_ = false;
    }
    if (shows_error(ending.outcome.code)) {
        event(event_kind::printer_error, ending.job, ending.words);
    }
    close_job(ending.job, ending.words);
}

/// Its ticket, and the event. `words` = why it stands, if it is not finished.
void Line::close_job(spool::JobId job, const std::string& words) {
    const auto after = services_.access.write([&](spool::Spool& spool) -> Result<JobFacts> {
        auto facts = read_facts(spool, job);
        if (!facts) {
            return facts;
        }
        spool::Ticket ticket = facts->ticket_or_new();
        const bool finished = phase_of(*facts, {}) == daemon::JobPhase::finished;
        ticket.begun = !finished;
        ticket.message = finished ? "" : words;
        if (finished) {
            ticket.place.reset();
        }
        auto written = spool.write_ticket(ticket);
        return written ? std::move(facts) : Result<JobFacts>{written.error()};
    });
    if (!after) {
        event(event_kind::storage_failed, job, after.error().message);
        return;
    }
    const daemon::JobView view = daemon::view_of(*after, {});
    switch (view.phase) {
    case daemon::JobPhase::finished:
        event(event_kind::job_finished, job, "every record is printed", view.last_printed);
        return;
    case daemon::JobPhase::in_doubt:
        event(event_kind::job_in_doubt, job, words, view.last_printed);
        return;
    default:
        event(event_kind::job_stopped, job, words, view.last_printed);
        return;
    }
}

} // namespace linefeed::service
