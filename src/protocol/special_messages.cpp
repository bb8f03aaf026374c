// Readers of their own, see special_messages.hpp.
#include "protocol/special_messages.hpp"

#include "protocol/decimal.hpp"
#include "protocol/nibbles.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace linefeed::protocol {

namespace {

/// The text up to the next `/`, taken off with it.
std::string_view take_part(std::string_view& text) {
    const std::size_t end = std::min(text.find('/'), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
}

constexpr std::uint32_t last_machine_state = 6;

MachineState machine_state(std::uint32_t number) {
    return number <= last_machine_state ? static_cast<MachineState>(number) : MachineState::unknown;
}

std::optional<ErrorEntry> read_entry(std::string_view text, const ErrorEntry*) {
    const auto time = read_short_date(take_part(text));
    const std::string_view number = take_part(text);
    const auto as_signed = read_decimal<std::int32_t>(number);
    const auto as_unsigned = read_decimal<std::uint32_t>(number);
    if (!time || !(as_signed || as_unsigned)) {
        return std::nullopt;
    }
    return ErrorEntry{*time, {as_signed ? *as_signed : static_cast<std::int32_t>(*as_unsigned)}};
}

std::optional<EventEntry> read_entry(std::string_view text, const EventEntry*) {
    const auto time = read_short_date(take_part(text));
    EventEntry entry{.time = time.value_or(PrinterTime{})};
    for (std::uint32_t EventEntry::*const member :
         {&EventEntry::compressor_pulses, &EventEntry::solvent_sips, &EventEntry::ink_sips, &EventEntry::mixing_ratio,
          &EventEntry::pressure_mbar, &EventEntry::diaphragm_position, &EventEntry::fall_time_ms}) {
        const auto value = read_decimal<std::uint32_t>(take_part(text));
        if (!value) {
            return std::nullopt;
        }
        entry.*member = *value;
    }
    const auto machine = read_decimal<std::uint32_t>(take_part(text));
    if (!time || !machine) {
        return std::nullopt;
    }
    entry.machine = machine_state(*machine);
    return entry;
}

template <typename Block>
Block read_list(ParameterReader& in) {
    Block block;
    block.first = in.number("the number of an entry");
    block.total = in.number("a number of entries");
    const std::uint32_t count = in.number("a number of entries", 0, Block::max_entries);
    for (std::uint32_t i = 0; i < count && in.ok(); ++i) {
        const std::string_view text = in.text().value_or(std::string_view{});
        if (const auto entry = read_entry(text, static_cast<const typename Block::Entry*>(nullptr))) {
            block.entries.push_back(*entry);
        } else {
            in.refuse("an entry", text);
        }
    }
    return block;
}

} // namespace

MachineStatus read_machine_status(ParameterReader& in) {
    MachineStatus status;
    // In standby only the machine state is valid; other firmware may know more states.
    const auto nozzle = in.optional_number("a nozzle state").value_or(0);
    status.nozzle = nozzle <= 5 ? static_cast<NozzleState>(nozzle) : NozzleState::invalid;
    status.machine = machine_state(in.number("a machine state"));
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

JobCounters read_job_counters(ParameterReader& in) {
    constexpr unsigned high_shift = 32;
    JobCounters message;
    const std::uint32_t count = in.number("a number of counters");
    for (std::uint32_t i = 0; i < count && in.ok(); ++i) {
        JobCounter counter;
        counter.done_repetitions = in.number("a number of repetitions");
        const std::uint64_t high = in.number("the high part of a value");
        counter.value = high << high_shift | in.number("the low part of a value");
        message.counters.push_back(counter);
    }
    return message;
}

CounterReset read_counter_reset(ParameterReader& in) {
    CounterReset reset;
    reset.counter = in.number("a counter id");
    const std::string_view text = in.trimmed();
    if (text.empty() || text == "-1") {
        return reset;
    }
    reset.start = read_decimal<std::uint64_t>(text);
    if (!reset.start || *reset.start > max_counter_value) {
        in.refuse("a start value", text);
    }
    return reset;
}

ErrorListBlock read_error_list(ParameterReader& in) {
    return read_list<ErrorListBlock>(in);
}

EventListBlock read_event_list(ParameterReader& in) {
    return read_list<EventListBlock>(in);
}

WysiwygLine read_wysiwyg_line(ParameterReader& in) {
    const std::string_view text = in.trimmed();
    auto bytes = read_nibbles(text);
    if (!bytes || bytes->size() > max_wysiwyg_line) {
        in.refuse("up to 60 nibbles", text);
    }
    return {std::move(bytes).value_or(std::string{})};
}

ExternText read_extern_text(ParameterReader& in, EscapeMode escapes) {
    ExternText message{unescape(in.rest().substr(0, max_extern_text), escapes)};
    std::ranges::replace(message.text, '\0', ' ');
    return message;
}

DirectoryBlock read_directory_block(ParameterReader& in, EscapeMode escapes) {
    DirectoryBlock block;
    block.last = in.number("0 or 1", 0, 1) == 1;
    const std::uint32_t count = in.number("a number of entries", 0, DirectoryBlock::max_entries);
    for (std::uint32_t i = 0; i < count && in.ok(); ++i) {
        std::string_view name = in.text().value_or(std::string_view{});
        const bool is_directory = name.starts_with('!');
        name.remove_prefix(is_directory ? 1 : 0);
        if (name.empty()) {
            in.refuse("an entry", name);
        } else {
            block.entries.push_back({unescape(name, escapes), is_directory});
        }
    }
    return block;
}

FileBlock read_file_block(ParameterReader& in) {
    FileBlock block;
    block.number = in.number("a block number");
    block.checksum = static_cast<std::uint8_t>(in.number("a checksum", 0, std::numeric_limits<std::uint8_t>::max()));
    const std::string_view text = in.text().value_or(std::string_view{});
    auto bytes = read_nibbles(text);
    if (!bytes || bytes->size() > FileBlock::max_bytes) {
        in.refuse("a block of nibbles", text);
    }
    block.bytes = std::move(bytes).value_or(std::string{});
    return block;
}

} // namespace linefeed::protocol
