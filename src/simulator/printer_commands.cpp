// The half of the printer model that takes what clients send: actions, parameters, records, announced CRCs (protocol,
// sections 1, 2, 4, 5 and 6). What the printer does not know it ignores silently.
#include "base/assert.hpp"
#include "protocol/crc32.hpp"
#include "protocol/frame_encoder.hpp"
#include "protocol/parameter_reader.hpp"
#include "simulator/printer_model.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::simulator {
namespace {

using protocol::Action;
using protocol::Group;
using protocol::MachineState;
using protocol::Parameter;

constexpr std::size_t code_bytes = 2;
constexpr std::uint32_t largest_block = 2048; ///< protocol, section 4, FL
constexpr std::size_t max_extern_text = 2048; ///< protocol, section 4, ET

std::string_view code_of(const protocol::Frame& frame) {
    return frame.payload.substr(0, code_bytes);
}
std::string_view values_behind_code(const protocol::Frame& frame) {
    return frame.payload.substr(std::min(code_bytes, frame.payload.size()));
}

bool is_parameter(const protocol::Frame& frame, Parameter parameter) {
    return frame.group == Group::parameter && protocol::parameter_from_code(code_of(frame)) == parameter;
}

std::optional<Action> action_of(const protocol::Frame& frame) {
    if (frame.group != Group::action) {
        return std::nullopt;
    }
    const protocol::Message message = protocol::parse_message(frame, protocol::EscapeMode::none);
    const auto* known = std::get_if<protocol::ActionMessage>(&message);
    return known == nullptr ? std::nullopt : std::optional{known->action};
}

} // namespace

void PrinterModel::receive(ConnectionId connection, const protocol::Frame& frame, Instant now) {
    advance(now);
    if (frame.address != protocol::printer_address) {
        return;
    }
    if (machine_ == MachineState::standby) {
        receive_in_standby(frame, connection, now);
        return;
    }
    if (transmitter_.echo_on() && (frame.group == Group::action || frame.group == Group::parameter)) {
        std::string echo;
        protocol::append_frame(echo, frame.group, frame.payload);
        send(connection, echo, false);
    }
    if (is_parameter(frame, Parameter::NR)) {
        // An announcement replaces one whose frame got lost: the host repeats both.
        protocol::ParameterReader in{values_behind_code(frame)};
        if (const auto crc = in.optional_number("a CRC")) {
            awaited_crcs_[connection] = *crc;
        }
        return;
    }
    const bool secured = awaited_crcs_.contains(connection) && frame.group != Group::file;
    if (secured && !crc_agrees(connection, frame)) {
        return;
    }
    awaited_crcs_.erase(connection);
    execute(connection, frame, secured, now);
}

void PrinterModel::disconnected(ConnectionId connection) {
    awaited_crcs_.erase(connection);
}

void PrinterModel::receive_in_standby(const protocol::Frame& frame, ConnectionId connection, Instant now) {
    const auto action = action_of(frame);
    if (action == Action::power_on) {
        power_on(now);
    } else if (action == Action::restart) {
        restart(now);
    } else if (frame.group == Group::inquiry && code_of(frame) == protocol::code(Parameter::RS) &&
               !settings_.habits.standby_silent) {
        std::string out;
        protocol::append_message(out, machine_status());
        send(connection, out, false);
    }
}

bool PrinterModel::crc_agrees(ConnectionId connection, const protocol::Frame& frame) {
    const std::uint32_t announced = awaited_crcs_.at(connection);
    const std::uint32_t calculated = protocol::crc32(frame.raw);
    awaited_crcs_.erase(connection);
    std::string out;
    if (calculated == announced) {
        protocol::append_action(out, Action::crc_ok);
    } else {
        protocol::append_frame(out, Group::parameter, "FC" + std::to_string(calculated));
    }
    send(connection, out, false);
    return calculated == announced;
}

void PrinterModel::execute(ConnectionId connection, const protocol::Frame& frame, bool secured, Instant now) {
    switch (frame.group) {
    case Group::action:
        if (const auto action = action_of(frame)) {
            act(*action, now);
        }
        return;
    case Group::inquiry:
        answer(connection, frame, secured, now);
        return;
    case Group::parameter:
        take_parameter(frame, now);
        return;
    case Group::script:
    case Group::file:
        return;
    }
    assertion_failed("Group", __FILE__, __LINE__);
}

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
    case Action::acknowledge_errors:
        error_ = {};
        switches_off_.reset();
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
    case Action::length_on:
        transmitter_.set_length(true);
        return;
    case Action::echo_on:
        transmitter_.set_echo(true);
        return;
    case Action::factory_reset:
        stop_printing(now);
        transmitter_.set_length(false);
        transmitter_.set_echo(false);
        return;
    case Action::restart:    // only in standby
    case Action::motor_open: // the seal of the head: nothing of it shows while the nozzle is looked after
    case Action::motor_close:
    case Action::reset_counters: // the job has no counter objects
    case Action::reload_fonts:
    case Action::user_suspend: // the panel of the simulator is the test itself
    case Action::user_resume:
    case Action::display_off:
    case Action::display_on:
    case Action::crc_ok: // printer to host
    case Action::end_of_data:
        return;
    }
    assertion_failed("Action", __FILE__, __LINE__);
}

void PrinterModel::take_parameter(const protocol::Frame& frame, Instant now) {
    const auto parameter = protocol::parameter_from_code(code_of(frame));
    protocol::ParameterReader in{values_behind_code(frame)};
    if (parameter == Parameter::MR) {
        take_record(frame, now);
    } else if (parameter == Parameter::CM || parameter == Parameter::CC || parameter == Parameter::JL) {
        take_typed(frame, now);
    } else if (parameter == Parameter::FL) {
        const auto bytes = in.optional_number("a block length", largest_block);
        if (bytes && *bytes > 0) {
            transmitter_.set_block_length(*bytes);
        }
    } else if (parameter == Parameter::DL) {
        std::array<std::optional<std::uint32_t>, 7> values;
        for (auto& value : values) {
            value = in.optional_number("a part of a date");
        }
        if (const auto wall = from_clock_values(values)) {
            clock_.set(*wall, now);
        }
    } else if (parameter == Parameter::PR) {
        const auto type = in.optional_number("a type", static_cast<std::uint32_t>(print_parameters_.size()));
        const auto value = in.optional_number("a value");
        if (type && *type > 0 && value) {
            print_parameters_[*type - 1] = *value;
        }
    } else if (parameter == Parameter::ET) {
        const auto text = values_behind_code(frame).substr(0, max_extern_text);
        std::string stored = protocol::unescape(text, settings_.profile.escapes);
        std::replace(stored.begin(), stored.end(), '\0', ' ');
        pending_extern_text_ = Pending{now + settings_.extern_text_time, std::move(stored)};
    }
}

void PrinterModel::take_typed(const protocol::Frame& frame, Instant now) {
    const protocol::Message message = protocol::parse_message(frame, settings_.profile.escapes);
    if (const auto* stop = std::get_if<protocol::StopAt>(&message)) {
        const Habits& habits = settings_.habits;
        if (!habits.ignore_stop_at && (printing() || !habits.stop_at_only_while_printing)) {
            stop_at_ = stop->number;
        }
    } else if (const auto* counters = std::get_if<protocol::Counters>(&message)) {
        product_counter_ = counters->product.value_or(product_counter_);
        stop_after_ = counters->stop_after.value_or(stop_after_);
    } else if (const auto* job = std::get_if<protocol::JobName>(&message); job != nullptr && !job->path.empty()) {
        pending_job_ = Pending{now + settings_.job_loading_time, job->path};
    }
}

void PrinterModel::take_record(const protocol::Frame& frame, Instant now) {
    const auto record = protocol::parse_mail_record(values_behind_code(frame), settings_.profile.escapes);
    if (!record) {
        show_error(error_with_window(ErrorWindow::error, protocol::error_code::number_wrong), now);
        stop_printing(now);
        return;
    }
    if (fifo_.full()) {
        show_error(error_with_window(ErrorWindow::warning, protocol::error_code::buffer_full), now);
        return;
    }
    MailSlot& slot = fifo_.push();
    slot.number = record->number;
    slot.arrived = now;
    slot.text.clear();
    for (const std::string& field : record->fields) {
        if (&field != &record->fields.front()) {
            slot.text += '\t';
        }
        slot.text += field;
    }
    if (record->number == RecordNumber{}) {
        slot.prints_left = std::max(record->properties.repetitions.value_or(1), 1U);
    }
}

} // namespace linefeed::simulator
