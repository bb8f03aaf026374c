// What moves jobs: into queues, onto lines and off them again, by the word of an operator or, where both the queue and
// the job allow it, by itself. Only a job that was never begun starts by itself, and only while nothing else of its
// printer has been begun and is not over.
#include "daemon/events.hpp"
#include "daemon/record_text.hpp"
#include "service/service.hpp"
#include "store/ledger_keeper.hpp"

#include <algorithm>

namespace linefeed::service {

namespace event_kind = daemon::event_kind;
using daemon::Caller;
using daemon::JobPhase;

namespace {

Failure wrong(const std::string& message) {
    return {FailureKind::usage, message};
}

} // namespace

Result<JobFacts> Service::facts_of_idle(spool::JobId id) {
    if (live_phase(id)) {
        return Failure{FailureKind::stopped, name_of(id) + " is on the line: stop it first"};
    }
    return access_.write([id](spool::Spool& spool) { return read_facts(spool, id); });
}

Result<void> Service::check_startable(const JobFacts& facts) {
    const std::string name = name_of(facts.job.id);
    const JobPhase phase = phase_of(facts, {});
    switch (phase) {
    case JobPhase::ready:
    case JobPhase::queued:
    case JobPhase::stopped:
        break;
    case JobPhase::importing:
    case JobPhase::failed:
        return Failure{FailureKind::stopped, name + " is not imported to its end"};
    case JobPhase::in_doubt:
        return Failure{FailureKind::in_doubt, name + " has " +
                                                  std::to_string(facts.in(spool::RecordState::in_doubt).value()) +
                                                  " records in doubt: say which of them are printed, then resume it"};
    case JobPhase::finished:
        return wrong("every record of " + name + " is printed: name those that are to be printed again");
    case JobPhase::cancelled:
        return wrong(name + " is cancelled: queue it again first");
    case JobPhase::arming:
    case JobPhase::printing:
    case JobPhase::stopping:
        return Failure{FailureKind::stopped, name + " is on the line already"};
    }
    if (facts.job.state != spool::ImportState::ready) {
        return wrong(name + " is not imported to its end: go on with \"linefeed print\" and its file");
    }
    if (facts.printer().empty()) {
        return wrong(name + " belongs to no printer yet: queue it at one");
    }
    auto fits = check_fits(facts, facts.printer());
    return fits ? check_open_records(facts, facts.printer()) : fits;
}

/// Records that may be in a printer are asked for there, whatever it is called now: another line that asked for them
/// would write the same job, and learn nothing.
Result<void> Service::check_open_records(const JobFacts& facts, const std::string& printer) {
    if (facts.in(spool::RecordState::open) == RecordCount{0}) {
        return {};
    }
    const spool::JobId id = facts.job.id;
    const auto open = access_.write([id](spool::Spool& spool) { return store::find_open_issue(spool, id); });
    if (!open || !*open) {
        return open ? Result<void>{} : open.error();
    }
    const SharedSettings now = settings();
    for (const config::PrinterSettings& own : now->printers) {
        if (link::to_string(own.address) == (*open)->printer) {
            return own.name == printer ? Result<void>{}
                                       : wrong(name_of(id) + " may have records in printer " + own.name +
                                               ": it belongs to that printer until they are found out about");
        }
    }
    if (facts.printer().empty() || facts.printer() == printer) {
        return {}; // it may have another address now: its serial number tells
    }
    return wrong(name_of(id) + " may have records in the printer at " + (*open)->printer + ": it belongs to " +
                 facts.printer());
}

Result<void> Service::check_fits(const JobFacts& facts, const std::string& printer) {
    const config::PrinterSettings* const own = settings()->printer(printer);
    if (own == nullptr) {
        return wrong("printer " + printer + " is not in the settings any more: queue the job at another");
    }
    // Records without escapes mean the same everywhere. Of an automatic profile the printer tells at the start.
    if (daemon::record_format(facts.job).escapes != protocol::EscapeMode::backslash ||
        own->profile.escapes != protocol::EscapeMode::none ||
        (protocol::is_automatic(own->profile) && !own->profile.own.escapes)) {
        return {};
    }
    const auto escapes = access_.read([&](spool::Spool& spool) { return spool.has_escapes(facts.job.id); });
    if (!escapes) {
        return escapes.error();
    }
    if (*escapes) {
        return wrong(name_of(facts.job.id) + " was imported for another firmware than that of " + printer + " (" +
                     to_string(own->profile) + "): import its file again for this printer");
    }
    return {};
}

/// Writes down that it is begun before anything is: whatever happens next, it will not start by itself again.
Result<void> Service::begin(spool::JobId id, StartedBy who) {
    if (closing_) {
        return Failure{FailureKind::stopped, "the service is ending"};
    }
    if (live_phase(id)) {
        return Failure{FailureKind::stopped, name_of(id) + " is on the line already"};
    }
    const auto facts = facts_of_idle(id);
    if (!facts) {
        return facts.error();
    }
    if (auto startable = check_startable(*facts); !startable) {
        return startable;
    }
    const auto line = known_line(facts->printer());
    if (!line) {
        return line.error();
    }
    if (const auto active = (*line)->active()) {
        return Failure{FailureKind::stopped,
                       "printer " + facts->printer() + " is at " + name_of(active->job) + ": stop it first"};
    }
    const auto write_down = [&] {
        return access_.write([&](spool::Spool& spool) -> Result<void> {
            spool::Ticket ticket = facts->ticket_or_new();
            const auto first = spool.first_place(ticket.printer);
            if (!first) {
                return first.error();
            }
            ticket.place = *first;
            ticket.begun = true;
            ticket.message = interrupted_words;
            auto done = spool.write_ticket(ticket);
            return done && who == StartedBy::person ? spool.hold_printer(ticket.printer, false) : done;
        });
    };
    if (auto started = (*line)->start(id, who, write_down); !started) {
        return started;
    }
    event(event_kind::job_started, facts->printer(), id, "its start has begun");
    return {};
}

Result<void> Service::start(const Caller& caller, spool::JobId id) {
    return audited(caller, {"start", name_of(id)}, [&] {
        const std::lock_guard lock{orders_};
        return begin(id, StartedBy::person);
    });
}

Result<spool::JobId> Service::start_next(const Caller& caller, std::string_view printer) {
    const std::string name{printer};
    return audited(caller, {"start", "printer " + name}, [&]() -> Result<spool::JobId> {
        const std::lock_guard lock{orders_};
        if (const auto line = known_line(name); !line) {
            return line.error();
        }
        const auto queue = access_.write([&](spool::Spool& spool) { return spool.queue(name); });
        if (!queue) {
            return queue.error();
        }
        std::string why = "the queue of printer " + name + " is empty";
        for (const spool::Ticket& ticket : *queue) {
            const auto facts = access_.write([&](spool::Spool& spool) { return read_facts(spool, ticket.job); });
            if (!facts) {
                return facts.error();
            }
            if (phase_of(*facts, live_phase(ticket.job)) == JobPhase::in_doubt) {
                why =
                    name_of(ticket.job) + " has records in doubt: say which of them are printed, or start another job";
                break; // who skips it should do so knowingly
            }
            auto begun = begin(ticket.job, StartedBy::person);
            return begun ? Result<spool::JobId>{ticket.job} : begun.error();
        }
        return wrong(why);
    });
}

Result<void> Service::stop(const Caller& caller, std::string_view printer) {
    const std::string name{printer};
    return audited(caller, {"stop", "printer " + name}, [&]() -> Result<void> {
        const auto line = known_line(name);
        if (!line) {
            return line.error();
        }
        const bool idle = (*line)->idle();
        (*line)->hold(); // even if it is idle: what a queue has begun meanwhile is stopped as well
        const auto ending = (*line)->wait_until_idle();
        const auto written = access_.write(
            [&](spool::Spool& spool) { return (*line)->held() ? spool.hold_printer(name, true) : Result<void>{}; });
        if (!written) {
            event(event_kind::storage_failed, name, {}, written.error().message);
        }
        if (idle) {
            return {};
        }
        using feeder::OutcomeCode;
        const OutcomeCode code = ending ? ending->outcome.code : OutcomeCode::stop_requested;
        const bool stands =
            code != OutcomeCode::did_not_stop && code != OutcomeCode::no_answer && code != OutcomeCode::link_lost;
        return stands ? Result<void>{} : Failure{FailureKind::unreachable, ending->words};
    });
}

Result<void> Service::put_into_queue(spool::JobId id, const std::string& printer) {
    if (const auto known = known_line(printer); !known) {
        return known.error();
    }
    const auto facts = facts_of_idle(id);
    if (!facts) {
        return facts.error();
    }
    const std::string before = facts->printer();
    if (phase_of(*facts, {}) == JobPhase::finished) {
        return wrong("every record of " + name_of(id) + " is printed: name those that are to be printed again");
    }
    if (facts->in(spool::RecordState::open) > RecordCount{0}) {
        if (auto there = check_open_records(*facts, printer); !there) {
            return there;
        }
    } else if (facts->issued() && before != printer && line(before) != nullptr) {
        return wrong(name_of(id) + " has been printed on " + before + ": it belongs to that printer");
    }
    if (auto fits = check_fits(*facts, printer); !fits) {
        return fits;
    }
    auto written = access_.write([&](spool::Spool& spool) -> Result<void> {
        const auto last = spool.last_place(printer);
        if (!last) {
            return last.error();
        }
        spool::Ticket ticket = facts->ticket_or_new();
        ticket.printer = printer;
        ticket.place = *last;
        ticket.begun = ticket.begun || facts->issued();
        ticket.cancelled = false;
        return spool.write_ticket(ticket);
    });
    if (written) {
        event(event_kind::job_queued, printer, id, "waits at printer " + printer);
    }
    return written;
}

Result<void> Service::enqueue(const Caller& caller, spool::JobId id, std::string_view printer) {
    const std::string name{printer};
    auto done = audited(caller, {"queue", name_of(id), spool::JsonObject{}.add("printer", name)}, [&] {
        const std::lock_guard lock{orders_};
        return put_into_queue(id, name);
    });
    if (done) {
        look_for_work(name);
    }
    return done;
}

Result<void> Service::cancel(const Caller& caller, spool::JobId id) {
    std::string printer;
    auto done = audited(caller, {"cancel", name_of(id)}, [&]() -> Result<void> {
        const std::lock_guard lock{orders_};
        const auto facts = facts_of_idle(id);
        if (!facts) {
            return facts.error();
        }
        if (phase_of(*facts, {}) == JobPhase::finished) {
            return wrong("every record of " + name_of(id) + " is printed: there is nothing to cancel");
        }
        printer = facts->printer();
        spool::Ticket ticket = facts->ticket_or_new();
        ticket.cancelled = true;
        ticket.begun = false;
        ticket.place.reset();
        ticket.message = "cancelled by " + caller.name;
        auto written = access_.write([&](spool::Spool& spool) { return spool.write_ticket(ticket); });
        if (written) {
            event(event_kind::job_cancelled, printer, id, ticket.message);
        }
        return written;
    });
    if (done) {
        look_for_work(printer);
    }
    return done;
}

Result<std::optional<spool::JobId>> Service::next_by_itself(const std::string& printer) {
    return access_.write([&](spool::Spool& spool) -> Result<std::optional<spool::JobId>> {
        const auto stands = spool.has_begun_job(printer);
        const auto first = spool.first_in_queue(printer);
        if (!stands || !first) {
            return stands ? first.error() : stands.error();
        }
        const bool starts = !*stands && *first && (*first)->autostart;
        return starts ? std::optional{(*first)->job} : std::nullopt;
    });
}

void Service::look_for_work(const std::string& printer) {
    const std::lock_guard lock{orders_};
    if (closing_) {
        return; // the lines may be going already
    }
    const SharedSettings now = settings();
    const config::PrinterSettings* const own = now->printer(printer);
    const LinePtr at = line(printer);
    if (own == nullptr || !own->queue.autostart || !at || !at->idle() || at->held()) {
        return;
    }
    const auto next = next_by_itself(printer);
    if (!next || !*next) {
        return;
    }
    const auto begun =
        audited(Caller{"linefeedd"}, {"start", name_of(**next)}, [&] { return begin(**next, StartedBy::itself); });
    if (!begun) {
        hold_back(**next, begun.error());
    }
}

void Service::leave_to_a_person(const std::string& printer, const std::string& words) {
    const std::lock_guard lock{orders_};
    const config::PrinterSettings* const own = settings()->printer(printer);
    const LinePtr at = line(printer);
    if (own != nullptr && own->queue.autostart && at && !at->held()) {
        at->hold_queue();
        event(event_kind::printer_notice, printer, {},
              words + ": nothing starts by itself until somebody starts a job");
    }
}

/// It cannot start, and would be tried again and again: an operator has to look at it.
void Service::hold_back(spool::JobId id, const Failure& why) {
    static_cast<void>(access_.write([&](spool::Spool& spool) -> Result<void> {
        auto ticket = spool.ticket(id);
        if (!ticket || !*ticket) {
            return {};
        }
        (*ticket)->begun = true;
        (*ticket)->message = why.message;
        return spool.write_ticket(**ticket);
    }));
    event(event_kind::job_stopped, {}, id, why.message);
}

} // namespace linefeed::service
