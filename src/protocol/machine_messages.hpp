// What the printer tells about its machine: `=DL =DS =HS =MC =MS =RS =SC =SH =SL =VS` (protocol, section 4). Each
// message describes its fields once; parser, encoder and whatever shows messages to people walk over that description.
#pragma once

#include "protocol/commands.hpp"
#include "protocol/limits.hpp"
#include "protocol/printer_error.hpp"
#include "protocol/printer_time.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

using MaybeNumber = std::optional<std::uint32_t>;

/// RS, first parameter.
enum class NozzleState { invalid = 0, opens = 1, open = 2, closes = 3, closed = 4, in_between = 5 };
/// RS, second parameter.
enum class MachineState {
    unknown = 0, ///< none that the manual names: some other firmware's
    standby = 1,
    initialising = 2,
    service = 3,        ///< interval or service panel
    ready = 4,          ///< ready for action: the nozzle can be opened
    ready_to_print = 5, ///< ready for print start
    printing = 6,
};

/// `=RS`, printer to host: machine state information (section 4).
struct MachineStatus {
    static constexpr Parameter parameter = Parameter::RS;
    NozzleState nozzle = NozzleState::invalid;
    MachineState machine = MachineState::standby;
    PrinterError error{};
    bool cover_open = false;
    std::uint32_t speed = 0;           ///< dm/min, or m/min on old firmware (profile)
    std::optional<bool> job_changed{}; ///< absent on old firmware

    static void describe(auto& visitor, auto& self) {
        visitor.number("nozzle", "a nozzle state", self.nozzle);
        visitor.number("machine", "a machine state", self.machine);
        visitor.number("error", "an error number", self.error.raw);
        visitor.number("cover_open", "0 or 1", self.cover_open);
        visitor.number("speed", "a speed", self.speed);
        visitor.added("job_changed", "0 or 1", self.job_changed);
    }
    friend bool operator==(const MachineStatus&, const MachineStatus&) = default;
};

/// `=DL`, both ways: the printer's date and time. All parameters are required.
struct ClockTime {
    static constexpr Parameter parameter = Parameter::DL;
    PrinterTime time{};
    std::uint32_t weekday = 0; ///< 0 = Sunday … 6

    static void describe(auto& visitor, auto& self) {
        visitor.number("year", "a year", self.time.year, Limits{1601, 30827});
        visitor.number("month", "a month", self.time.month, Limits{1, 12});
        visitor.number("weekday", "a weekday", self.weekday, Limits{0, 6});
        visitor.number("day", "a day", self.time.day, Limits{1, 31});
        visitor.number("hour", "an hour", self.time.hour, Limits{0, 23});
        visitor.number("minute", "a minute", self.time.minute, Limits{0, 59});
        visitor.number("second", "a second", self.time.second, Limits{0, 59});
    }
    friend bool operator==(const ClockTime&, const ClockTime&) = default;
};

/// `=DS`, printer to host: free internal flash memory.
struct FreeFlash {
    static constexpr Parameter parameter = Parameter::DS;
    std::uint32_t kbyte = 0;

    static void describe(auto& visitor, auto& self) { visitor.number("free_kbyte", "a size in kByte", self.kbyte); }
    friend bool operator==(const FreeFlash&, const FreeFlash&) = default;
};

/// `=HS`, printer to host: hydraulic state.
struct HydraulicState {
    static constexpr Parameter parameter = Parameter::HS;
    MaybeNumber fall_time_ms{}; ///< of the viscometer
    MaybeNumber pressure_mbar{};
    MaybeNumber suction_pump_percent{};
    MaybeNumber diaphragm_position{}; ///< of the pressure tank, no dimension; 700…1400 is normal
    MaybeNumber mix_value{};          ///< of solvent in ink; 0 = no admixture
    std::string state{};              ///< not documented: as it came

    static void describe(auto& visitor, auto& self) {
        visitor.optional("fall_time_ms", "a fall time", self.fall_time_ms);
        visitor.optional("pressure_mbar", "a pressure", self.pressure_mbar);
        visitor.optional("suction_pump_percent", "a percentage", self.suction_pump_percent);
        visitor.optional("diaphragm_position", "a diaphragm position", self.diaphragm_position);
        visitor.optional("mix_value", "a mix value", self.mix_value);
        visitor.verbatim("state", self.state);
    }
    friend bool operator==(const HydraulicState&, const HydraulicState&) = default;
};

/// MC, second parameter: the level of the encoder's signals.
enum class EncoderLevel : std::uint32_t { rs422 = 0, ttl_5_v = 1, htl_24_v = 2 };

/// `=MC`, printer to host: main configuration.
struct MainConfiguration {
    static constexpr Parameter parameter = Parameter::MC;
    std::optional<bool> direct_print{};
    std::optional<EncoderLevel> encoder{};
    MaybeNumber fall_time_ms{}; ///< wanted
    MaybeNumber pressure_mbar{};
    std::optional<std::int32_t> visco_correction{};
    MaybeNumber dot_frequency_khz{};
    MaybeNumber ink_number{};
    MaybeNumber interval_on{};  ///< hour × 100 + minute
    MaybeNumber interval_off{}; ///< the same

    static void describe(auto& visitor, auto& self) {
        visitor.optional("direct_print", "0 or 1", self.direct_print);
        visitor.optional("encoder", "an encoder level", self.encoder);
        visitor.reserved();
        visitor.reserved();
        visitor.reserved();
        visitor.optional("set_fall_time_ms", "a fall time", self.fall_time_ms);
        visitor.optional("set_pressure_mbar", "a pressure", self.pressure_mbar);
        visitor.reserved();
        visitor.optional("visco_correction", "a correction", self.visco_correction);
        visitor.optional("dot_frequency_khz", "a frequency", self.dot_frequency_khz);
        visitor.optional("ink_number", "an ink number", self.ink_number);
        visitor.optional("interval_on", "a time of day", self.interval_on, Limits{0, 2359});
        visitor.optional("interval_off", "a time of day", self.interval_off, Limits{0, 2359});
    }
    friend bool operator==(const MainConfiguration&, const MainConfiguration&) = default;
};

/// MS, parameter 9: the motor of the nozzle seal.
enum class HeadMotor : std::uint32_t { opening = 1, opened = 2, closing = 3, closed = 4, in_between = 5 };

/// `=MS`, printer to host: the states of the actors, 0 or 1 unless said otherwise.
struct ActorStates {
    static constexpr Parameter parameter = Parameter::MS;
    MaybeNumber compressor{}, main_pump{}, suction_pump{}, visco_pump{};
    MaybeNumber air_outlet_valve{}, bleed_valve{}, ink_flow_valve{}, mixing_valve{};
    std::optional<HeadMotor> head_motor{};
    std::optional<bool> printing{};

    static void describe(auto& visitor, auto& self) {
        visitor.optional("compressor", "an actor state", self.compressor);
        visitor.optional("main_pump", "an actor state", self.main_pump);
        visitor.optional("suction_pump", "an actor state", self.suction_pump);
        visitor.optional("visco_pump", "an actor state", self.visco_pump);
        visitor.optional("air_outlet_valve", "an actor state", self.air_outlet_valve);
        visitor.optional("bleed_valve", "an actor state", self.bleed_valve);
        visitor.optional("ink_flow_valve", "an actor state", self.ink_flow_valve);
        visitor.optional("mixing_valve", "an actor state", self.mixing_valve);
        visitor.optional("head_motor", "a motor state", self.head_motor);
        visitor.optional("printing", "0 or 1", self.printing);
        visitor.reserved();
    }
    friend bool operator==(const ActorStates&, const ActorStates&) = default;
};

/// `=SC`, printer to host: how long from service to service.
struct ServiceIntervals {
    static constexpr Parameter parameter = Parameter::SC;
    MaybeNumber hours{}; ///< of operation
    MaybeNumber days{};

    static void describe(auto& visitor, auto& self) {
        visitor.optional("hours", "a number of hours", self.hours);
        visitor.optional("days", "a number of days", self.days);
    }
    friend bool operator==(const ServiceIntervals&, const ServiceIntervals&) = default;
};

/// `=SH`, printer to host: service history.
struct ServiceHistory {
    static constexpr Parameter parameter = Parameter::SH;
    MaybeNumber operating_hours{};
    MaybeNumber last_service_hours{};                ///< operating hours at the last service
    std::optional<std::int32_t> last_service_date{}; ///< packed into 32 bits: unpack_date()

    static void describe(auto& visitor, auto& self) {
        visitor.optional("operating_hours", "a number of hours", self.operating_hours);
        visitor.optional("last_service_hours", "a number of hours", self.last_service_hours);
        visitor.optional("last_service_date", "a packed date", self.last_service_date);
    }
    friend bool operator==(const ServiceHistory&, const ServiceHistory&) = default;
};

/// `=SL`, printer to host: levels of the tanks, on newer firmware. Neither their unit nor which tank is which is
/// documented (field notes, "Firmware habits"): as they came.
struct TankLevels {
    static constexpr Parameter parameter = Parameter::SL;
    static constexpr std::array<std::string_view, 4> keys{"level_1", "level_2", "level_3", "level_4"};
    std::array<MaybeNumber, keys.size()> levels{};

    static void describe(auto& visitor, auto& self) {
        for (std::size_t i = 0; i < keys.size(); ++i) {
            visitor.added(keys[i], "a level", self.levels[i]);
        }
    }
    friend bool operator==(const TankLevels&, const TankLevels&) = default;
};

/// `=VS`, printer to host: versions. Missing strings are empty.
struct VersionInfo {
    static constexpr Parameter parameter = Parameter::VS;
    static constexpr bool has_text = true;
    std::string fpga{}, rip{}, sdc{}, fep{}, kernel{}, system_type{}, language_pack{}, font_pack{}, firmware{}, type{};
    std::string serial_number{};

    static void describe(auto& visitor, auto& self) {
        visitor.text("fpga", self.fpga);
        visitor.text("rip", self.rip);
        visitor.text("sdc", self.sdc);
        visitor.text("fep", self.fep);
        visitor.text("kernel", self.kernel);
        visitor.text("system_type", self.system_type);
        visitor.text("language_pack", self.language_pack);
        visitor.text("font_pack", self.font_pack);
        visitor.text("firmware", self.firmware);
        visitor.text("type", self.type);
        visitor.text("serial_number", self.serial_number);
    }
    friend bool operator==(const VersionInfo&, const VersionInfo&) = default;
};

/// Words for people, e.g. "ready for print start". An unknown number of an open enumeration (EncoderLevel, HeadMotor)
/// is "unknown".
[[nodiscard]] std::string_view to_string(NozzleState state);
[[nodiscard]] std::string_view to_string(MachineState state);
[[nodiscard]] std::string_view to_string(EncoderLevel level);
[[nodiscard]] std::string_view to_string(HeadMotor motor);

} // namespace linefeed::protocol
