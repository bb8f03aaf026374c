// What there is to see of the service as a whole: its state, printers, folders, events and the audit log; and the
// answers that it remembers.
#include "daemon/wall_clock.hpp"
#include "service/service.hpp"

#include <algorithm>
#include <chrono>

namespace linefeed::service {

using daemon::Finding;
using daemon::Severity;

namespace {

constexpr auto answers_kept = std::chrono::hours{24};

std::int64_t oldest_answer_ns() {
    return daemon::wall_clock_ns() - std::chrono::nanoseconds{answers_kept}.count();
}

Finding finding(std::string check, bool good, std::string words, std::string advice) {
    return {std::move(check), good ? Severity::ok : Severity::problem, std::move(words), good ? "" : std::move(advice)};
}

/// What would keep it from printing now, the worst first.
Finding finding_of(const daemon::PrinterView& printer) {
    const std::string check = "printer " + printer.name;
    const auto warning = [&](std::string words, std::string advice) {
        return Finding{check, Severity::warning, std::move(words), std::move(advice)};
    };
    if (printer.watched && printer.link == daemon::LinkState::down) {
        return warning("does not answer at " + printer.address,
                       "look whether the printer is switched on, and at its network");
    }
    if (!printer.error.none()) {
        return warning("error " + protocol::describe(printer.error) +
                           (printer.error_meaning.empty() ? "" : ": " + printer.error_meaning),
                       printer.error_advice.empty() ? "see the printer's panel" : printer.error_advice);
    }
    if (printer.cover_open.value_or(false)) {
        return warning("the head cover is open", "close it before the next start");
    }
    if (!printer.warnings.empty()) {
        return warning(printer.warnings.front(), "linefeed printer " + printer.name + " tells more");
    }
    return {check, Severity::ok, std::string{to_string(printer.phase)}, ""};
}

} // namespace

daemon::ServiceStatus Service::status() {
    daemon::ServiceStatus status;
    status.version = version_;
    status.started_ns = started_ns_;
    status.real_time = real_time_;
    const auto writable = access_.write([](spool::Spool& spool) { return spool.writable(); });
    status.checks.push_back(finding("storage", writable.has_value(),
                                    writable ? "the spool can be written" : writable.error().message,
                                    "see to the disk, then start linefeedd again"));
    const bool closing = ending_;
    status.checks.push_back(finding("service", !closing, closing ? "the service is ending" : "running", "wait"));
    status.ready = writable.has_value() && !closing;
    for (const daemon::FolderView& folder : folders()) {
        status.checks.push_back({"folder " + folder.name, folder.works ? Severity::ok : Severity::warning,
                                 folder.works ? folder.path.string() : folder.message,
                                 folder.works ? "" : "see to the folder: it is tried again every few seconds"});
    }
    for (const LinePtr& line : lines()) {
        status.checks.push_back(finding_of(line->view()));
    }
    return status;
}

daemon::ServiceMetrics Service::metrics() {
    daemon::ServiceMetrics metrics;
    metrics.intake_records = counts_.records;
    metrics.intake_files_imported = counts_.imported;
    metrics.intake_files_duplicate = counts_.duplicates;
    metrics.intake_files_failed = counts_.failed;
    for (const LinePtr& line : lines()) {
        metrics.printers.push_back(daemon::metrics_of(line->printer(), line->meters()));
    }
    metrics.ledger_commit = daemon::view(store_.commit_times());
    return metrics;
}

std::vector<daemon::PrinterView> Service::printers() {
    std::vector<daemon::PrinterView> views;
    for (const LinePtr& line : lines()) {
        if (auto view = printer(line->printer())) {
            views.push_back(std::move(*view));
        }
    }
    return views;
}

std::optional<daemon::PrinterView> Service::printer(std::string_view name) {
    const LinePtr found = line(name);
    if (!found) {
        return std::nullopt;
    }
    daemon::PrinterView view = found->view();
    const auto queue = access_.read([&](spool::Spool& spool) { return spool.queue(found->printer()); });
    if (queue) {
        std::ranges::transform(*queue, std::back_inserter(view.queue), &spool::Ticket::job);
    } else {
        view.warnings.push_back(queue.error().message);
    }
    return view;
}

std::vector<daemon::FolderView> Service::folders() {
    std::vector<FolderPtr> all;
    {
        const std::lock_guard lock{parts_mutex_};
        all = folders_;
    }
    std::vector<daemon::FolderView> views;
    for (const FolderPtr& folder : all) {
        views.push_back(folder->view());
    }
    return views;
}

Result<std::vector<daemon::EventView>> Service::events(std::uint64_t after, std::size_t limit) {
    return access_.read([&](spool::Spool& spool) -> Result<std::vector<daemon::EventView>> {
        auto events = spool.events(after, limit);
        if (!events) {
            return events.error();
        }
        std::vector<daemon::EventView> views;
        views.reserve(events->size());
        for (spool::Event& event : *events) {
            views.push_back({event.id, event.time_ns, std::move(event.kind), std::move(event.printer), event.job,
                             event.record, std::move(event.message)});
        }
        return views;
    });
}

Result<std::uint64_t> Service::last_event() {
    return access_.read([](spool::Spool& spool) { return spool.last_event(); });
}

Result<std::uint64_t> Service::last_audit() {
    return access_.read([](spool::Spool& spool) { return spool.last_audit(); });
}

std::uint64_t Service::subscribe(std::function<void()> on_events) {
    return events_.subscribe(std::move(on_events));
}

void Service::unsubscribe(std::uint64_t subscription) {
    events_.unsubscribe(subscription);
}

Result<std::vector<daemon::AuditView>> Service::audit(std::uint64_t after, std::size_t limit) {
    return access_.read([&](spool::Spool& spool) -> Result<std::vector<daemon::AuditView>> {
        auto entries = spool.audit(after, limit);
        if (!entries) {
            return entries.error();
        }
        std::vector<daemon::AuditView> views;
        views.reserve(entries->size());
        for (spool::AuditEntry& entry : *entries) {
            views.push_back({entry.id, entry.time_ns, std::move(entry.who), std::move(entry.what),
                             std::move(entry.object), std::move(entry.detail), entry.done});
        }
        return views;
    });
}

Result<std::optional<daemon::Operations::Remembered>> Service::remembered(const daemon::Caller& caller,
                                                                          std::string_view key) {
    auto answer = access_.write(
        [&](spool::Spool& spool) { return spool.answer(caller.name, std::string{key}, oldest_answer_ns()); });
    if (!answer) {
        return answer.error();
    }
    if (!*answer) {
        return std::optional<Remembered>{};
    }
    return std::optional{Remembered{std::move((*answer)->request_hash), (*answer)->status, std::move((*answer)->body)}};
}

Result<void> Service::remember(const daemon::Caller& caller, std::string_view key, const Remembered& answer) {
    const spool::Answer kept{answer.request_hash, answer.status, answer.body};
    return access_.write([&](spool::Spool& spool) {
        return spool.keep_answer(caller.name, std::string{key}, kept, daemon::wall_clock_ns(), oldest_answer_ns());
    });
}

} // namespace linefeed::service
