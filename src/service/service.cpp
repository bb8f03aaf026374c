#include "service/service.hpp"

#include "base/assert.hpp"
#include "daemon/events.hpp"
#include "daemon/wall_clock.hpp"

#include <chrono>

namespace linefeed::service {

namespace event_kind = daemon::event_kind;
using daemon::JobPhase;

Service::Service(ServiceOptions options, spool::Spool spool)
    : load_(std::move(options.load))
    , take_over_(std::move(options.take_over))
    , version_(std::move(options.version))
    , started_ns_(daemon::wall_clock_ns())
    , files_since_ns_(daemon::file_clock_ns())
    , spool_(std::move(spool))
    , feed_(options.settings.real_time)
    , store_(spool_)
    , access_(store_, options.settings.spool)
    , events_(store_, std::move(options.listen))
    , settings_(std::make_shared<const config::Settings>(std::move(options.settings))) {
    real_time_ = feed_.start();
}

Result<std::unique_ptr<Service>> Service::open(ServiceOptions options) {
    auto spool = spool::Spool::open(options.settings.spool, {daemon::wall_clock_ns, {}});
    if (!spool) {
        return spool.error();
    }
    std::unique_ptr<Service> service{new Service{std::move(options), std::move(*spool)}};
    if (auto recovered = service->recover(); !recovered) {
        return recovered.error();
    }
    service->open_lines();
    return service;
}

void Service::start() {
    event(event_kind::service_started, {}, {}, "linefeedd " + version_ + " has started");
    open_folders();
}

Service::~Service() {
    shut_down();
}

/// Nothing prints now. What was under way when the service ended stands, and says so already; what was over by then,
/// and not yet written down, is over. What has been printed from the command line meanwhile stands as well: it is not
/// for a queue to go on with it.
Result<void> Service::recover() {
    return access_.write([](spool::Spool& spool) -> Result<void> {
        auto begun = spool.begun_jobs();
        if (!begun) {
            return begun.error();
        }
        for (spool::Ticket& ticket : *begun) {
            const auto facts = read_facts(spool, ticket.job);
            if (!facts) {
                return facts.error();
            }
            const JobPhase phase = phase_of(*facts, {});
            const bool finished = phase == JobPhase::finished;
            if (ticket.begun ? !finished : phase == JobPhase::queued) {
                continue;
            }
            ticket.begun = !finished;
            ticket.message =
                phase == JobPhase::stopped ? "it was printed from the command line: resume it to go on" : "";
            if (finished) {
                ticket.place.reset();
            }
            if (auto written = spool.write_ticket(ticket); !written) {
                return written;
            }
        }
        return {};
    });
}

/// What waited before the service was started does not begin to print because it was: that takes a person.
Result<Line::Past> Service::past_of(const config::PrinterSettings& printer) {
    return access_.write([&](spool::Spool& spool) -> Result<Line::Past> {
        const auto held = spool.printer_held(printer.name);
        const auto waiting = spool.first_in_queue(printer.name);
        const auto serial_number = spool.serial_number(printer.name);
        const auto memory = spool.printer_memory(printer.name);
        if (!held || !waiting || !serial_number || !memory) {
            return !held            ? held.error()
                   : !waiting       ? waiting.error()
                   : !serial_number ? serial_number.error()
                                    : memory.error();
        }
        const bool waits = printer.queue.autostart && waiting->has_value();
        if (waits && !*held) {
            event(event_kind::printer_notice, printer.name, (*waiting)->job,
                  "it waited before the service was started: nothing starts by itself until somebody starts a job");
        }
        return Line::Past{*held || waits, *serial_number, *memory};
    });
}

void Service::open_lines() {
    const LineServices services{
        {feed_, store_},
        spool_,
        access_,
        events_,
        [this](const std::string& printer) { look_for_work(printer); },
        [this](const std::string& printer, const FollowerWanted& wanted) { return claim_follower(printer, wanted); }};
    const SharedSettings now = settings();
    for (const config::PrinterSettings& printer : now->printers) {
        if (line(printer.name) != nullptr) {
            continue;
        }
        const auto past = past_of(printer);
        if (!past) {
            event(event_kind::storage_failed, printer.name, {}, past.error().message);
        }
        auto opened = std::make_shared<Line>(services, printer.name, now, past ? *past : Line::Past{.held = true});
        const std::lock_guard lock{parts_mutex_};
        lines_.emplace(printer.name, std::move(opened));
    }
}

void Service::open_folders() {
    const FolderServices services{access_,
                                  events_,
                                  counts_,
                                  [this](const std::string& printer) { look_for_work(printer); },
                                  files_since_ns_,
                                  [this](const std::string& printer, const std::string& words) { leave_to_a_person(printer, words); }};
    const std::lock_guard lock{parts_mutex_};
    if (ending_ || !folders_.empty()) {
        return; // opened by a reload already
    }
    for (const config::FolderSettings& folder : settings_->folders) {
        folders_.push_back(std::make_shared<Folder>(services, folder, *settings_));
    }
}

void Service::shut_down() {
    {
        const std::lock_guard lock{orders_};
        if (std::exchange(closing_, true)) {
            return;
        }
    }
    ending_ = true;
    event(event_kind::service_stopping, {}, {}, "linefeedd ends");
    std::vector<FolderPtr> folders;
    {
        const std::lock_guard lock{parts_mutex_};
        folders.swap(folders_);
    }
    const std::vector<LinePtr> all = lines();
    for (const LinePtr& line : all) {
        line->request_stop();
    }
    folders.clear();
    for (const LinePtr& line : all) {
        static_cast<void>(line->wait_until_idle());
        line->close(); // all of them before the first is waited for to its end
    }
    events_.flush();
}

void Service::tick() {
    // While nothing is printed, nobody else copies the write-ahead log.
    static_cast<void>(access_.write([](spool::Spool& spool) { return spool.checkpoint(); }));
    access_.remove_leftovers();
}

std::vector<daemon::Heart> Service::hearts() const {
    return {{"feed thread", [this] { return feed_.beats(); }}, {"store thread", [this] { return store_.beats(); }}};
}

SharedSettings Service::settings() const {
    const std::lock_guard lock{parts_mutex_};
    return settings_;
}

Service::LinePtr Service::line(std::string_view printer) const {
    const std::lock_guard lock{parts_mutex_};
    const auto found = lines_.find(printer);
    return found == lines_.end() ? nullptr : found->second;
}

std::vector<Service::LinePtr> Service::lines() const {
    const std::lock_guard lock{parts_mutex_};
    std::vector<LinePtr> all;
    for (const auto& [name, line] : lines_) {
        all.push_back(line);
    }
    return all;
}

Result<Service::LinePtr> Service::known_line(std::string_view printer) const {
    if (LinePtr found = line(printer)) {
        return found;
    }
    std::string names;
    for (const LinePtr& there : lines()) {
        names += (names.empty() ? "" : ", ") + there->printer();
    }
    return Failure{FailureKind::usage, "there is no printer \"" + std::string{printer} + '"' +
                                           (names.empty() ? "" : "; there is: " + names)};
}

std::optional<JobPhase> Service::live_phase(spool::JobId id) const {
    for (const LinePtr& line : lines()) {
        for (const Line::Active& job : line->on_line()) {
            if (job.job == id) {
                return job.phase;
            }
        }
    }
    return std::nullopt;
}

void Service::event(std::string_view kind, const std::string& printer, std::optional<spool::JobId> job,
                    std::string message) {
    events_.add({.kind = std::string{kind}, .printer = printer, .job = job, .message = std::move(message)});
}

/// The audit log is kept for ever: who is refused over and over must not fill the disk with it.
std::optional<std::uint64_t> Service::take_refusal(const std::string& who) {
    constexpr std::uint32_t lines_a_minute = 20;
    constexpr std::size_t most_callers = 256;
    const std::lock_guard lock{refusals_mutex_};
    if (refusals_.size() == most_callers && !refusals_.contains(who)) {
        refusals_.clear();
    }
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return refusals_.try_emplace(who, lines_a_minute).first->second.take(Instant{now});
}

void Service::write_audit(const daemon::Caller& caller, const Act& act, const std::optional<Failure>& refused) {
    const auto held_back = refused ? take_refusal(caller.name) : std::optional<std::uint64_t>{0};
    if (!held_back) {
        return;
    }
    spool::AuditEntry entry;
    entry.time_ns = daemon::wall_clock_ns();
    entry.who = caller.name;
    entry.what = act.what;
    entry.object = act.object;
    spool::JsonObject detail = act.detail;
    if (refused) {
        detail.add("refused", refused->message);
    }
    if (*held_back > 0) {
        detail.add_json("more_refused_before", std::to_string(*held_back));
    }
    entry.detail = detail.text();
    entry.done = !refused;
    if (auto written = access_.write([&](spool::Spool& spool) { return spool.add_audit(entry); }); !written) {
        event(event_kind::storage_failed, {}, {}, "the audit log cannot be written: " + written.error().message);
    }
}

} // namespace linefeed::service
