// What comes before a run: the printer is the one that is meant, nothing of another job is left in it that only it
// knows of, and it is ready.
#include "daemon/events.hpp"
#include "daemon/other_jobs.hpp"
#include "daemon/record_text.hpp"
#include "service/line.hpp"

namespace linefeed::service {

namespace event_kind = daemon::event_kind;
using feeder::OutcomeCode;

namespace {

/// The nearest word for what the look at the printer has found.
OutcomeCode outcome_of(const daemon::Finding& finding) {
    if (finding.check == "reachable") {
        return OutcomeCode::unreachable;
    }
    if (finding.check == "cover") {
        return OutcomeCode::cover_open;
    }
    return finding.check == "errors" ? OutcomeCode::error_pending : OutcomeCode::not_ready;
}

} // namespace

/// What other jobs may still have in the printer is found out before it is flushed: by the machine that they were sent
/// to, as any other would know nothing of them. What stands in the way; absent = nothing does.
Result<std::optional<Ending>> Line::ask_about_others(const spool::Job& job) {
    const SharedSettings all = settings();
    const config::PrinterSettings* const own = all->printer(printer_);
    const auto others = own == nullptr ? Result<std::vector<spool::JobId>>{std::vector<spool::JobId>{}}
                                       : daemon::other_jobs(services_.threads, job.id, link::to_string(own->address));
    if (!others || others->empty()) {
        return others ? Result<std::optional<Ending>>{std::nullopt} : others.error();
    }
    if (auto stranger = check_identity(job); !stranger || *stranger) {
        return stranger;
    }
    const auto settings = run_settings(job);
    if (!settings) {
        return settings.error();
    }
    const auto hindrance = daemon::settle_other_jobs(
        services_.threads, services_.spool, job.id, *settings, [&](daemon::JobRun& run, spool::JobId other) {
            event(event_kind::printer_notice, other, "may have records in this printer: asking how far it came");
            watch(run, [] {});
        });
    for (const spool::JobId other : *others) {
        take_note_of(other);
    }
    if (!hindrance) {
        return hindrance.error();
    }
    return *hindrance ? std::optional{Ending{job.id, (*hindrance)->outcome, (*hindrance)->detail}} : std::nullopt;
}

/// The printer has been asked about a job that was not over: now it may be, or nobody knows.
void Line::take_note_of(spool::JobId other) {
    const auto phase = services_.access.write([other](spool::Spool& spool) -> Result<daemon::JobPhase> {
        const auto facts = read_facts(spool, other);
        if (!facts) {
            return facts.error();
        }
        const daemon::JobPhase now = phase_of(*facts, {});
        if (!facts->ticket || (now != daemon::JobPhase::finished && now != daemon::JobPhase::in_doubt)) {
            return now;
        }
        spool::Ticket ticket = *facts->ticket;
        const bool finished = now == daemon::JobPhase::finished;
        ticket.begun = !finished;
        ticket.message = finished ? "" : "the printer was asked, and does not know either: say which are printed";
        if (finished) {
            ticket.place.reset();
        }
        auto written = spool.write_ticket(ticket);
        return written ? Result<daemon::JobPhase>{now} : written.error();
    });
    if (!phase) {
        event(event_kind::storage_failed, other, phase.error().message);
    } else if (*phase == daemon::JobPhase::finished) {
        event(event_kind::job_finished, other, "every record was printed before this job was interrupted");
    } else if (*phase == daemon::JobPhase::in_doubt) {
        event(event_kind::job_in_doubt, other, "nobody knows which of its last records are printed: say which are");
    }
}

/// Whether the machine is the one that is meant, as far as it tells.
Result<std::optional<Ending>> Line::check_identity(const spool::Job& job) {
    const auto client = client_settings();
    if (!client) {
        return client.error();
    }
    const auto version = look_for_identity(*client);
    if (!version) {
        return std::optional<Ending>{}; // whatever is wrong, asking finds it out too
    }
    const SharedSettings all = settings();
    const daemon::Finding finding =
        daemon::judge_identity(*version, {*all, *all->printer(printer_), known_serial_number()});
    // What is only worth a warning the look before the start finds once more.
    return finding.severity == daemon::Severity::problem ? tell({finding}, job.id) : std::nullopt;
}

/// The look at the printer before the start. What stands in the way; absent = nothing does.
Result<std::optional<Ending>> Line::check_printer(const spool::Job& job, bool may_be_printing) {
    const auto client = client_settings();
    if (!client) {
        return client.error();
    }
    {
        const std::lock_guard lock{mutex_};
        checking_ = true;
    }
    const auto have_escapes = [this, id = job.id] {
        const auto found = services_.access.read([id](spool::Spool& spool) { return spool.has_escapes(id); });
        return !found || *found;
    };
    const std::vector<daemon::Finding> findings =
        look_at_printer(*client, {.may_be_printing = may_be_printing,
                                  .records = {.have_escapes = have_escapes,
                                              .have_properties = daemon::record_format(job).properties,
                                              .bytes = daemon::record_bytes(job)}});
    {
        const std::lock_guard lock{mutex_};
        checking_ = false;
        if (heard_.machine) {
            watch_.heard(*heard_.machine);
        }
    }
    return tell(findings, job.id);
}

/// Each finding that is not good is told. What stands in the way of the job; absent = nothing does.
std::optional<Ending> Line::tell(const std::vector<daemon::Finding>& findings, spool::JobId job) {
    std::optional<Ending> ending;
    for (const daemon::Finding& finding : findings) {
        const std::string words = finding.words + (finding.advice.empty() ? "" : ". " + finding.advice);
        switch (finding.severity) {
        case daemon::Severity::ok:
            break;
        case daemon::Severity::warning:
            event(event_kind::printer_warning, job, words);
            break;
        case daemon::Severity::problem:
            event(event_kind::printer_error, job, words);
            if (!ending) {
                ending = Ending{job, {.code = outcome_of(finding), .issued = false}, words, true};
            }
            break;
        }
    }
    return ending;
}

} // namespace linefeed::service
