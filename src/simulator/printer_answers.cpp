// The half of the printer model that answers inquiries (protocol, sections 3 and 4). What has no meaning in a simulator
// gets values such as a healthy printer shows (printer_health.hpp).
#include "base/assert.hpp"
#include "protocol/parameter_reader.hpp"
#include "simulator/picture.hpp"
#include "simulator/printer_health.hpp"
#include "simulator/printer_model.hpp"

#include <iterator>
#include <utility>

namespace linefeed::simulator {
namespace {

using protocol::MachineState;
using protocol::Message;
using protocol::NozzleState;
using protocol::Parameter;

/// What the outputs signal, from X3.1 on.
constexpr std::array<protocol::OutputSignal, 4> configured_signals{
    protocol::OutputSignal::refill_warning, protocol::OutputSignal::error_or_stop, protocol::OutputSignal::print_ready,
    protocol::OutputSignal::print_active};

template <typename Block, typename Entry>
std::vector<Message> blocks_of(const Log<Entry>& log) {
    auto blocks = protocol::to_blocks<Block>(log.entries());
    return {std::make_move_iterator(blocks.begin()), std::make_move_iterator(blocks.end())};
}

} // namespace

protocol::MachineStatus PrinterModel::machine_status() const {
    protocol::MachineStatus status{NozzleState::invalid, MachineState::standby, {}, false, 0, false};
    if (machine_ != MachineState::standby) {
        status = {nozzle_, machine_, error_, cover_open_, speed_shown(settings_.speed), job_changed_};
    }
    if (settings_.habits.five_value_status) {
        status.job_changed.reset();
    }
    return status;
}

protocol::MailStatus PrinterModel::mail_status() const {
    return {fifo_.depth(), fifo_.entries(), last_printed_, stop_at_, last_print_finished_, print_gos_};
}

protocol::MailStatus PrinterModel::mail_status_answer() {
    protocol::MailStatus status = mail_status();
    if (settings_.habits.stale_mail_status) {
        std::swap(status, stale_mail_status_);
    }
    if (!settings_.habits.sixth_value) {
        status.print_go_count.reset();
    }
    return status;
}

protocol::Counters PrinterModel::counters() const {
    protocol::Counters counters{product_counter_, stop_after_, total_prints_};
    if (settings_.habits.no_total_counter) {
        counters.total.reset();
    }
    return counters;
}

std::uint32_t PrinterModel::speed_shown(std::uint32_t dm_per_min) const {
    constexpr std::uint32_t dm_in_m = 10;
    const bool metres = settings_.habits.speed_in_metres || settings_.profile.speed_in_metres;
    return metres ? (dm_per_min + dm_in_m / 2) / dm_in_m : dm_per_min;
}

void PrinterModel::answer(ConnectionId connection, const protocol::InquiryMessage& inquiry, bool secured, Instant now) {
    const auto send_all = [&](const std::vector<Message>& messages) {
        for (const Message& message : messages) {
            send(connection, message, secured);
        }
    };
    if (inquiry.parameter == Parameter::EL) {
        send_all(blocks_of<protocol::ErrorListBlock>(error_list_));
    } else if (inquiry.parameter == Parameter::EV) {
        send_all(blocks_of<protocol::EventListBlock>(event_list_));
    } else if (inquiry.parameter == Parameter::GW) {
        send_all(picture());
    } else if (inquiry.parameter == Parameter::JB) {
        send_all(script());
    } else if (inquiry.parameter == Parameter::CP) {
        send_all(counter_parameters(inquiry.argument));
    } else if (const auto message = simple_answer(inquiry, now)) {
        send(connection, *message, secured);
    }
}

/// What one frame answers; none: the printer does not know the inquiry.
std::optional<Message> PrinterModel::simple_answer(const protocol::InquiryMessage& inquiry, Instant now) {
    switch (inquiry.parameter) {
    case Parameter::AC:
        return counters_.state();
    case Parameter::CC:
        return counters();
    case Parameter::DL:
        return protocol::ClockTime{protocol::to_printer_time(clock_.read(now)), protocol::weekday_of(clock_.read(now))};
    case Parameter::DS:
        return protocol::FreeFlash{files().free_kbyte()};
    case Parameter::ET:
        return protocol::ExternText{extern_text_};
    case Parameter::EX:
        return external_states();
    case Parameter::HS:
        return health::hydraulic_state();
    case Parameter::IC:
        return input_configuration();
    case Parameter::JL:
        return protocol::JobName{job_.path};
    case Parameter::MC:
        return health::main_configuration();
    case Parameter::MS:
        return health::actor_states(nozzle_, printing());
    case Parameter::OC:
        return output_configuration();
    case Parameter::PR:
        return print_parameter(inquiry.argument);
    case Parameter::RS: {
        const auto status = machine_status();
        job_changed_ = false;
        return status;
    }
    case Parameter::SC:
        return health::service_intervals();
    case Parameter::SH:
        return health::service_history();
    case Parameter::SL:
        return settings_.habits.tank_levels ? std::optional<Message>{health::tank_levels()} : std::nullopt;
    case Parameter::SM:
        return mail_status_answer();
    case Parameter::VS:
        return versions_of(settings_);
    case Parameter::CM: // the manual says: see ?SM
    case Parameter::CO:
    case Parameter::CP:
    case Parameter::EL:
    case Parameter::EV:
    case Parameter::FC:
    case Parameter::FL:
    case Parameter::GW:
    case Parameter::JB:
    case Parameter::MR:
    case Parameter::NR:
    case Parameter::RC:
    case Parameter::SW:
        return std::nullopt;
    }
    assertion_failed("Parameter", __FILE__, __LINE__);
}

std::optional<Message> PrinterModel::print_parameter(std::string_view argument) const {
    protocol::ParameterReader in{argument};
    const auto type = in.optional_number("a type", static_cast<std::uint32_t>(print_parameters_.size()));
    if (!type || *type == 0) {
        return std::nullopt;
    }
    return protocol::PrintParameter{protocol::PrintParameterType{*type}, print_parameters_[*type - 1]};
}

/// The manual says that `?CP` gives the working values, and not how it names the counter. Taken is what `=CP` begins
/// with: an id and a limit; what is left out gives all.
std::vector<Message> PrinterModel::counter_parameters(std::string_view argument) const {
    using protocol::CounterLimit;
    protocol::ParameterReader in{argument};
    const auto wanted_id = in.optional_number("a counter id");
    const auto wanted_limit = in.optional_number("1 or 2");
    std::vector<Message> messages;
    for (std::uint32_t id = 1; settings_.profile.counter_parameters && id <= counters_.size(); ++id) {
        for (const auto limit : {CounterLimit::start, CounterLimit::end}) {
            const bool wanted =
                wanted_id.value_or(id) == id &&
                wanted_limit.value_or(static_cast<std::uint32_t>(limit)) == static_cast<std::uint32_t>(limit);
            if (wanted) {
                messages.emplace_back(protocol::CounterParameter{id, limit, counters_.limit(id, limit).value_or(0)});
            }
        }
    }
    return messages;
}

/// `?JB`: the current job as the script that would make it.
std::vector<Message> PrinterModel::script() const {
    std::vector<Message> lines{protocol::ScriptLine{"BEGINLJSCRIPT"}};
    for (const std::string& line : job_.lines) {
        lines.emplace_back(protocol::ScriptLine{line});
    }
    lines.emplace_back(protocol::ScriptLine{"ENDLJSCRIPT"});
    return lines;
}

/// `?GW`: the record loaded for the next print; without one what a PrintGo would print.
std::vector<Message> PrinterModel::picture() const {
    constexpr std::uint32_t job_id = 1;
    const MailSlot* const loaded = fifo_.loaded();
    const std::string& text = loaded != nullptr ? loaded->text : last_zero_text_ ? *last_zero_text_ : own_text();
    std::vector<Message> messages;
    for (const protocol::WysiwygLine& line : protocol::to_lines(draw(text, job_id, wysiwyg_start_))) {
        messages.emplace_back(line);
    }
    messages.emplace_back(protocol::ActionMessage{protocol::Action::end_of_data});
    return messages;
}

protocol::ExternalStates PrinterModel::external_states() const {
    return {speed_shown(settings_.speed),        inputs_, speed_shown(health::max_speed_dm_per_min),
            protocol::EncoderDirection::forward, "0",     false};
}

protocol::InputConfiguration PrinterModel::input_configuration() const {
    protocol::InputConfiguration inputs;
    for (std::size_t i = 0; i < settings_.profile.configured_inputs(); ++i) {
        inputs.functions[i] = settings_.inputs.functions[i].value_or(protocol::InputFunction::disabled);
    }
    return inputs;
}

protocol::OutputConfiguration PrinterModel::output_configuration() const {
    protocol::OutputConfiguration outputs;
    for (std::size_t i = 0; i < settings_.profile.outputs(); ++i) {
        outputs.signals[i] = i < configured_signals.size() ? configured_signals[i] : protocol::OutputSignal::disabled;
    }
    return outputs;
}

} // namespace linefeed::simulator
