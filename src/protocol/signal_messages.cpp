// Contacts and words of the signals, see signal_messages.hpp.
#include "protocol/signal_messages.hpp"

#include <algorithm>

namespace linefeed::protocol {

namespace {

struct InputRow {
    std::string_view contact;
    std::string_view purpose;
};

/// Protocol, section 4, EX: by bit.
constexpr std::array<InputRow, input_count> inputs_by_bit{{
    {"X4.9", ""},
    {"X4.22", ""},
    {"X4.10", ""},
    {"X4.23", ""},
    {"X4.11", ""},
    {"X4.24", ""},
    {"X4.2", "counter increment"},
    {"X4.1", "counter reset"},
    {"X4.3", "job select 0"},
    {"X4.16", "job select 1"},
    {"X4.4", "job select 2"},
    {"X4.17", "job select 3"},
    {"X4.5", "job select 4"},
    {"X4.18", "job select 5"},
    {"X4.6", "job select 6"},
    {"X4.19", "job select 7"},
    {"X4.7", "job select 8"},
    {"X4.20", "job select 9"},
}};

char upper(char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

} // namespace

std::string_view contact(Input input) {
    return inputs_by_bit[static_cast<std::size_t>(input)].contact;
}

std::string_view purpose(Input input) {
    return inputs_by_bit[static_cast<std::size_t>(input)].purpose;
}

std::optional<Input> input_from_contact(std::string_view contact) {
    const auto* const found = std::ranges::find_if(inputs_by_bit, [contact](const InputRow& row) {
        return std::ranges::equal(row.contact, contact, {}, {}, upper);
    });
    return found == inputs_by_bit.end() ? std::nullopt
                                        : std::optional{static_cast<Input>(found - inputs_by_bit.begin())};
}

std::string describe_inputs(std::uint32_t inputs) {
    std::string out;
    for (std::size_t bit = 0; bit < input_count; ++bit) {
        const auto input = static_cast<Input>(bit);
        if (is_on(inputs, input)) {
            out.append(out.empty() ? "" : ", ").append(contact(input));
            if (!purpose(input).empty()) {
                out.append(" (").append(purpose(input)).append(")");
            }
        }
    }
    return out.empty() ? "none" : out;
}

std::string_view to_string(EncoderDirection direction) {
    switch (direction) {
    case EncoderDirection::backward:
        return "backward";
    case EncoderDirection::forward:
        return "forward";
    }
    return "unknown";
}

std::string_view to_string(InputFunction function) {
    switch (function) {
    case InputFunction::disabled:
        return "disabled";
    case InputFunction::nozzle_open:
        return "nozzle open";
    case InputFunction::nozzle_close:
        return "nozzle close";
    case InputFunction::print_start:
        return "print start";
    case InputFunction::print_stop:
        return "print stop";
    case InputFunction::shutdown:
        return "shutdown";
    case InputFunction::horizontal_mirror:
        return "horizontal mirror";
    case InputFunction::cutting_sync:
        return "cutting synchronisation";
    case InputFunction::counter_reset_1:
        return "counter reset 1";
    case InputFunction::counter_reset_2:
        return "counter reset 2";
    case InputFunction::load_job:
        return "load job";
    case InputFunction::ink_on_off:
        return "ink on/off";
    case InputFunction::batch_job_reset:
        return "batch job reset";
    }
    return "unknown";
}

std::string_view to_string(OutputSignal signal) {
    switch (signal) {
    case OutputSignal::disabled:
        return "disabled";
    case OutputSignal::refill_warning:
        return "refill warning";
    case OutputSignal::error_or_stop:
        return "error or print stop";
    case OutputSignal::print_ready:
        return "print readiness";
    case OutputSignal::print_active:
        return "print active";
    case OutputSignal::product_counter_end:
        return "product counter reached its end";
    case OutputSignal::print_go:
        return "PrintGo";
    case OutputSignal::encoder:
        return "encoder";
    case OutputSignal::power_fail:
        return "power fail (inverted)";
    case OutputSignal::camera_trigger:
        return "camera trigger";
    case OutputSignal::counter_overflow:
        return "counter overflow";
    case OutputSignal::camera_error:
        return "camera error";
    case OutputSignal::camera_warning:
        return "camera warning";
    case OutputSignal::maximum_speed:
        return "maximum speed reached";
    }
    return "unknown";
}

} // namespace linefeed::protocol
