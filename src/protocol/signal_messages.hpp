// The signals at the printer's connectors: `=CO =EX =IC =OC` (protocol, section 4).
#pragma once

#include "protocol/commands.hpp"
#include "protocol/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace linefeed::protocol {

/// The inputs of `=EX`, named by their contacts; the value is the bit.
enum class Input : std::uint8_t {
    x4_9 = 0,
    x4_22 = 1,
    x4_10 = 2,
    x4_23 = 3,
    x4_11 = 4,
    x4_24 = 5,
    x4_2 = 6,  ///< counter increment
    x4_1 = 7,  ///< counter reset
    x4_3 = 8,  ///< job select 0
    x4_16 = 9, ///< job select 1
    x4_4 = 10,
    x4_17 = 11,
    x4_5 = 12,
    x4_18 = 13,
    x4_6 = 14,
    x4_19 = 15, ///< job select 7
    x4_7 = 16,  ///< job select 8; reserved on JET2neo
    x4_20 = 17, ///< job select 9; reserved on JET2neo
};
inline constexpr std::size_t input_count = 18;

/// Whether the bit of an input is set.
[[nodiscard]] constexpr bool is_on(std::uint32_t inputs, Input input) {
    return (inputs >> static_cast<unsigned>(input) & 1U) != 0;
}
/// E.g. "X4.9".
[[nodiscard]] std::string_view contact(Input input);
/// What an input with a fixed purpose is for, e.g. "job select 3"; empty for one whose function is configured (IC).
[[nodiscard]] std::string_view purpose(Input input);
/// The input with that contact, whatever the case.
[[nodiscard]] std::optional<Input> input_from_contact(std::string_view contact);
/// The inputs that are set, e.g. "X4.9, X4.2 (counter increment)", or "none".
[[nodiscard]] std::string describe_inputs(std::uint32_t inputs);

/// EX, parameter 4: the encoder's direction.
enum class EncoderDirection : std::uint32_t { backward = 0, forward = 1 };

/// `=EX`, printer to host: speeds and external signals. Speeds in dm/min, or in m/min on old firmware (profile).
struct ExternalStates {
    static constexpr Parameter parameter = Parameter::EX;
    std::optional<std::uint32_t> speed{};
    std::optional<std::uint32_t> inputs{}; ///< a bit for each Input
    std::optional<std::uint32_t> max_speed{};
    std::optional<EncoderDirection> direction{};
    std::string not_named{};        ///< parameter 5, which the manual leaves out: as it came
    std::optional<bool> print_go{}; ///< level of the signal

    static void describe(auto& visitor, auto& self) {
        visitor.optional("speed", "a speed", self.speed);
        visitor.optional("inputs", "bits of inputs", self.inputs);
        visitor.optional("max_speed", "a speed", self.max_speed);
        visitor.optional("direction", "a direction", self.direction);
        visitor.verbatim("parameter_5", self.not_named);
        visitor.optional("print_go", "0 or 1", self.print_go);
        visitor.reserved();
        visitor.reserved();
        visitor.reserved();
    }
    friend bool operator==(const ExternalStates&, const ExternalStates&) = default;
};

/// IC: what an input does.
enum class InputFunction : std::uint32_t {
    disabled = 0,
    nozzle_open = 1,
    nozzle_close = 2,
    print_start = 3,
    print_stop = 4,
    shutdown = 5,
    horizontal_mirror = 6,
    cutting_sync = 7,
    counter_reset_1 = 8,
    counter_reset_2 = 9,
    load_job = 10,
    ink_on_off = 11,
    batch_job_reset = 12,
};

/// `=IC`, printer to host: the functions of the inputs X4.9 X4.22 X4.10 X4.23 X4.11 X4.24 (Input 0…5). JET2neo has 3.
struct InputConfiguration {
    static constexpr Parameter parameter = Parameter::IC;
    static constexpr std::size_t max_inputs = 6;
    static constexpr std::array<std::string_view, max_inputs> keys{"x4_9", "x4_22", "x4_10", "x4_23", "x4_11", "x4_24"};
    std::array<std::optional<InputFunction>, max_inputs> functions{};

    static void describe(auto& visitor, auto& self) {
        for (std::size_t i = 0; i < max_inputs; ++i) {
            visitor.added(keys[i], "an input function", self.functions[i]);
        }
    }
    friend bool operator==(const InputConfiguration&, const InputConfiguration&) = default;
};

/// OC: what an output signals.
enum class OutputSignal : std::uint32_t {
    disabled = 0,
    refill_warning = 1,
    error_or_stop = 2,
    print_ready = 3,
    print_active = 4,
    product_counter_end = 5,
    print_go = 6,
    encoder = 7,
    power_fail = 8, ///< inverted: 1 while the supply works
    camera_trigger = 9,
    counter_overflow = 10,
    camera_error = 11,
    camera_warning = 12,
    maximum_speed = 13,
};

/// `=OC`, printer to host: the signals of the outputs X3.1-4 and X3.9-12. JET2neo has 4.
struct OutputConfiguration {
    static constexpr Parameter parameter = Parameter::OC;
    static constexpr std::size_t max_outputs = 8;
    static constexpr std::array<std::string_view, max_outputs> keys{"x3_1", "x3_2",  "x3_3",  "x3_4",
                                                                    "x3_9", "x3_10", "x3_11", "x3_12"};
    std::array<std::optional<OutputSignal>, max_outputs> signals{};

    static void describe(auto& visitor, auto& self) {
        for (std::size_t i = 0; i < max_outputs; ++i) {
            visitor.added(keys[i], "an output signal", self.signals[i]);
        }
    }
    friend bool operator==(const OutputConfiguration&, const OutputConfiguration&) = default;
};

/// `=CO`, host to printer: output 1…8 to a state. Output 0 takes control of all (1) or gives it back and undoes the
/// changes (0); while in control the printer raises no signals of its own on them. Not on JET2neo.
struct OutputChange {
    static constexpr Parameter parameter = Parameter::CO;
    std::uint32_t output = 0;
    bool on = false;

    [[nodiscard]] bool is_control() const { return output == 0; }
    static void describe(auto& visitor, auto& self) {
        visitor.number("output", "an output", self.output, Limits{0, 8});
        visitor.number("state", "0 or 1", self.on, zero_or_one);
    }
    friend bool operator==(const OutputChange&, const OutputChange&) = default;
};

/// Words for people, e.g. "nozzle open"; "unknown" for a number that newer firmware may have.
[[nodiscard]] std::string_view to_string(EncoderDirection direction);
[[nodiscard]] std::string_view to_string(InputFunction function);
[[nodiscard]] std::string_view to_string(OutputSignal signal);

} // namespace linefeed::protocol
