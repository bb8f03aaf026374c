// The values of a healthy printer, see printer_health.hpp.
#include "simulator/printer_health.hpp"

#include "base/assert.hpp"

namespace linefeed::simulator::health {
namespace {

using protocol::HeadMotor;
using protocol::NozzleState;

constexpr std::uint32_t fall_time_ms = 7100;
constexpr std::uint32_t pressure_mbar = 2400;
constexpr std::uint32_t suction_pump_percent = 35;
constexpr std::uint32_t diaphragm_position = 1000;
constexpr std::int32_t visco_correction = 100;
constexpr std::uint32_t dot_frequency_khz = 66;
constexpr std::uint32_t ink_number = 70000;
constexpr std::uint32_t operating_hours = 1234;
constexpr std::uint32_t last_service_hours = 1000;
constexpr protocol::PrinterTime last_service{2023, 6, 15, 9, 0, 0};
constexpr std::uint32_t service_interval_hours = 2000;
constexpr std::uint32_t service_interval_days = 365;
constexpr std::uint32_t compressor_pulses = 30;
constexpr std::uint32_t solvent_sips = 1;
constexpr std::uint32_t ink_sips = 4;
constexpr std::uint32_t mixing_ratio = 12;

HeadMotor motor_of(NozzleState nozzle) {
    switch (nozzle) {
    case NozzleState::opens:
        return HeadMotor::opening;
    case NozzleState::open:
        return HeadMotor::opened;
    case NozzleState::closes:
        return HeadMotor::closing;
    case NozzleState::invalid:
    case NozzleState::closed:
        return HeadMotor::closed;
    case NozzleState::in_between:
        return HeadMotor::in_between;
    }
    assertion_failed("NozzleState", __FILE__, __LINE__);
}

} // namespace

protocol::HydraulicState hydraulic_state() {
    return {fall_time_ms, pressure_mbar, suction_pump_percent, diaphragm_position, 0, "0"};
}

protocol::MainConfiguration main_configuration() {
    return {.direct_print = false,
            .encoder = protocol::EncoderLevel::htl_24_v,
            .fall_time_ms = fall_time_ms,
            .pressure_mbar = pressure_mbar,
            .visco_correction = visco_correction,
            .dot_frequency_khz = dot_frequency_khz,
            .ink_number = ink_number,
            .interval_on = 0,
            .interval_off = 0};
}

protocol::ActorStates actor_states(NozzleState nozzle, bool printing) {
    const std::uint32_t ink_flows = nozzle == NozzleState::open ? 1 : 0;
    return {1, 1, 1, 0, 0, 0, ink_flows, 0, motor_of(nozzle), printing};
}

protocol::ServiceIntervals service_intervals() {
    return {service_interval_hours, service_interval_days};
}

protocol::ServiceHistory service_history() {
    return {operating_hours, last_service_hours, static_cast<std::int32_t>(protocol::pack_date(last_service))};
}

protocol::TankLevels tank_levels() {
    return {{19, 12, 0, 0}}; // as a real printer showed (field notes)
}

protocol::EventEntry event(const protocol::PrinterTime& time, protocol::MachineState machine) {
    return {time,          compressor_pulses,  solvent_sips, ink_sips, mixing_ratio,
            pressure_mbar, diaphragm_position, fall_time_ms, machine};
}

} // namespace linefeed::simulator::health
