#include "daemon/job_facts.hpp"

#include <algorithm>
#include <filesystem>

namespace linefeed::daemon {

using spool::RecordState;

spool::Ticket JobFacts::ticket_or_new() const {
    if (ticket) {
        return *ticket;
    }
    spool::Ticket fresh;
    fresh.job = job.id;
    fresh.name = std::filesystem::path{job.spec.source.path}.filename().string();
    fresh.created_by = "linefeed print";
    return fresh;
}

bool JobFacts::untouched() const {
    return std::ranges::all_of(
        ledger.segments(), [](const spool::LedgerSegment& segment) { return segment.state == RecordState::unused; });
}

std::string name_of(spool::JobId id) {
    return "job " + std::to_string(static_cast<std::int64_t>(id));
}

Result<JobFacts> read_facts(spool::Spool& spool, spool::JobId id) {
    auto job = spool.job(id);
    if (!job) {
        return job.error();
    }
    if (!*job) {
        return Failure{FailureKind::usage, "there is no " + name_of(id)};
    }
    return read_facts(spool, std::move(**job));
}

Result<JobFacts> read_facts(spool::Spool& spool, spool::Job job) {
    auto ticket = spool.ticket(job.id);
    if (!ticket) {
        return ticket.error();
    }
    auto ledger = job.records.empty() ? Result<spool::LedgerState>{spool::LedgerState{}} : spool.ledger_state(job.id);
    if (!ledger) {
        return ledger.error();
    }
    return JobFacts{std::move(job), std::move(*ticket), std::move(*ledger)};
}

JobPhase phase_of(const JobFacts& facts, std::optional<JobPhase> live) {
    if (live) {
        return *live;
    }
    if (facts.ticket && facts.ticket->cancelled) {
        return JobPhase::cancelled;
    }
    if (facts.job.state == spool::ImportState::importing && !facts.issued()) {
        return JobPhase::importing;
    }
    if (facts.in(RecordState::open) == RecordCount{0}) {
        if (facts.in(RecordState::in_doubt) > RecordCount{0}) {
            return JobPhase::in_doubt;
        }
        if (facts.job.state == spool::ImportState::ready && facts.next().empty()) {
            return JobPhase::finished;
        }
    }
    const bool waits = facts.ticket && facts.ticket->place && facts.untouched();
    if ((facts.issued() && !waits) || (facts.ticket && facts.ticket->begun)) {
        return JobPhase::stopped;
    }
    return facts.ticket && facts.ticket->place ? JobPhase::queued : JobPhase::ready;
}

namespace {

std::string message_of(const JobFacts& facts, JobPhase phase) {
    if (facts.job.state != spool::ImportState::ready && phase == JobPhase::stopped) {
        return "its import is not complete: go on with \"linefeed print\" and its file";
    }
    const bool stands = phase == JobPhase::stopped || phase == JobPhase::in_doubt || phase == JobPhase::cancelled;
    return stands && facts.ticket ? facts.ticket->message : std::string{};
}

} // namespace

JobView view_of(const JobFacts& facts, std::optional<JobPhase> live) {
    const spool::Ticket ticket = facts.ticket_or_new();
    JobView view;
    view.id = facts.job.id;
    view.name = ticket.name;
    view.source = facts.job.spec.source.path;
    view.printer = ticket.printer;
    view.layout = ticket.layout;
    view.phase = phase_of(facts, live);
    view.message = message_of(facts, view.phase);
    view.autostart = ticket.autostart;
    view.records = facts.job.records;
    view.printed = facts.in(RecordState::printed);
    view.in_doubt = facts.in(RecordState::in_doubt);
    view.open = facts.in(RecordState::open);
    view.skipped = facts.in(RecordState::skipped);
    for (const spool::LedgerSegment& segment : facts.ledger.segments()) {
        if (segment.state == RecordState::printed) {
            view.last_printed = segment.range.last();
        }
    }
    view.next = facts.next();
    view.created_ns = facts.job.created_ns;
    view.created_by = ticket.created_by;
    return view;
}

Result<JobView> JobViews::view(const JobFacts& facts, std::optional<JobPhase> live) {
    JobView view = view_of(facts, live);
    if (!facts.ticket || !facts.ticket->place) {
        return view;
    }
    const auto places = places_in(facts.printer());
    if (!places) {
        return places.error();
    }
    if (const auto found = (*places)->find(facts.job.id); found != (*places)->end()) {
        view.place = found->second;
    }
    return view;
}

Result<const JobViews::Places*> JobViews::places_in(const std::string& printer) {
    if (const auto known = queues_.find(printer); known != queues_.end()) {
        return &known->second;
    }
    const auto queue = spool_.queue(printer);
    if (!queue) {
        return queue.error();
    }
    Places places;
    for (const spool::Ticket& ticket : *queue) {
        places.emplace(ticket.job, static_cast<std::uint32_t>(places.size() + 1));
    }
    return &queues_.emplace(printer, std::move(places)).first->second;
}

} // namespace linefeed::daemon
