// The two tables behind commands.hpp. A row per command, in the order of the enumeration, so that a look-up by
// enumerator is an index; the order is checked at compile time.
#include "protocol/commands.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace linefeed::protocol {

namespace {

template <typename Name>
struct Row {
    Name name;
    std::string_view code;
    std::string_view description;
};

constexpr std::array<Row<Action>, 22> actions{{
    {Action::start_print, "GO", "start print-ready"},
    {Action::stop_print, "ST", "stop print-ready"},
    {Action::nozzle_open, "NO", "open the nozzle"},
    {Action::nozzle_close, "NC", "close the nozzle"},
    {Action::motor_open, "MO", "motor step open"},
    {Action::motor_close, "MC", "motor step close"},
    {Action::reset_counters, "RC", "reset the object counters of the job"},
    {Action::factory_reset, "FA", "factory reset"},
    {Action::reload_fonts, "LF", "reload the fonts"},
    {Action::acknowledge_errors, "EQ", "acknowledge errors"},
    {Action::user_suspend, "US", "block the panel for 10 s"},
    {Action::user_resume, "UR", "release the panel"},
    {Action::power_on, "PO", "power on, out of standby"},
    {Action::power_off, "PF", "power off, to standby"},
    {Action::restart, "RM", "restart the machine"},
    {Action::flush_fifo, "FF", "flush the mailing FIFO"},
    {Action::display_off, "W0", "WYSIWYG display off"},
    {Action::display_on, "W1", "WYSIWYG display on"},
    {Action::length_on, "LN", "send the length of each frame"},
    {Action::echo_on, "EM", "echo commands"},
    {Action::crc_ok, "OK", "the CRC was right"},
    {Action::end_of_data, "EN", "end of data"},
}};

constexpr std::array<Row<Parameter>, 31> parameters{{
    {Parameter::AC, "AC", "actual counters"},
    {Parameter::CC, "CC", "current counters"},
    {Parameter::CM, "CM", "mailing configuration: stop at"},
    {Parameter::CO, "CO", "change output"},
    {Parameter::CP, "CP", "counter parameters"},
    {Parameter::DL, "DL", "date and time"},
    {Parameter::DS, "DS", "free flash memory"},
    {Parameter::EL, "EL", "error list"},
    {Parameter::ET, "ET", "external text"},
    {Parameter::EV, "EV", "event list"},
    {Parameter::EX, "EX", "external signals and speed"},
    {Parameter::FC, "FC", "CRC that the printer calculated"},
    {Parameter::FL, "FL", "block length to fill"},
    {Parameter::GW, "GW", "WYSIWYG data"},
    {Parameter::HS, "HS", "hydraulic settings"},
    {Parameter::IC, "IC", "input configuration"},
    {Parameter::JB, "JB", "current job as a script"},
    {Parameter::JL, "JL", "name of the loaded job"},
    {Parameter::MC, "MC", "main configuration"},
    {Parameter::MR, "MR", "mail record"},
    {Parameter::MS, "MS", "machine status: actors"},
    {Parameter::NR, "NR", "CRC of the next frame"},
    {Parameter::OC, "OC", "output configuration"},
    {Parameter::PR, "PR", "print parameter"},
    {Parameter::RC, "RC", "reset counter"},
    {Parameter::RS, "RS", "machine state"},
    {Parameter::SC, "SC", "service configuration"},
    {Parameter::SH, "SH", "service history"},
    {Parameter::SM, "SM", "mailing status"},
    {Parameter::SW, "SW", "start of the WYSIWYG data"},
    {Parameter::VS, "VS", "versions"},
}};

template <typename Table>
constexpr bool in_order(const Table& table) {
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (static_cast<std::size_t>(table[i].name) != i || table[i].code.size() != 2) {
            return false;
        }
    }
    return true;
}
static_assert(in_order(actions) && static_cast<std::size_t>(Action::end_of_data) + 1 == actions.size());
static_assert(in_order(parameters) && static_cast<std::size_t>(Parameter::VS) + 1 == parameters.size());

constexpr std::uint16_t packed(std::string_view code) {
    return static_cast<std::uint16_t>(static_cast<unsigned char>(code[0]) << 8 | static_cast<unsigned char>(code[1]));
}

/// The codes alone, side by side: every answer is looked up on its way to the refill, and a table of texts is twenty
/// cache lines that nobody else has use for.
template <typename Name, std::size_t Size>
constexpr std::array<std::uint16_t, Size> packed_codes(const std::array<Row<Name>, Size>& table) {
    std::array<std::uint16_t, Size> codes{};
    for (std::size_t i = 0; i < Size; ++i) {
        codes[i] = packed(table[i].code);
    }
    return codes;
}
constexpr auto action_codes = packed_codes(actions);
constexpr auto parameter_codes = packed_codes(parameters);

template <typename Name, std::size_t Size>
std::optional<Name> find(const std::array<std::uint16_t, Size>& codes, std::string_view code) {
    if (code.size() == 2) {
        const std::uint16_t wanted = packed(code);
        for (std::size_t i = 0; i < Size; ++i) {
            if (codes[i] == wanted) {
                return static_cast<Name>(i);
            }
        }
    }
    return std::nullopt;
}

} // namespace

std::string_view code(Action action) {
    return actions[static_cast<std::size_t>(action)].code;
}

std::string_view code(Parameter parameter) {
    return parameters[static_cast<std::size_t>(parameter)].code;
}

std::string_view description(Action action) {
    return actions[static_cast<std::size_t>(action)].description;
}

std::string_view description(Parameter parameter) {
    return parameters[static_cast<std::size_t>(parameter)].description;
}

std::optional<Action> action_from_code(std::string_view code) {
    return find<Action>(action_codes, code);
}

std::optional<Parameter> parameter_from_code(std::string_view code) {
    return find<Parameter>(parameter_codes, code);
}

} // namespace linefeed::protocol
