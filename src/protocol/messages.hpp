// Every command of the protocol as a typed message (sections 2 to 8), with parser and encoder. A new command gets its
// struct in the header of its theme, its place in Message, and its row in command_table.hpp. As the manual demands: an
// empty parameter leaves its value, excess parameters are ignored, unknown commands are carried along as they came.
#pragma once

#include "protocol/commands.hpp"
#include "protocol/counter_messages.hpp"
#include "protocol/escapes.hpp"
#include "protocol/file_messages.hpp"
#include "protocol/frame.hpp"
#include "protocol/list_messages.hpp"
#include "protocol/machine_messages.hpp"
#include "protocol/mail_record.hpp"
#include "protocol/print_messages.hpp"
#include "protocol/signal_messages.hpp"
#include "protocol/transmission_messages.hpp"

#include <concepts>
#include <string>
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

/// A frame that no type describes: carried along as it came.
struct UnknownMessage {
    Group group = Group::parameter;
    std::string payload{};
    friend bool operator==(const UnknownMessage&, const UnknownMessage&) = default;
};

/// A known command whose parameters cannot be read.
struct MalformedMessage {
    std::string payload{};
    std::string reason{}; ///< e.g. "=SM: parameter 3 is not a record number: \"x\""
    Group group = Group::parameter;
    friend bool operator==(const MalformedMessage&, const MalformedMessage&) = default;
};

using Message =
    std::variant<UnknownMessage, MalformedMessage, ActionMessage, InquiryMessage, MachineStatus, MailStatus, StopAt,
                 Counters, VersionInfo, JobName, MailRecord, ClockTime, FreeFlash, HydraulicState, MainConfiguration,
                 ActorStates, ServiceIntervals, ServiceHistory, TankLevels, ExternalStates, InputConfiguration,
                 OutputConfiguration, OutputChange, JobCounters, CounterParameter, CounterReset, ExternText,
                 PrintParameter, WysiwygStart, WysiwygLine, NextCrc, CrcFailed, BlockLength, ErrorListBlock,
                 EventListBlock, ScriptLine, DirectoryRequest, DirectoryBlock, FileDeletion, FileRequest, FileHeader,
                 FileBlock, FileAcknowledgement>;

/// Decodes a frame. Never fails: what cannot be read is MalformedMessage or UnknownMessage. Allocates only for messages
/// with text or lists; RS, SM, CC and actions never do.
[[nodiscard]] Message parse_message(const Frame& frame, EscapeMode escapes);

/// A message that is a row of fields, which it describes: `describe(visitor, message)` calls the visitor for each. It
/// names its parameter or its file command.
template <typename T>
concept DescribedParameter = std::same_as<decltype(T::parameter), const Parameter>;
template <typename T>
concept DescribedFile = std::same_as<decltype(T::command), const FileCommand>;
template <typename T>
concept DescribedMessage = DescribedParameter<T> || DescribedFile<T>;
/// A described message with text, which firmware with escapes wants escaped.
template <typename T>
concept DescribedText = DescribedMessage<T> && requires {
    T::has_text;
};

/// Appends the frame of a message to `out`. Precondition: every value is within the range that its type states, and no
/// text holds a CR (a TAB only where TABs belong to the text).
template <DescribedMessage T>
requires(!DescribedText<T>) void append_message(std::string& out, const T& message);
template <DescribedText T>
void append_message(std::string& out, const T& message, EscapeMode escapes);
void append_message(std::string& out, const ActionMessage& message);
void append_message(std::string& out, const InquiryMessage& message);
void append_message(std::string& out, const JobCounters& counters);
void append_message(std::string& out, const CounterReset& reset);
void append_message(std::string& out, const ErrorListBlock& block);
void append_message(std::string& out, const EventListBlock& block);
void append_message(std::string& out, const WysiwygLine& line);
void append_message(std::string& out, const FileBlock& block);
void append_message(std::string& out, const ExternText& text, EscapeMode escapes);
void append_message(std::string& out, const MailRecord& record, EscapeMode escapes);
void append_message(std::string& out, const ScriptLine& line, EscapeMode escapes);
void append_message(std::string& out, const DirectoryBlock& block, EscapeMode escapes);
/// As it came.
void append_message(std::string& out, const UnknownMessage& message);
void append_message(std::string& out, const MalformedMessage& message);

/// The same for whatever message it is.
void append_any_message(std::string& out, const Message& message, EscapeMode escapes);

} // namespace linefeed::protocol
