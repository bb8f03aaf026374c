// What there is to see of a printer, as its line knows it.
#include "service/line.hpp"

#include <algorithm>

namespace linefeed::service {

using daemon::JobPhase;
using daemon::PrinterPhase;

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

/// `records` = of the job at work; `behind` = so many of the next one follow without a stop.
daemon::PrinterFigures figures_of(const daemon::RunProgress& progress, RecordRange records, RecordCount behind) {
    daemon::PrinterFigures figures;
    figures.fifo_depth = progress.fifo_depth;
    figures.fifo_entries = progress.fifo_entries;
    figures.rate_per_s = progress.rate_per_s;
    if (!progress.range.empty()) {
        figures.credit = static_cast<std::uint32_t>(progress.credit().value());
        figures.time_to_empty_s = progress.time_to_empty_s();
        figures.lead_time_s = figures.time_to_empty_s; // the newest record is the last to be printed
        const RecordNumber last = std::max(records.last(), progress.range.last());
        figures.data_left_s = seconds_for(last - progress.printed_through + behind, progress.rate_per_s);
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
        const bool has_follower = follower_ && follower_->job != progress.job;
        view.figures =
            figures_of(progress, active_ == progress.job ? records_.value_or(progress.range) : progress.range,
                       has_follower ? follower_->records.count() : RecordCount{0});
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
    if (!follower_ && view.figures.data_left_s && *view.figures.data_left_s < low_data_s) {
        view.warnings.push_back("the job ends in " + std::to_string(static_cast<int>(*view.figures.data_left_s)) +
                                " s: the line stops then");
    }
    return view;
}

} // namespace linefeed::service
