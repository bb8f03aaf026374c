// Encodes messages as the manual writes them, see messages.hpp.
#include "base/assert.hpp"
#include "protocol/decimal.hpp"
#include "protocol/field_writer.hpp"
#include "protocol/frame_encoder.hpp"
#include "protocol/messages.hpp"
#include "protocol/nibbles.hpp"

#include <algorithm>
#include <cstddef>

namespace linefeed::protocol {

namespace {

template <DescribedMessage T>
void append_described(std::string& out, const T& message, EscapeMode escapes) {
    const auto writer_of = [&out, escapes] {
        if constexpr (DescribedParameter<T>) {
            return FieldWriter{out, Group::parameter, code(T::parameter), escapes};
        } else {
            return FieldWriter{out, Group::file, code(T::command), escapes};
        }
    };
    FieldWriter writer = writer_of();
    T::describe(writer, message);
    writer.end();
}

/// The head of a frame that is no row of fields.
void append_head(std::string& out, Group group, std::string_view code) {
    out.append({'^', printer_address, static_cast<char>(group)});
    out.append(code);
}

/// At least so many digits, as real printers write some numbers.
void append_padded(std::string& out, std::int64_t value, std::size_t digits) {
    const std::size_t begin = out.size();
    append_decimal(out, value);
    if (value >= 0 && out.size() - begin < digits) {
        out.insert(begin, digits - (out.size() - begin), '0');
    }
}

void append_entry(std::string& out, const ErrorEntry& entry) {
    constexpr std::size_t digits = 8; // field notes, "Firmware habits"
    append_short_date(out, entry.time);
    out.push_back('/');
    append_padded(out, entry.error.raw, digits);
}

void append_entry(std::string& out, const EventEntry& entry) {
    append_short_date(out, entry.time);
    for (const std::uint32_t value : {entry.compressor_pulses, entry.solvent_sips, entry.ink_sips, entry.mixing_ratio,
                                      entry.pressure_mbar, entry.diaphragm_position, entry.fall_time_ms}) {
        out.push_back('/');
        append_decimal(out, value);
    }
    out.push_back('/');
    append_decimal(out, static_cast<int>(entry.machine));
}

template <typename Block>
void append_list(std::string& out, const Block& block) {
    LINEFEED_ASSERT(block.entries.size() <= Block::max_entries);
    append_head(out, Group::parameter, code(Block::list));
    append_decimal(out, block.first);
    out.push_back('\t');
    append_decimal(out, block.total);
    out.push_back('\t');
    append_decimal(out, block.entries.size());
    for (const auto& entry : block.entries) {
        out.push_back('\t');
        append_entry(out, entry);
    }
    out.push_back('\r');
}

} // namespace

template <DescribedMessage T>
requires(!DescribedText<T>) void append_message(std::string& out, const T& message) {
    append_described(out, message, EscapeMode::none);
}

template <DescribedText T>
void append_message(std::string& out, const T& message, EscapeMode escapes) {
    append_described(out, message, escapes);
}

template void append_message(std::string&, const MachineStatus&);
template void append_message(std::string&, const MailStatus&);
template void append_message(std::string&, const StopAt&);
template void append_message(std::string&, const Counters&);
template void append_message(std::string&, const ClockTime&);
template void append_message(std::string&, const FreeFlash&);
template void append_message(std::string&, const HydraulicState&);
template void append_message(std::string&, const MainConfiguration&);
template void append_message(std::string&, const ActorStates&);
template void append_message(std::string&, const ServiceIntervals&);
template void append_message(std::string&, const ServiceHistory&);
template void append_message(std::string&, const TankLevels&);
template void append_message(std::string&, const ExternalStates&);
template void append_message(std::string&, const InputConfiguration&);
template void append_message(std::string&, const OutputConfiguration&);
template void append_message(std::string&, const OutputChange&);
template void append_message(std::string&, const CounterParameter&);
template void append_message(std::string&, const PrintParameter&);
template void append_message(std::string&, const WysiwygStart&);
template void append_message(std::string&, const NextCrc&);
template void append_message(std::string&, const CrcFailed&);
template void append_message(std::string&, const BlockLength&);
template void append_message(std::string&, const FileAcknowledgement&);
template void append_message(std::string&, const VersionInfo&, EscapeMode);
template void append_message(std::string&, const JobName&, EscapeMode);
template void append_message(std::string&, const DirectoryRequest&, EscapeMode);
template void append_message(std::string&, const FileDeletion&, EscapeMode);
template void append_message(std::string&, const FileRequest&, EscapeMode);
template void append_message(std::string&, const FileHeader&, EscapeMode);

void append_message(std::string& out, const ActionMessage& message) {
    append_action(out, message.action);
}

void append_message(std::string& out, const InquiryMessage& message) {
    LINEFEED_ASSERT(message.argument.find('\r') == std::string::npos);
    append_head(out, Group::inquiry, code(message.parameter));
    out.append(message.argument).push_back('\r');
}

void append_message(std::string& out, const JobCounters& counters) {
    constexpr unsigned high_shift = 32;
    append_head(out, Group::parameter, code(Parameter::AC));
    append_decimal(out, counters.counters.size());
    for (const JobCounter& counter : counters.counters) {
        for (const std::uint64_t part :
             {std::uint64_t{counter.done_repetitions}, counter.value >> high_shift, counter.value & 0xFFFF'FFFFU}) {
            out.push_back('\t');
            append_decimal(out, part);
        }
    }
    out.push_back('\r');
}

void append_message(std::string& out, const CounterReset& reset) {
    append_head(out, Group::parameter, code(Parameter::RC));
    append_decimal(out, reset.counter);
    if (reset.start) {
        LINEFEED_ASSERT(*reset.start <= max_counter_value);
        out.push_back('\t');
        append_decimal(out, *reset.start);
    }
    out.push_back('\r');
}

void append_message(std::string& out, const ErrorListBlock& block) {
    append_list(out, block);
}

void append_message(std::string& out, const EventListBlock& block) {
    append_list(out, block);
}

void append_message(std::string& out, const WysiwygLine& line) {
    LINEFEED_ASSERT(line.bytes.size() <= max_wysiwyg_line);
    append_head(out, Group::parameter, code(Parameter::GW));
    append_nibbles(out, line.bytes);
    out.push_back('\r');
}

void append_message(std::string& out, const FileBlock& block) {
    LINEFEED_ASSERT(block.bytes.size() <= FileBlock::max_bytes);
    append_head(out, Group::file, code(FileCommand::FT));
    append_decimal(out, block.number);
    out.push_back('\t');
    append_decimal(out, static_cast<unsigned>(block.checksum));
    out.push_back('\t');
    append_nibbles(out, block.bytes);
    out.push_back('\r');
}

void append_message(std::string& out, const ExternText& text, EscapeMode escapes) {
    LINEFEED_ASSERT(text.text.size() <= max_extern_text && text.text.find('\r') == std::string::npos);
    append_head(out, Group::parameter, code(Parameter::ET));
    append_escaped(out, text.text, escapes);
    out.push_back('\r');
}

void append_message(std::string& out, const MailRecord& record, EscapeMode escapes) {
    append_head(out, Group::parameter, code(Parameter::MR));
    append_decimal(out, record.number.value());
    for (const std::string& field : record.fields) {
        LINEFEED_ASSERT(field.find_first_of("\t\r") == std::string::npos);
        out.push_back('\t');
        append_escaped(out, field, escapes);
    }
    if (!record.properties.empty()) {
        out.push_back('\t');
        append_properties(out, record.properties);
    }
    out.push_back('\r');
}

void append_message(std::string& out, const ScriptLine& line, EscapeMode escapes) {
    LINEFEED_ASSERT(line.text.find('\r') == std::string::npos);
    append_head(out, Group::script, "");
    append_escaped(out, line.text, escapes);
    out.push_back('\r');
}

void append_message(std::string& out, const DirectoryBlock& block, EscapeMode escapes) {
    LINEFEED_ASSERT(block.entries.size() <= DirectoryBlock::max_entries);
    append_head(out, Group::file, code(FileCommand::DI));
    out.append(block.last ? "1\t" : "0\t");
    append_padded(out, static_cast<std::int64_t>(block.entries.size()), 2); // as in the manual's examples
    for (const DirectoryEntry& entry : block.entries) {
        LINEFEED_ASSERT(entry.name.find_first_of("\t\r") == std::string::npos);
        out.append(entry.is_directory ? "\t!" : "\t");
        append_escaped(out, entry.name, escapes);
    }
    out.push_back('\r');
}

void append_message(std::string& out, const UnknownMessage& message) {
    append_frame(out, message.group, message.payload);
}

void append_message(std::string& out, const MalformedMessage& message) {
    append_frame(out, message.group, message.payload);
}

void append_any_message(std::string& out, const Message& message, EscapeMode escapes) {
    std::visit(
        [&out, escapes](const auto& typed) {
            if constexpr (requires { append_message(out, typed, escapes); }) {
                append_message(out, typed, escapes);
            } else {
                append_message(out, typed);
            }
        },
        message);
}

} // namespace linefeed::protocol
