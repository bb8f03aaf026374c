// Every command of the interface protocol, one row each (protocol, sections 2, 3, 4, 7 and 8): the one list from which
// names, help, documentation, the coverage of the simulator and the test "every command is implemented" are made.
#pragma once

#include "protocol/commands.hpp"
#include "protocol/frame.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace linefeed::protocol {

/// Who sends the command.
enum class Direction : std::uint8_t { to_printer, to_host, both };

/// What a command can do to a running line.
enum class Risk : std::uint8_t {
    none,
    line,        ///< starts, stops or disturbs the printing
    destructive, ///< also loses what is in the printer: settings, files, records. Refused while a job prints.
};

/// One command: the group character and the code behind it.
struct Command {
    Group group = Group::action;
    std::uint8_t index = 0; ///< the enumerator of Action, Parameter or FileCommand; 0 for script lines
    std::string_view code;
    Direction direction = Direction::to_printer;
    Risk risk = Risk::none;
    std::string_view description;
    std::string_view parameters; ///< in order; empty: none
};

namespace table {

constexpr Command row(Action action, std::string_view code, Risk risk, std::string_view description,
                      Direction direction = Direction::to_printer) {
    return {Group::action, static_cast<std::uint8_t>(action), code, direction, risk, description, ""};
}
constexpr Command row(Parameter parameter, std::string_view code, Direction direction, std::string_view description,
                      std::string_view parameters, Risk risk = Risk::none) {
    return {Group::parameter, static_cast<std::uint8_t>(parameter), code, direction, risk, description, parameters};
}
constexpr Command row(FileCommand command, std::string_view code, Direction direction, std::string_view description,
                      std::string_view parameters, Risk risk = Risk::none) {
    return {Group::file, static_cast<std::uint8_t>(command), code, direction, risk, description, parameters};
}
constexpr Command inquiry(Parameter parameter, std::string_view code, std::string_view description,
                          std::string_view parameters = "") {
    return {Group::inquiry, static_cast<std::uint8_t>(parameter), code, Direction::to_printer, Risk::none, description,
            parameters};
}
constexpr Command script(std::string_view code, std::string_view description, std::string_view parameters = "") {
    return {Group::script, 0, code, Direction::both, Risk::line, description, parameters};
}

inline constexpr auto to_printer = Direction::to_printer;
inline constexpr auto to_host = Direction::to_host;
inline constexpr auto both = Direction::both;

} // namespace table

inline constexpr auto command_table = std::to_array<Command>({
    // Section 2
    table::row(Action::start_print, "GO", Risk::line, "start print-ready"),
    table::row(Action::stop_print, "ST", Risk::line, "stop print-ready"),
    table::row(Action::nozzle_open, "NO", Risk::line, "open the nozzle"),
    table::row(Action::nozzle_close, "NC", Risk::line, "close the nozzle"),
    table::row(Action::motor_open, "MO", Risk::line, "motor step open"),
    table::row(Action::motor_close, "MC", Risk::line, "motor step close"),
    table::row(Action::reset_counters, "RC", Risk::line,
               "reset the object counters of the job (not the product counter)"),
    table::row(Action::factory_reset, "FA", Risk::destructive, "factory reset"),
    table::row(Action::reload_fonts, "LF", Risk::line, "reload the fonts"),
    table::row(Action::acknowledge_errors, "EQ", Risk::none, "acknowledge errors"),
    table::row(Action::user_suspend, "US", Risk::none, "block the panel for 10 s"),
    table::row(Action::user_resume, "UR", Risk::none, "release the panel"),
    table::row(Action::power_on, "PO", Risk::none, "power on, out of standby"),
    table::row(Action::power_off, "PF", Risk::destructive, "power off, to standby"),
    table::row(Action::restart, "RM", Risk::destructive, "restart the machine (only in standby)"),
    table::row(Action::flush_fifo, "FF", Risk::destructive, "flush the mailing FIFO"),
    table::row(Action::display_off, "W0", Risk::none, "WYSIWYG display off"),
    table::row(Action::display_on, "W1", Risk::none, "WYSIWYG display on"),
    table::row(Action::length_on, "LN", Risk::none, "send the length of each frame"),
    table::row(Action::echo_on, "EM", Risk::none, "echo commands"),
    table::row(Action::crc_ok, "OK", Risk::none, "the CRC was right", table::to_host),
    table::row(Action::end_of_data, "EN", Risk::none, "end of data", table::to_host),

    // Section 3
    table::inquiry(Parameter::AC, "AC", "all counters of the job"),
    table::inquiry(Parameter::CC, "CC", "product and print counters"),
    table::inquiry(Parameter::CP, "CP", "working start and end values of a counter", "counter id, 1 start or 2 end"),
    table::inquiry(Parameter::DL, "DL", "date and time"),
    table::inquiry(Parameter::DS, "DS", "free flash memory"),
    table::inquiry(Parameter::EL, "EL", "error list"),
    table::inquiry(Parameter::ET, "ET", "extern text"),
    table::inquiry(Parameter::EV, "EV", "event list"),
    table::inquiry(Parameter::EX, "EX", "external signals and speed"),
    table::inquiry(Parameter::GW, "GW", "WYSIWYG image"),
    table::inquiry(Parameter::HS, "HS", "hydraulic state"),
    table::inquiry(Parameter::IC, "IC", "functions of the inputs"),
    table::inquiry(Parameter::JB, "JB", "current job as a script"),
    table::inquiry(Parameter::JL, "JL", "name of the loaded job"),
    table::inquiry(Parameter::MC, "MC", "main configuration"),
    table::inquiry(Parameter::MS, "MS", "states of the actors"),
    table::inquiry(Parameter::OC, "OC", "signals of the outputs"),
    table::inquiry(Parameter::PR, "PR", "print parameter", "type"),
    table::inquiry(Parameter::RS, "RS", "machine state"),
    table::inquiry(Parameter::SC, "SC", "service intervals"),
    table::inquiry(Parameter::SH, "SH", "service history"),
    table::inquiry(Parameter::SL, "SL", "tank levels (newer firmware)"),
    table::inquiry(Parameter::SM, "SM", "mailing status"),
    table::inquiry(Parameter::VS, "VS", "versions"),

    // Section 4
    table::row(Parameter::AC, "AC", table::to_host, "all counters of the job",
               "counters; of each: done repetitions, value high, value low"),
    table::row(Parameter::CC, "CC", table::both, "product and print counters",
               "product counter, stop after products (0 off), total prints (read only)", Risk::line),
    table::row(Parameter::CM, "CM", table::to_printer, "mailing configuration: stop at",
               "stop-at record number (0 off)", Risk::line),
    table::row(Parameter::CO, "CO", table::to_printer, "change an output",
               "output 1…8 (0: take or give back control), state 0/1", Risk::line),
    table::row(Parameter::CP, "CP", table::both, "counter parameter", "counter id, 1 start or 2 end, value",
               Risk::line),
    table::row(Parameter::DL, "DL", table::both, "date and time", "year, month, weekday, day, hour, minute, second",
               Risk::line),
    table::row(Parameter::DS, "DS", table::to_host, "free flash memory", "kByte"),
    table::row(Parameter::EL, "EL", table::to_host, "error list",
               "first, total, entries in the block (up to 32), entries"),
    table::row(Parameter::ET, "ET", table::both, "extern text", "text of up to 2048 bytes", Risk::line),
    table::row(Parameter::EV, "EV", table::to_host, "event list",
               "first, total, entries in the block (up to 16), entries"),
    table::row(Parameter::EX, "EX", table::to_host, "external signals and speed",
               "speed, inputs, max speed, direction, (not named), PrintGo, 3 reserved"),
    table::row(Parameter::FC, "FC", table::to_host, "CRC that the printer calculated", "CRC-32"),
    table::row(Parameter::FL, "FL", table::to_printer, "block length to fill", "bytes 1…2048"),
    table::row(Parameter::GW, "GW", table::to_host, "WYSIWYG image", "up to 60 nibbles A…P"),
    table::row(Parameter::HS, "HS", table::to_host, "hydraulic state",
               "fall time, pressure, suction pump, diaphragm position, mix value, state"),
    table::row(Parameter::IC, "IC", table::to_host, "functions of the inputs", "a function for each input"),
    table::row(Parameter::JL, "JL", table::both, "name of the loaded job", "path", Risk::line),
    table::row(Parameter::MC, "MC", table::to_host, "main configuration",
               "direct print, encoder, 3 reserved, fall time, pressure, reserved, visco correction, dot frequency, "
               "ink number, interval on, interval off"),
    table::row(Parameter::MR, "MR", table::to_printer, "mail record", "number, fields, {properties}", Risk::line),
    table::row(Parameter::MS, "MS", table::to_host, "states of the actors",
               "compressor, main pump, suction pump, visco pump, air outlet valve, bleed valve, ink flow valve, "
               "mixing valve, head motor, printing active, reserved"),
    table::row(Parameter::NR, "NR", table::both, "CRC of the next frame", "CRC-32"),
    table::row(Parameter::OC, "OC", table::to_host, "signals of the outputs", "a signal for each output"),
    table::row(Parameter::PR, "PR", table::both, "print parameter", "type 1…5, value", Risk::line),
    table::row(Parameter::RC, "RC", table::to_printer, "reset a counter",
               "counter id (0 all), start value (-1 or none: the job's own)", Risk::line),
    table::row(Parameter::RS, "RS", table::to_host, "machine state",
               "nozzle, machine, error number, head cover, speed, job change"),
    table::row(Parameter::SC, "SC", table::to_host, "service intervals", "hours, days"),
    table::row(Parameter::SH, "SH", table::to_host, "service history",
               "operating hours, hours at the last service, its date"),
    table::row(Parameter::SL, "SL", table::to_host, "tank levels (newer firmware)", "four levels"),
    table::row(Parameter::SM, "SM", table::to_host, "mailing status",
               "depth, entries, last printed record number, stop-at number, last print finished, PrintGos (newer "
               "firmware)"),
    table::row(Parameter::SW, "SW", table::to_printer, "start of the WYSIWYG image", "x"),
    table::row(Parameter::VS, "VS", table::to_host, "versions",
               "FPGA, RIP, SDC, FEP, kernel, system type, language pack, font pack, firmware, type, serial number"),

    // Section 7
    table::script("BEGINLJSCRIPT", "a script begins: the current job is deleted"),
    table::script("ENDLJSCRIPT", "a script ends: it becomes the job EXTERN"),
    table::script("", "line of a script", "the line"),

    // Section 8
    table::row(FileCommand::RD, "RD", table::to_printer, "request a directory", "path, * as joker"),
    table::row(FileCommand::DI, "DI", table::to_host, "directory information",
               "1 for the last block, entries in the block (up to 32), entries (! before a directory)"),
    table::row(FileCommand::DF, "DF", table::to_printer, "delete a file", "path", Risk::destructive),
    table::row(FileCommand::RF, "RF", table::to_printer, "request a file", "path"),
    table::row(FileCommand::FH, "FH", table::both, "header of a file transfer", "path, number of blocks", Risk::line),
    table::row(FileCommand::FT, "FT", table::both, "block of a file transfer",
               "block number, sum of the bytes modulo 256, up to 2048 bytes as nibbles A…P", Risk::line),
    table::row(FileCommand::FA, "FA", table::both, "acknowledgement of a block",
               "block number, 0 send again, 1 OK, 2 cancel"),
});

/// The section of the protocol that describes the group.
[[nodiscard]] constexpr unsigned section_of(Group group) {
    switch (group) {
    case Group::action:
        return 2;
    case Group::inquiry:
        return 3;
    case Group::parameter:
        return 4;
    case Group::script:
        return 7;
    case Group::file:
        return 8;
    }
    return 0;
}

} // namespace linefeed::protocol
