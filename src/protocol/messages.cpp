// Decodes frames into messages, see messages.hpp. A new `=XX` gets a function here and a row in the table of readers.
#include "protocol/messages.hpp"

#include "base/assert.hpp"
#include "protocol/parameter_reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace linefeed::protocol {

namespace {

constexpr std::size_t code_bytes = 2;

Message read_machine_status(ParameterReader& in, EscapeMode) {
    MachineStatus status;
    // In standby only the machine state is valid; newer firmware may know more nozzle states (RS in section 4).
    const auto nozzle = in.optional_number("a nozzle state").value_or(0);
    status.nozzle = nozzle <= 5 ? static_cast<NozzleState>(nozzle) : NozzleState::invalid;
    status.machine = static_cast<MachineState>(in.number("a machine state", 1, 6));
    if (status.machine == MachineState::standby) {
        return MachineStatus{};
    }
    status.error.raw = in.signed_number("an error number");
    status.cover_open = in.optional_number("0 or 1").value_or(0) != 0;
    status.speed = in.optional_number("a speed").value_or(0);
    if (const auto changed = in.optional_number("0 or 1")) {
        status.job_changed = *changed != 0;
    }
    return status;
}

Message read_mail_status(ParameterReader& in, EscapeMode) {
    MailStatus status;
    status.depth = in.number("a FIFO depth");
    status.entries = in.number("a number of entries");
    status.last_printed = in.record_number();
    status.stop_at = in.record_number();
    status.last_print_finished = in.number("a number") > 0;
    status.print_go_count = in.optional_number("a number of PrintGos");
    return status;
}

Message read_stop_at(ParameterReader& in, EscapeMode) {
    return StopAt{in.record_number()};
}

Message read_counters(ParameterReader& in, EscapeMode) {
    Counters counters;
    counters.product = in.optional_number("a product counter");
    counters.stop_after = in.optional_number("a number of products");
    counters.total = in.optional_number("a print counter");
    return counters;
}

Message read_versions(ParameterReader& in, EscapeMode escapes) {
    VersionInfo version;
    for (std::string* const field :
         {&version.fpga, &version.rip, &version.sdc, &version.fep, &version.kernel, &version.system_type,
          &version.language_pack, &version.font_pack, &version.firmware, &version.type, &version.serial_number}) {
        *field = unescape(in.text().value_or(std::string_view{}), escapes);
    }
    return version;
}

Message read_job_name(ParameterReader& in, EscapeMode escapes) {
    return JobName{unescape(in.text().value_or(std::string_view{}), escapes)};
}

struct Reader {
    Parameter parameter;
    Message (*read)(ParameterReader&, EscapeMode);
};

constexpr std::array<Reader, 6> readers{{
    {Parameter::SM, read_mail_status},
    {Parameter::RS, read_machine_status},
    {Parameter::CM, read_stop_at},
    {Parameter::CC, read_counters},
    {Parameter::VS, read_versions},
    {Parameter::JL, read_job_name},
}};

MalformedMessage malformed(std::string_view payload, std::string_view reason) {
    return {std::string{payload}, "=" + std::string{payload.substr(0, code_bytes)} + ": " + std::string{reason}};
}

UnknownMessage unknown(const Frame& frame) {
    return {frame.group, std::string{frame.payload}};
}

Message read_parameter(const Frame& frame, EscapeMode escapes) {
    const std::string_view payload = frame.payload;
    const auto parameter = parameter_from_code(payload.substr(0, code_bytes));
    if (!parameter) {
        return unknown(frame);
    }
    const std::string_view values = payload.substr(code_bytes);
    if (*parameter == Parameter::MR) {
        if (auto record = parse_mail_record(values, escapes)) {
            return *std::move(record);
        }
        return malformed(payload, "the record number is wrong or missing");
    }
    for (const Reader& reader : readers) {
        if (reader.parameter == *parameter) {
            if (frame.truncated) {
                return malformed(payload, "the frame is longer than any that is known");
            }
            ParameterReader in{values};
            Message message = reader.read(in, escapes);
            if (!in.ok()) {
                message = malformed(payload, in.problem());
            }
            return message;
        }
    }
    return unknown(frame);
}

Message read_action(const Frame& frame) {
    // Actions have no parameters; excess ones are ignored, but a longer name is another command.
    const std::string_view rest = frame.payload.substr(std::min(code_bytes, frame.payload.size()));
    const bool excess_only = rest.empty() || rest.front() == '\t' || rest.front() == ' ';
    const auto action = action_from_code(frame.payload.substr(0, code_bytes));
    if (!action || !excess_only) {
        return unknown(frame);
    }
    return ActionMessage{*action};
}

Message read_inquiry(const Frame& frame) {
    const auto parameter = parameter_from_code(frame.payload.substr(0, code_bytes));
    if (!parameter) {
        return unknown(frame);
    }
    return InquiryMessage{*parameter, std::string{frame.payload.substr(code_bytes)}};
}

} // namespace

Message parse_message(const Frame& frame, EscapeMode escapes) {
    switch (frame.group) {
    case Group::script:
    case Group::file:
        return unknown(frame);
    case Group::action:
        return read_action(frame);
    case Group::inquiry:
        return read_inquiry(frame);
    case Group::parameter:
        return read_parameter(frame, escapes);
    }
    assertion_failed("Group", __FILE__, __LINE__);
}

std::string_view to_string(NozzleState state) {
    switch (state) {
    case NozzleState::invalid:
        return "invalid";
    case NozzleState::opens:
        return "opens";
    case NozzleState::open:
        return "open";
    case NozzleState::closes:
        return "closes";
    case NozzleState::closed:
        return "closed";
    case NozzleState::in_between:
        return "in between";
    }
    assertion_failed("NozzleState", __FILE__, __LINE__);
}

std::string_view to_string(MachineState state) {
    switch (state) {
    case MachineState::standby:
        return "standby";
    case MachineState::initialising:
        return "initialising";
    case MachineState::service:
        return "interval or service panel";
    case MachineState::ready:
        return "ready for action";
    case MachineState::ready_to_print:
        return "ready for print start";
    case MachineState::printing:
        return "printing";
    }
    assertion_failed("MachineState", __FILE__, __LINE__);
}

} // namespace linefeed::protocol
