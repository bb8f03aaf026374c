// Decodes frames into messages, see messages.hpp. A message that describes its fields needs a row in the table of
// readers, and nothing else; the others have readers of their own (special_messages.hpp).
#include "protocol/messages.hpp"

#include "base/assert.hpp"
#include "protocol/field_reader.hpp"
#include "protocol/special_messages.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace linefeed::protocol {

namespace {

constexpr std::size_t code_bytes = 2;

using Read = Message (*)(ParameterReader&, EscapeMode);

template <DescribedMessage T>
Message read_described(ParameterReader& in, EscapeMode escapes) {
    T message;
    FieldReader reader{in, escapes};
    T::describe(reader, message);
    return message;
}

template <auto read>
Message read_special(ParameterReader& in, EscapeMode escapes) {
    if constexpr (std::is_invocable_v<decltype(read), ParameterReader&, EscapeMode>) {
        return read(in, escapes);
    } else {
        return read(in);
    }
}

/// How each parameter transfer is read, by Parameter. None: JB is never transferred, MR has its own parser.
constexpr auto parameter_readers = [] {
    std::array<Read, static_cast<std::size_t>(Parameter::VS) + 1> readers{};
    const auto described = [&readers]<typename... T>(std::variant<T...>*) {
        const auto add = [&readers]<typename One>(One*) {
            if constexpr (DescribedParameter<One>) {
                readers[static_cast<std::size_t>(One::parameter)] = read_described<One>;
            }
        };
        (add(static_cast<T*>(nullptr)), ...);
    };
    described(static_cast<Message*>(nullptr));
    const auto set = [&readers](Parameter parameter, Read read) {
        readers[static_cast<std::size_t>(parameter)] = read;
    };
    set(Parameter::RS, read_special<read_machine_status>);
    set(Parameter::AC, read_special<read_job_counters>);
    set(Parameter::RC, read_special<read_counter_reset>);
    set(Parameter::EL, read_special<read_error_list>);
    set(Parameter::EV, read_special<read_event_list>);
    set(Parameter::GW, read_special<read_wysiwyg_line>);
    set(Parameter::ET, read_special<read_extern_text>);
    return readers;
}();

/// How each file command is read, by FileCommand.
constexpr std::array<Read, static_cast<std::size_t>(FileCommand::FA) + 1> file_readers{
    read_described<DirectoryRequest>,    read_special<read_directory_block>, read_described<FileDeletion>,
    read_described<FileRequest>,         read_described<FileHeader>,         read_special<read_file_block>,
    read_described<FileAcknowledgement>,
};

UnknownMessage unknown(const Frame& frame) {
    return {frame.group, std::string{frame.payload}};
}

MalformedMessage malformed(const Frame& frame, std::string_view reason) {
    std::string text{static_cast<char>(frame.group)};
    text.append(frame.payload.substr(0, code_bytes)).append(": ").append(reason);
    return {std::string{frame.payload}, std::move(text), frame.group};
}

MalformedMessage too_long(const Frame& frame) {
    return malformed(frame, "the frame is longer than any that is known");
}

/// One variable that every path returns, so that the message is made in its place and never moved.
Message read(const Frame& frame, Read reader, EscapeMode escapes) {
    ParameterReader in{frame.payload.substr(code_bytes)};
    Message message = reader(in, escapes);
    if (!in.ok()) {
        message = malformed(frame, in.problem());
    }
    return message;
}

Message read_parameter(const Frame& frame, EscapeMode escapes) {
    const auto parameter = parameter_from_code(frame.payload.substr(0, code_bytes));
    if (!parameter) {
        return unknown(frame);
    }
    if (*parameter == Parameter::MR) {
        if (auto record = parse_mail_record(frame.payload.substr(code_bytes), escapes)) {
            return *std::move(record);
        }
        return malformed(frame, "the record number is wrong or missing");
    }
    const Read reader = parameter_readers[static_cast<std::size_t>(*parameter)];
    if (reader == nullptr) {
        return unknown(frame);
    }
    if (frame.truncated) {
        return too_long(frame);
    }
    return read(frame, reader, escapes);
}

Message read_file(const Frame& frame, EscapeMode escapes) {
    const auto command = file_command_from_code(frame.payload.substr(0, code_bytes));
    if (!command) {
        return unknown(frame);
    }
    if (frame.truncated) {
        return too_long(frame);
    }
    return read(frame, file_readers[static_cast<std::size_t>(*command)], escapes);
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

Message read_script(const Frame& frame, EscapeMode escapes) {
    if (frame.truncated) {
        return too_long(frame);
    }
    return ScriptLine{unescape(frame.payload, escapes)};
}

} // namespace

Message parse_message(const Frame& frame, EscapeMode escapes) {
    switch (frame.group) {
    case Group::script:
        return read_script(frame, escapes);
    case Group::action:
        return read_action(frame);
    case Group::inquiry:
        return read_inquiry(frame);
    case Group::parameter:
        return read_parameter(frame, escapes);
    case Group::file:
        return read_file(frame, escapes);
    }
    assertion_failed("Group", __FILE__, __LINE__);
}

} // namespace linefeed::protocol
