// The typed messages of the protocol (sections 2 to 5), with parser and encoder each. A new command gets its struct
// here, its place in Message, and its row in messages.cpp. As the manual demands: an empty parameter leaves its value,
// excess parameters are ignored, unknown commands are carried along as they came.
#pragma once

#include "base/record_number.hpp"
#include "protocol/commands.hpp"
#include "protocol/frame.hpp"
#include "protocol/mail_record.hpp"
#include "protocol/printer_error.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace linefeed::protocol {

/// `!XX`.
struct ActionMessage {
    Action action = Action::start_print;
    friend bool operator==(const ActionMessage&, const ActionMessage&) = default;
};

/// `?XX`, with whatever follows the code (only `?PR` has a parameter).
struct InquiryMessage {
    Parameter parameter = Parameter::RS;
    std::string argument{};
    friend bool operator==(const InquiryMessage&, const InquiryMessage&) = default;
};

/// RS, first parameter.
enum class NozzleState { invalid = 0, opens = 1, open = 2, closes = 3, closed = 4, in_between = 5 };
/// RS, second parameter.
enum class MachineState {
    standby = 1,
    initialising = 2,
    service = 3,        ///< interval or service panel
    ready = 4,          ///< ready for action: the nozzle can be opened
    ready_to_print = 5, ///< ready for print start
    printing = 6,
};

/// `=RS`, printer to host: machine state information (section 4).
struct MachineStatus {
    NozzleState nozzle = NozzleState::invalid;
    MachineState machine = MachineState::standby;
    PrinterError error{};
    bool cover_open = false;
    std::uint32_t speed = 0;           ///< dm/min, or m/min on old firmware (profile)
    std::optional<bool> job_changed{}; ///< absent on old firmware
    friend bool operator==(const MachineStatus&, const MachineStatus&) = default;
};

/// `=SM`, printer to host: mailing status (section 5). May be one inquiry old.
struct MailStatus {
    std::uint32_t depth = 0;
    std::uint32_t entries = 0;
    RecordNumber last_printed{}; ///< 0 = none
    RecordNumber stop_at{};      ///< 0 = off
    bool last_print_finished = true;
    std::optional<std::uint32_t> print_go_count{}; ///< newer firmware only
    friend bool operator==(const MailStatus&, const MailStatus&) = default;
};

/// `=CM`, host to printer: stop when this record has been printed; 0 = off.
struct StopAt {
    RecordNumber number{};
    friend bool operator==(const StopAt&, const StopAt&) = default;
};

/// `=CC`: counters. Host to printer, an absent value is left as it is.
struct Counters {
    std::optional<std::uint32_t> product{};
    std::optional<std::uint32_t> stop_after{}; ///< 0 = off
    std::optional<std::uint32_t> total{};      ///< prints of the printer's life; printer to host only
    friend bool operator==(const Counters&, const Counters&) = default;
};

/// `=VS`, printer to host: versions. Missing strings are empty.
struct VersionInfo {
    std::string fpga{}, rip{}, sdc{}, fep{}, kernel{}, system_type{}, language_pack{}, font_pack{}, firmware{}, type{};
    std::string serial_number{};
    friend bool operator==(const VersionInfo&, const VersionInfo&) = default;
};

/// `=JL`: name of the loaded job with path, or (host to printer) the job to load.
struct JobName {
    std::string path{};
    friend bool operator==(const JobName&, const JobName&) = default;
};

/// A frame that no type above describes: carried along as it came.
struct UnknownMessage {
    Group group = Group::parameter;
    std::string payload{};
    friend bool operator==(const UnknownMessage&, const UnknownMessage&) = default;
};

/// A known command whose parameters cannot be read.
struct MalformedMessage {
    std::string payload{};
    std::string reason{}; ///< e.g. "=SM: parameter 3 is not a record number: \"x\""
    friend bool operator==(const MalformedMessage&, const MalformedMessage&) = default;
};

using Message = std::variant<UnknownMessage, MalformedMessage, ActionMessage, InquiryMessage, MachineStatus, MailStatus,
                             StopAt, Counters, VersionInfo, JobName, MailRecord>;

/// Decodes a frame. Never fails: what cannot be read is MalformedMessage or UnknownMessage. Allocates only for messages
/// with text; RS, SM, CC and actions never do.
[[nodiscard]] Message parse_message(const Frame& frame, EscapeMode escapes);

/// Appends the frame of a message to `out`.
void append_message(std::string& out, const MachineStatus& status);
void append_message(std::string& out, const MailStatus& status);
void append_message(std::string& out, const StopAt& stop);
void append_message(std::string& out, const Counters& counters);
void append_message(std::string& out, const VersionInfo& version, EscapeMode escapes);
void append_message(std::string& out, const JobName& job, EscapeMode escapes);

/// Words for people, e.g. "ready for print start".
[[nodiscard]] std::string_view to_string(NozzleState state);
[[nodiscard]] std::string_view to_string(MachineState state);

} // namespace linefeed::protocol
