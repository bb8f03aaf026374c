// What a healthy printer shows of itself where a simulator has nothing to measure (protocol, section 4).
#pragma once

#include "protocol/list_messages.hpp"
#include "protocol/machine_messages.hpp"

#include <cstdint>

namespace linefeed::simulator::health {

inline constexpr std::uint32_t max_speed_dm_per_min = 3000;

[[nodiscard]] protocol::HydraulicState hydraulic_state();
[[nodiscard]] protocol::MainConfiguration main_configuration();
[[nodiscard]] protocol::ActorStates actor_states(protocol::NozzleState nozzle, bool printing);
[[nodiscard]] protocol::ServiceIntervals service_intervals();
[[nodiscard]] protocol::ServiceHistory service_history();
[[nodiscard]] protocol::TankLevels tank_levels();
/// What the event list notes at that time.
[[nodiscard]] protocol::EventEntry event(const protocol::PrinterTime& time, protocol::MachineState machine);

} // namespace linefeed::simulator::health
