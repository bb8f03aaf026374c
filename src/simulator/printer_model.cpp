// The machine of the printer: power, nozzle, cover, errors, jobs, and the order of what happens by itself; see
// printer_model.hpp.
#include "simulator/printer_model.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::simulator {
namespace {

using protocol::MachineState;
using protocol::NozzleState;

/// Number of the error that an open cover causes. The vendor's table is not public: one of those seen in real lists.
constexpr std::uint32_t cover_error = 12000;

} // namespace

PrinterModel::PrinterModel(PrinterSettings settings, Instant now)
    : settings_(std::move(settings))
    , transmitter_(settings_.habits.line_end)
    , fifo_(settings_.depth)
    , clock_(settings_.clock_at_zero)
    , transfers_(FileSystem{settings_.profile}, settings_.block_errors)
    , now_(now)
    , cover_open_(settings_.cover_open)
    , job_(job_at(settings_.job).value_or(PrintJob{settings_.job, {}}))
    , total_prints_(settings_.total_prints) {
    counters_.load(settings_.counters);
    power_up(now);
    transmitter_.set_length(settings_.length_on);
    transmitter_.set_echo(settings_.echo_on);
    transmitter_.set_block_length(settings_.block_length);
    clear_effects();
}

void PrinterModel::power_up(Instant now) {
    transmitter_ = Transmitter{settings_.habits.line_end};
    lose_mailing();
    show_wildcards();
    last_printed_ = RecordNumber{};
    last_print_finished_ = true;
    print_gos_ = 0;
    job_changed_ = true;
    error_ = {};
    print_ends_ = nozzle_done_ = initialised_ = switches_off_ = std::nullopt;
    fonts_loaded_ = panel_blocked_until_ = std::nullopt;
    pending_job_.reset();
    pending_extern_text_.reset();
    script_.reset();
    transfers_.clear();
    outputs_.clear();
    display_on_ = true;
    wysiwyg_start_ = 0;
    awaited_crcs_.clear();
    stale_mail_status_ = mail_status();
    switch (settings_.power_up) {
    case PowerUpState::ready_to_print:
        change_state(MachineState::ready_to_print, NozzleState::open, now);
        return;
    case PowerUpState::nozzle_closed:
        change_state(MachineState::ready, NozzleState::closed, now);
        return;
    case PowerUpState::standby:
        change_state(MachineState::standby, NozzleState::invalid, now);
        return;
    }
}

void PrinterModel::lose_mailing() {
    fifo_.clear();
    stop_at_ = RecordNumber{};
    previous_.reset();
}

std::optional<Instant> PrinterModel::next_event() const {
    std::optional<Instant> earliest;
    const auto consider = [&earliest](std::optional<Instant> due) {
        if (due && (!earliest || *due < *earliest)) {
            earliest = due;
        }
    };
    consider(print_ends_);
    consider(nozzle_done_);
    consider(initialised_);
    consider(switches_off_);
    consider(pending_job_ ? std::optional{pending_job_->due} : std::nullopt);
    consider(pending_extern_text_ ? std::optional{pending_extern_text_->due} : std::nullopt);
    return earliest;
}

void PrinterModel::advance(Instant now) {
    LINEFEED_ASSERT(now >= now_);
    while (const auto due = next_event()) {
        if (*due > now) {
            break;
        }
        handle_event_at(*due);
    }
    now_ = now;
}

void PrinterModel::handle_event_at(Instant due) {
    if (print_ends_ == due) {
        finish_print(due);
    } else if (nozzle_done_ == due) {
        nozzle_done_.reset();
        const bool opened = nozzle_ == NozzleState::opens;
        change_state(opened ? MachineState::ready_to_print : machine_, opened ? NozzleState::open : NozzleState::closed,
                     due);
    } else if (initialised_ == due) {
        initialised_.reset();
        change_state(MachineState::ready, NozzleState::closed, due);
    } else if (switches_off_ == due) {
        power_off(due);
    } else if (pending_job_ && pending_job_->due == due) {
        finish_job_loading(std::exchange(pending_job_, std::nullopt)->value);
    } else {
        show_extern_text(std::exchange(pending_extern_text_, std::nullopt)->value);
    }
}

void PrinterModel::change_state(MachineState machine, NozzleState nozzle, Instant now) {
    machine_ = machine;
    nozzle_ = nozzle;
    effects_.emplace_back(StateChanged{now, machine_, nozzle_, cover_open_});
    note_event(now);
}

void PrinterModel::start_printing(Instant now) {
    if (machine_ != MachineState::ready_to_print) {
        return;
    }
    if (cover_open_) {
        show_error(error_with_window(ErrorWindow::error_of_head, cover_error), now);
        return;
    }
    change_state(MachineState::printing, nozzle_, now);
}

void PrinterModel::stop_printing(Instant now) {
    if (!printing()) {
        return;
    }
    if (print_ends_ && settings_.habits.abort_print_on_stop) {
        print_ends_.reset();
        effects_.emplace_back(PrintAborted{now, last_printed_});
    }
    lose_mailing();
    change_state(MachineState::ready_to_print, nozzle_, now);
}

void PrinterModel::open_nozzle(Instant now) {
    if (machine_ == MachineState::ready && nozzle_ != NozzleState::opens) {
        nozzle_done_ = now + settings_.nozzle_opening_time;
        change_state(machine_, NozzleState::opens, now);
    }
}

void PrinterModel::close_nozzle(Instant now) {
    stop_printing(now);
    if (machine_ == MachineState::ready_to_print || nozzle_ == NozzleState::opens) {
        nozzle_done_ = now + settings_.nozzle_closing_time;
        change_state(MachineState::ready, NozzleState::closes, now);
    }
}

void PrinterModel::power_on(Instant now) {
    if (machine_ == MachineState::standby) {
        transmitter_.set_block_length(0);
        initialised_ = now + settings_.initialising_time;
        change_state(MachineState::initialising, NozzleState::invalid, now);
    }
}

void PrinterModel::power_off(Instant now) {
    stop_printing(now);
    lose_mailing();
    transmitter_.set_length(false);
    transmitter_.set_echo(false);
    nozzle_done_ = initialised_ = switches_off_ = std::nullopt;
    awaited_crcs_.clear();
    if (machine_ != MachineState::standby) {
        change_state(MachineState::standby, NozzleState::invalid, now);
    }
}

void PrinterModel::restart(Instant now) {
    if (print_ends_) {
        effects_.emplace_back(PrintAborted{now, last_printed_});
    }
    power_up(now);
    effects_.emplace_back(ConnectionsLost{now});
}

void PrinterModel::show_error(std::int32_t raw, Instant now) {
    if (settings_.habits.error_bit_24) {
        constexpr std::int32_t bit_24 = 0x01000000;
        raw |= bit_24;
    }
    error_.raw = raw;
    error_list_.add(
        {protocol::to_printer_time(clock_.read(now)), {static_cast<std::int32_t>(error_.code_without_bit_24())}});
    switches_off_.reset();
    if (error_.switches_off()) {
        switches_off_ = now + settings_.switch_off_time;
    }
    effects_.emplace_back(ErrorRaised{now, error_});
}

void PrinterModel::raise_error(std::uint32_t code, Instant now) {
    advance(now);
    show_error(error_with_window(ErrorWindow::error, code), now);
    stop_printing(now);
}

void PrinterModel::open_cover(Instant now) {
    advance(now);
    if (std::exchange(cover_open_, true)) {
        return;
    }
    if (printing()) {
        show_error(error_with_window(ErrorWindow::error_of_head, cover_error), now);
        stop_printing(now);
    } else {
        change_state(machine_, nozzle_, now);
    }
}

void PrinterModel::close_cover(Instant now) {
    advance(now);
    if (std::exchange(cover_open_, false)) {
        change_state(machine_, nozzle_, now);
    }
}

void PrinterModel::load_job(std::string path, Instant now) {
    advance(now);
    auto job = job_at(path);
    finish_job_loading(job ? *std::move(job) : PrintJob{std::move(path), {}});
}

void PrinterModel::finish_job_loading(PrintJob job) {
    job_ = std::move(job);
    job_changed_ = true;
    show_wildcards();
    counters_.load(settings_.counters); // limits that the host has sent are lost (protocol, section 4, CP)
}

/// A job begins with what its editor has put in the places of texts to come (manual, annex B).
void PrinterModel::show_wildcards() {
    job_text_ = text_of(job_);
    extern_text_.clear();
    last_zero_text_.reset();
    numbered_ = false;
}

/// From now on it stands where the last record stood. An empty FIFO stays an error while numbered records are printed;
/// what a stop has emptied is over.
void PrinterModel::show_extern_text(std::string text) {
    extern_text_ = std::move(text);
    last_zero_text_.reset();
    numbered_ = numbered_ && printing();
}

/// The job in the file of that path, if there is one.
std::optional<PrintJob> PrinterModel::job_at(const std::string& path) const {
    const std::string* const content = files().read(path);
    return content == nullptr ? std::nullopt : std::optional{job_from_file(path, *content)};
}

void PrinterModel::power_cycle(Instant now) {
    advance(now);
    restart(now);
}

} // namespace linefeed::simulator
