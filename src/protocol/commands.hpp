// The names of the protocol: every action (section 2) and every parameter (sections 3 and 4), each in one table with
// its two-letter code, so that a command is added in one place.
#pragma once

#include <optional>
#include <string_view>

namespace linefeed::protocol {

/// `^0!XX` (protocol, section 2).
enum class Action {
    start_print,        ///< GO
    stop_print,         ///< ST
    nozzle_open,        ///< NO
    nozzle_close,       ///< NC
    motor_open,         ///< MO
    motor_close,        ///< MC
    reset_counters,     ///< RC: the job's object counters
    factory_reset,      ///< FA
    reload_fonts,       ///< LF
    acknowledge_errors, ///< EQ
    user_suspend,       ///< US
    user_resume,        ///< UR
    power_on,           ///< PO
    power_off,          ///< PF
    restart,            ///< RM
    flush_fifo,         ///< FF
    display_off,        ///< W0
    display_on,         ///< W1
    length_on,          ///< LN
    echo_on,            ///< EM
    crc_ok,             ///< OK, printer to host
    end_of_data,        ///< EN, printer to host
};

/// The two letters behind `?` or `=` (protocol, sections 3 and 4), named as in the manual.
enum class Parameter {
    AC,
    CC,
    CM,
    CO,
    CP,
    DL,
    DS,
    EL,
    ET,
    EV,
    EX,
    FC,
    FL,
    GW,
    HS,
    IC,
    JB,
    JL,
    MC,
    MR,
    MS,
    NR,
    OC,
    PR,
    RC,
    RS,
    SC,
    SH,
    SM,
    SW,
    VS,
};

/// The two-letter code, e.g. "GO".
[[nodiscard]] std::string_view code(Action action);
/// The two-letter code, e.g. "SM".
[[nodiscard]] std::string_view code(Parameter parameter);
/// A few words for logs, e.g. "flush the mailing FIFO".
[[nodiscard]] std::string_view description(Action action);
/// A few words for logs, e.g. "mailing status".
[[nodiscard]] std::string_view description(Parameter parameter);
/// The action with that code, if the protocol knows one.
[[nodiscard]] std::optional<Action> action_from_code(std::string_view code);
/// The parameter with that code, if the protocol knows one.
[[nodiscard]] std::optional<Parameter> parameter_from_code(std::string_view code);

} // namespace linefeed::protocol
