#include "service/line.hpp"

#include "base/assert.hpp"
#include "daemon/events.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::service {

using daemon::JobPhase;
using daemon::PrinterPhase;

Line::Line(const LineServices& services, std::string printer, SharedSettings settings, Past past)
    : services_(services)
    , printer_(std::move(printer))
    , settings_(std::move(settings))
    , held_(past.held)
    , known_serial_number_(std::move(past.serial_number))
    , memory_(std::move(past.memory))
    , thread_([this] { serve(); }) {}

Line::~Line() {
    request_stop();
    close();
    thread_.join();
}

void Line::close() {
    {
        const std::lock_guard lock{mutex_};
        closing_ = true;
    }
    changed_.notify_all();
}

void Line::use(SharedSettings settings) {
    {
        const std::lock_guard lock{mutex_};
        settings_ = std::move(settings);
    }
    changed_.notify_all();
}

SharedSettings Line::settings() const {
    const std::lock_guard lock{mutex_};
    return settings_;
}

Result<void> Line::start(spool::JobId job, StartedBy who, const std::function<Result<void>()>& write_down) {
    bool was_held = false;
    {
        const std::lock_guard lock{mutex_};
        if (held_ && who == StartedBy::itself) {
            return Failure{FailureKind::stopped,
                           "nothing starts by itself on printer " + printer_ + " until somebody starts a job"};
        }
        if (active_ || closing_) {
            return Failure{FailureKind::stopped,
                           "printer " + printer_ +
                               (active_ ? " is at " + name_of(*active_) + ": stop it first" : " is being taken away")};
        }
        was_held = std::exchange(held_, false);
        active_ = job;
        ++orders_;
        written_down_ = false;
        stop_requested_ = false;
        supply_low_ = false;
        records_.reset();
    }
    const auto written = write_down();
    {
        const std::lock_guard lock{mutex_};
        written_down_ = written.has_value();
        if (!written) {
            active_.reset();
            held_ = held_ || was_held;
        }
    }
    changed_.notify_all();
    return written;
}

void Line::request_stop() {
    {
        const std::lock_guard lock{mutex_};
        stop_requested_ = true;
        if (run_ != nullptr) {
            run_->request_stop();
        }
    }
    changed_.notify_all(); // a job that waits for a reservation waits no longer
}

void Line::hold_queue() {
    const std::lock_guard lock{mutex_};
    held_ = true;
}

void Line::hold() {
    {
        const std::lock_guard lock{mutex_};
        held_ = true;
    }
    request_stop();
}

bool Line::held() const {
    const std::lock_guard lock{mutex_};
    return held_;
}

std::optional<Ending> Line::wait_until_idle() {
    std::unique_lock lock{mutex_};
    const std::uint64_t order = orders_;
    changed_.wait(lock, [&] { return !active_ || orders_ != order; });
    return last_ending_;
}

/// With mutex_ held. When the printer is looked at again, if nothing else is done with it; absent = never.
std::optional<std::chrono::steady_clock::time_point> Line::next_look() const {
    const config::PrinterSettings* const own = settings_->printer(printer_);
    if (own == nullptr || own->watch_interval == Duration{0}) {
        return std::nullopt;
    }
    constexpr std::uint32_t doublings_at_most = 3; // whoever refuses is busy with somebody else, or switched off
    const auto pause = own->watch_interval * (1U << std::min(failed_looks_, doublings_at_most));
    return looked_at_ ? *looked_at_ + pause : std::chrono::steady_clock::now();
}

void Line::serve() {
    std::unique_lock lock{mutex_};
    while (true) {
        if (!active_ && closing_) {
            return;
        }
        const bool kept = reserved_ > 0 && !closing_ && !stop_requested_;
        if (active_ && (!written_down_ || kept)) {
            changed_.wait(lock);
            continue;
        }
        if (!active_) {
            const auto at = next_look();
            if (!at) {
                changed_.wait(lock);
            } else if (std::chrono::steady_clock::now() < *at) {
                changed_.wait_until(lock, *at);
            } else {
                lock.unlock();
                glance();
                lock.lock();
            }
            continue;
        }
        const spool::JobId job = *active_;
        lock.unlock();
        print(job);
        lock.lock();
        active_.reset();
        looked_at_.reset();
        failed_looks_ = 0;
        link_.reset();
        const bool stopped = stop_requested_; // at its very end, perhaps: the next job does not follow then either
        lock.unlock();
        changed_.notify_all();
        if (!stopped) {
            services_.on_idle(printer_);
        }
        lock.lock();
    }
}

std::optional<Line::Active> Line::active() const {
    const std::lock_guard lock{mutex_};
    if (!active_) {
        return std::nullopt;
    }
    if (stop_requested_) {
        return Active{*active_, JobPhase::stopping};
    }
    const bool printing = run_ != nullptr && run_->progress().printing;
    return Active{*active_, printing ? JobPhase::printing : JobPhase::arming};
}

namespace {

PrinterPhase phase_of_printer(const std::optional<Line::Active>& active, bool checking) {
    if (!active) {
        return PrinterPhase::idle;
    }
    if (checking && active->phase == JobPhase::arming) {
        return PrinterPhase::checking;
    }
    switch (active->phase) {
    case JobPhase::printing:
        return PrinterPhase::printing;
    case JobPhase::stopping:
        return PrinterPhase::stopping;
    default: // a line is at no other
        return PrinterPhase::arming;
    }
}

/// Seconds for `records` at a rate; absent while it stands.
std::optional<double> seconds_for(RecordCount records, double rate_per_s) {
    return rate_per_s > 0 ? std::optional{static_cast<double>(records.value()) / rate_per_s} : std::nullopt;
}

/// Less than this is worth a word while the job goes on.
constexpr double low_data_s = 60;

daemon::PrinterFigures figures_of(const daemon::RunProgress& progress, RecordRange records) {
    daemon::PrinterFigures figures;
    figures.fifo_depth = progress.fifo_depth;
    figures.fifo_entries = progress.fifo_entries;
    figures.rate_per_s = progress.rate_per_s;
    if (!progress.range.empty()) {
        figures.credit = static_cast<std::uint32_t>(progress.credit().value());
        figures.time_to_empty_s = progress.time_to_empty_s();
        figures.lead_time_s = figures.time_to_empty_s; // the newest record is the last to be printed
        const RecordNumber last = std::max(records.last(), progress.range.last());
        figures.data_left_s = seconds_for(last - progress.printed_through, progress.rate_per_s);
    }
    return figures;
}

} // namespace

daemon::PrinterView Line::view() {
    const std::optional<Active> at = active();
    const std::lock_guard lock{mutex_};
    daemon::PrinterView view;
    view.name = printer_;
    view.phase = phase_of_printer(at, checking_);
    if (const config::PrinterSettings* const own = settings_->printer(printer_)) {
        view.address = link::to_string(own->address);
        view.profile = to_string(own->profile);
        view.autostart = own->queue.autostart;
    }
    if (at) {
        view.job = at->job;
    }
    if (run_ != nullptr) {
        const daemon::RunProgress progress = run_->progress();
        hear(progress);
        view.link = progress.heard_at ? daemon::LinkState::up : daemon::LinkState::connecting;
        view.figures = figures_of(progress, records_.value_or(progress.range));
    }
    if (!at && link_) {
        view.link = *link_;
        view.watched = true;
    }
    view.heard_ns = heard_.at_ns;
    view.known_serial_number = known_serial_number_;
    if (heard_.machine) {
        view.machine = to_string(heard_.machine->machine);
        view.nozzle = to_string(heard_.machine->nozzle);
        view.cover_open = heard_.machine->cover_open;
        view.error = heard_.machine->error;
    }
    if (heard_.version) {
        view.serial_number = heard_.version->serial_number;
        view.firmware = heard_.version->firmware;
    }
    if (memory_) {
        view.probe = memory_->probe;
        view.probed_ns = memory_->probed_ns;
    }
    view.total_prints = heard_.total_prints;
    view.panel_suspended = panel_ && panel_->held();
    view.held = held_;
    if (const config::ErrorEntry* const entry = view.error.none() ? nullptr : settings_->errors.find(view.error)) {
        view.error_meaning = entry->meaning;
        view.error_advice = entry->advice;
    }
    if (view.other_machine()) {
        view.warnings.push_back("another machine: serial number " + view.serial_number + ", and it was " +
                                known_serial_number_ + "; no job starts there before an operator has accepted it");
    }
    if (supply_low_) {
        view.warnings.emplace_back("the printer runs empty soon: the records are read more slowly than the line prints "
                                   "them; look at disk and load of this machine");
    }
    if (view.figures.data_left_s && *view.figures.data_left_s < low_data_s) {
        view.warnings.push_back("the job ends in " + std::to_string(static_cast<int>(*view.figures.data_left_s)) +
                                " s: the line stops then");
    }
    return view;
}

void Line::event(std::string_view kind, std::optional<spool::JobId> job, std::string message,
                 std::optional<RecordNumber> record) {
    services_.events.add(
        {.kind = std::string{kind}, .printer = printer_, .job = job, .record = record, .message = std::move(message)});
}

} // namespace linefeed::service
