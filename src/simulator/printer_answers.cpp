// The half of the printer model that answers inquiries (protocol, sections 3 and 4). What has no meaning in a simulator
// gets values such as a healthy printer shows.
#include "base/assert.hpp"
#include "protocol/decimal.hpp"
#include "protocol/frame_encoder.hpp"
#include "protocol/parameter_reader.hpp"
#include "simulator/printer_model.hpp"

#include <initializer_list>
#include <utility>

namespace linefeed::simulator {
namespace {

using protocol::Group;
using protocol::MachineState;
using protocol::NozzleState;
using protocol::Parameter;

constexpr std::uint32_t free_flash_kbyte = 24576;
constexpr std::uint32_t max_speed_dm_per_min = 3000;
constexpr std::uint32_t fall_time_ms = 7100;
constexpr std::uint32_t pressure_mbar = 2400;
constexpr std::uint32_t suction_pump_percent = 35;
constexpr std::uint32_t diaphragm_position = 1000;
constexpr std::uint32_t visco_correction = 100;
constexpr std::uint32_t dot_frequency_khz = 66;
constexpr std::uint32_t ink_number = 70000;
constexpr std::uint32_t operating_hours = 1234;
constexpr std::uint32_t last_service_hours = 1000;
constexpr std::uint32_t service_interval_hours = 2000;
constexpr std::uint32_t service_interval_days = 365;
constexpr std::chrono::sys_seconds last_service{std::chrono::sys_days{std::chrono::year{2023} / 6 / 15} +
                                                std::chrono::hours{9}};

std::string joined(std::initializer_list<std::uint32_t> values) {
    std::string out;
    for (const std::uint32_t value : values) {
        if (!out.empty()) {
            out += '\t';
        }
        protocol::append_decimal(out, value);
    }
    return out;
}

/// Parameter 9 of `=MS`: the motor that seals the head.
std::uint32_t motor_state(NozzleState nozzle) {
    switch (nozzle) {
    case NozzleState::opens:
        return 1;
    case NozzleState::open:
        return 2;
    case NozzleState::closes:
        return 3;
    case NozzleState::invalid:
    case NozzleState::closed:
        return 4;
    case NozzleState::in_between:
        return 5;
    }
    assertion_failed("NozzleState", __FILE__, __LINE__);
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

bool PrinterModel::is_jet2neo() const {
    return settings_.profile.name.starts_with("jet2neo");
}

void PrinterModel::answer(ConnectionId connection, const protocol::Frame& frame, bool secured, Instant now) {
    const auto parameter = protocol::parameter_from_code(frame.payload.substr(0, 2));
    if (!parameter) {
        return;
    }
    std::string out;
    if (*parameter == Parameter::RS) {
        protocol::append_message(out, machine_status());
        job_changed_ = false;
    } else if (*parameter == Parameter::SM) {
        protocol::append_message(out, mail_status_answer());
    } else if (*parameter == Parameter::CC) {
        protocol::append_message(out, counters());
    } else if (*parameter == Parameter::VS) {
        protocol::append_message(out, versions_of(settings_), settings_.profile.escapes);
    } else if (*parameter == Parameter::JL) {
        out = path_frame();
    } else if (*parameter == Parameter::EL) {
        for (const std::string& block : error_list_.blocks()) {
            out.clear();
            protocol::append_frame(out, Group::parameter, block);
            send(connection, out, secured);
        }
        return;
    } else {
        const std::string values =
            *parameter == Parameter::PR ? print_parameter(frame.payload.substr(2)) : values_of(*parameter, now);
        if (values.empty() && *parameter != Parameter::ET) {
            return;
        }
        protocol::append_frame(out, Group::parameter, std::string{protocol::code(*parameter)} + values);
    }
    send(connection, out, secured);
}

std::string PrinterModel::path_frame() const {
    // The manual's examples send `\` of paths single, against its own escape rule (protocol, section 9). A path that
    // would be read differently then is escaped nevertheless.
    const auto escapes = settings_.profile.escapes;
    const bool reads_back = job_.find('^') == std::string::npos && protocol::unescape(job_, escapes) == job_;
    std::string out;
    protocol::append_message(out, protocol::JobName{job_},
                             reads_back && !settings_.habits.escaped_paths ? protocol::EscapeMode::none : escapes);
    return out;
}

std::string PrinterModel::print_parameter(std::string_view argument) const {
    protocol::ParameterReader in{argument};
    const auto type = in.optional_number("a type", static_cast<std::uint32_t>(print_parameters_.size()));
    return type && *type > 0 ? joined({*type, print_parameters_[*type - 1]}) : std::string{};
}

std::string PrinterModel::values_of(Parameter parameter, Instant now) const {
    switch (parameter) {
    case Parameter::AC:
        return joined({0});
    case Parameter::DL:
        return to_clock_values(clock_.read(now));
    case Parameter::DS:
        return joined({free_flash_kbyte});
    case Parameter::ET: {
        std::string text;
        protocol::append_escaped(text, extern_text_, settings_.profile.escapes);
        return text;
    }
    case Parameter::EV:
        return joined({1, 0, 0});
    case Parameter::EX:
        return joined({speed_shown(settings_.speed), 0, speed_shown(max_speed_dm_per_min), 1, 0, 0, 0, 0, 0});
    case Parameter::HS:
        return joined({fall_time_ms, pressure_mbar, suction_pump_percent, diaphragm_position, 0, 0});
    case Parameter::IC:
        return is_jet2neo() ? joined({0, 0, 0}) : joined({0, 0, 0, 0, 0, 0});
    case Parameter::MC:
        return joined(
            {0, 2, 0, 0, 0, fall_time_ms, pressure_mbar, 0, visco_correction, dot_frequency_khz, ink_number, 0, 0});
    case Parameter::MS: {
        const std::uint32_t ink_flows = nozzle_ == NozzleState::open ? 1 : 0;
        return joined({1, 1, 1, 0, 0, 0, ink_flows, 0, motor_state(nozzle_), printing() ? 1U : 0U, 0});
    }
    case Parameter::OC:
        return is_jet2neo() ? joined({1, 2, 3, 4}) : joined({1, 2, 3, 4, 0, 0, 0, 0});
    case Parameter::SC:
        return joined({service_interval_hours, service_interval_days});
    case Parameter::SH:
        return joined({operating_hours, last_service_hours, pack_date(last_service)});
    case Parameter::CC:
    case Parameter::CM:
    case Parameter::CO:
    case Parameter::CP:
    case Parameter::EL:
    case Parameter::FC:
    case Parameter::FL:
    case Parameter::GW:
    case Parameter::JB:
    case Parameter::JL:
    case Parameter::MR:
    case Parameter::NR:
    case Parameter::PR:
    case Parameter::RC:
    case Parameter::RS:
    case Parameter::SM:
    case Parameter::SW:
    case Parameter::VS:
        return {};
    }
    assertion_failed("Parameter", __FILE__, __LINE__);
}

void PrinterModel::send(ConnectionId connection, std::string_view frame, bool secured) {
    std::string bytes;
    transmitter_.append(bytes, frame, secured);
    effects_.emplace_back(Reply{connection, std::move(bytes)});
}

} // namespace linefeed::simulator
