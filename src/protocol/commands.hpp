// The names of the protocol: every action (section 2), every parameter (sections 3 and 4) and every file command
// (section 8). What else is known of each stands in command_table.hpp, so that a command is added in one place.
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
    SL, ///< newer firmware only (field notes)
    SM,
    SW,
    VS,
};

/// The two letters behind `$` (protocol, section 8), named as in the manual.
enum class FileCommand {
    RD, ///< request a directory
    DI, ///< directory information
    DF, ///< delete a file
    RF, ///< request a file
    FH, ///< header of a file transfer
    FT, ///< block of a file transfer
    FA, ///< acknowledgement of a block
};

/// The two-letter code, e.g. "GO".
[[nodiscard]] std::string_view code(Action action);
/// The two-letter code, e.g. "SM".
[[nodiscard]] std::string_view code(Parameter parameter);
/// The two-letter code, e.g. "FH".
[[nodiscard]] std::string_view code(FileCommand command);
/// A few words for logs, e.g. "flush the mailing FIFO".
[[nodiscard]] std::string_view description(Action action);
/// A few words for logs, e.g. "mailing status".
[[nodiscard]] std::string_view description(Parameter parameter);
/// A few words for logs, e.g. "delete a file".
[[nodiscard]] std::string_view description(FileCommand command);
/// The action with that code, if the protocol knows one.
[[nodiscard]] std::optional<Action> action_from_code(std::string_view code);
/// The parameter with that code, if the protocol knows one.
[[nodiscard]] std::optional<Parameter> parameter_from_code(std::string_view code);
/// The file command with that code, if the protocol knows one.
[[nodiscard]] std::optional<FileCommand> file_command_from_code(std::string_view code);

} // namespace linefeed::protocol
