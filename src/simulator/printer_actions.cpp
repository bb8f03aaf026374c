// What the printer model does at once: actions of clients and of the panel, and inputs (protocol, sections 2 and 4 IC).
#include "base/assert.hpp"
#include "simulator/printer_health.hpp"
#include "simulator/printer_model.hpp"

namespace linefeed::simulator {
namespace {

using protocol::Action;
using protocol::InputFunction;
using protocol::MachineState;
using protocol::NozzleState;

/// How long `!LF` interrupts the printing: the manual says "briefly".
constexpr Duration font_loading = std::chrono::milliseconds{200};

} // namespace

void PrinterModel::act(Action action, Instant now) {
    switch (action) {
    case Action::start_print:
        start_printing(now);
        return;
    case Action::stop_print:
        stop_printing(now);
        return;
    case Action::nozzle_open:
        open_nozzle(now);
        return;
    case Action::nozzle_close:
        close_nozzle(now);
        return;
    case Action::motor_open:
        motor_step(NozzleState::closed, NozzleState::in_between, now);
        return;
    case Action::motor_close:
        motor_step(NozzleState::in_between, NozzleState::closed, now);
        return;
    case Action::reset_counters:
        counters_.reset({0, {}});
        return;
    case Action::factory_reset:
        factory_reset(now);
        return;
    case Action::reload_fonts:
        fonts_loaded_ = now + font_loading;
        return;
    case Action::acknowledge_errors:
        error_ = {};
        switches_off_.reset();
        return;
    case Action::user_suspend:
        panel_blocked_until_ = now + panel_block;
        return;
    case Action::user_resume:
        panel_blocked_until_.reset();
        return;
    case Action::power_on:
        power_on(now);
        return;
    case Action::power_off:
        power_off(now);
        return;
    case Action::flush_fifo:
        fifo_.clear();
        return;
    case Action::display_off:
    case Action::display_on:
        display_on_ = action == Action::display_on;
        return;
    case Action::length_on:
        transmitter_.set_length(true);
        return;
    case Action::echo_on:
        transmitter_.set_echo(true);
        return;
    case Action::restart: // only in standby
    case Action::crc_ok:  // printer to host
    case Action::end_of_data:
        return;
    }
    assertion_failed("Action", __FILE__, __LINE__);
}

/// The seal of the head, moved by hand while the machine is ready and the nozzle not at work.
void PrinterModel::motor_step(NozzleState from, NozzleState to, Instant now) {
    if (machine_ == MachineState::ready && nozzle_ == from) {
        change_state(machine_, to, now);
    }
}

void PrinterModel::factory_reset(Instant now) {
    stop_printing(now);
    transmitter_.set_length(false);
    transmitter_.set_echo(false);
    print_parameters_ = default_print_parameters;
    outputs_.clear();
    display_on_ = true;
    wysiwyg_start_ = 0;
}

void PrinterModel::press(Action action, Instant now) {
    advance(now);
    if (!panel_blocked() && (machine_ != MachineState::standby || action == Action::power_on)) {
        act(action, now);
    }
}

void PrinterModel::set_input(protocol::Input input, bool on, Instant now) {
    advance(now);
    const std::uint32_t bit = 1U << static_cast<unsigned>(input);
    const bool rises = on && (inputs_ & bit) == 0;
    inputs_ = on ? inputs_ | bit : inputs_ & ~bit;
    if (!rises || machine_ == MachineState::standby) {
        return;
    }
    const auto index = static_cast<std::size_t>(input);
    if (index < settings_.profile.configured_inputs()) {
        function_of_input(settings_.inputs.functions[index].value_or(InputFunction::disabled), now);
    } else if (input == protocol::Input::x4_2) {
        counters_.printed();
    } else if (input == protocol::Input::x4_1) {
        counters_.reset({0, {}});
    }
}

void PrinterModel::function_of_input(InputFunction function, Instant now) {
    switch (function) {
    case InputFunction::nozzle_open:
        open_nozzle(now);
        return;
    case InputFunction::nozzle_close:
        close_nozzle(now);
        return;
    case InputFunction::print_start:
        start_printing(now);
        return;
    case InputFunction::print_stop:
        stop_printing(now);
        return;
    case InputFunction::shutdown:
        power_off(now);
        return;
    case InputFunction::counter_reset_1:
        counters_.reset({1, {}});
        return;
    case InputFunction::counter_reset_2:
        counters_.reset({2, {}});
        return;
    case InputFunction::disabled:
    case InputFunction::horizontal_mirror: // how a record looks is not simulated
    case InputFunction::cutting_sync:
    case InputFunction::load_job: // which job belongs to which signal is set at the panel
    case InputFunction::ink_on_off:
    case InputFunction::batch_job_reset:
        return;
    }
}

bool PrinterModel::output(std::size_t number) const {
    using protocol::OutputSignal;
    if (outputs_.host_controls()) {
        return outputs_.set(number).value_or(false);
    }
    switch (output_configuration().signals[number - 1].value_or(OutputSignal::disabled)) {
    case OutputSignal::error_or_stop:
        return !error_.none();
    case OutputSignal::print_ready:
        return machine_ == MachineState::ready_to_print || printing();
    case OutputSignal::print_active:
        return print_ends_.has_value();
    case OutputSignal::power_fail: // inverted
        return true;
    case OutputSignal::disabled:
    case OutputSignal::refill_warning: // the tanks are full
    case OutputSignal::product_counter_end:
    case OutputSignal::print_go:
    case OutputSignal::encoder:
    case OutputSignal::camera_trigger:
    case OutputSignal::counter_overflow:
    case OutputSignal::camera_error:
    case OutputSignal::camera_warning:
    case OutputSignal::maximum_speed:
        return false;
    }
    return false;
}

void PrinterModel::note_event(Instant now) {
    event_list_.add(health::event(protocol::to_printer_time(clock_.read(now)), machine_));
}

} // namespace linefeed::simulator
