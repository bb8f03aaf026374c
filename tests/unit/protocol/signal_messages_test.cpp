// Inputs and outputs: bits, contacts, functions.
#include "parsing.hpp"

namespace linefeed::protocol {
namespace {

TEST(ExternalStates, shouldReadByPositionAndKeepTheParameterWithoutAName) {
    const auto states = parsed_as<ExternalStates>("^0=EX300\t5\t1800\t0\tq7\t1\tr\ts\tt\r");
    EXPECT_EQ(states, (ExternalStates{300, 5, 1800, EncoderDirection::backward, "q7", true}));
    EXPECT_EQ(encoded(states), "^0=EX300\t5\t1800\t0\tq7\t1\t0\t0\t0\r");
    EXPECT_EQ(parsed_as<ExternalStates>("^0=EX300\r").inputs, std::nullopt);
    EXPECT_EQ(reason("^0=EX1\tx\r"), "=EX: parameter 2 is not bits of inputs: \"x\"");
}

TEST(ExternalStates, shouldNameEachBitByItsContact) {
    // Protocol, section 4, EX, bit 0 to 17
    constexpr std::array<std::string_view, input_count> contacts{"X4.9", "X4.22", "X4.10", "X4.23", "X4.11", "X4.24",
                                                                 "X4.2", "X4.1",  "X4.3",  "X4.16", "X4.4",  "X4.17",
                                                                 "X4.5", "X4.18", "X4.6",  "X4.19", "X4.7",  "X4.20"};
    for (std::size_t bit = 0; bit < input_count; ++bit) {
        const auto input = static_cast<Input>(bit);
        EXPECT_EQ(contact(input), contacts[bit]);
        EXPECT_EQ(input_from_contact(contacts[bit]), input);
        EXPECT_TRUE(is_on(1U << bit, input));
        EXPECT_FALSE(is_on(~(1U << bit), input));
    }
    EXPECT_EQ(input_from_contact("x4.22"), Input::x4_22);
    EXPECT_EQ(input_from_contact("X4.21"), std::nullopt);
    EXPECT_EQ(purpose(Input::x4_24), "");
    EXPECT_EQ(purpose(Input::x4_2), "counter increment");
    EXPECT_EQ(purpose(Input::x4_20), "job select 9");
}

TEST(ExternalStates, shouldSayInWordsWhichInputsAreOn) {
    EXPECT_EQ(describe_inputs(0), "none");
    EXPECT_EQ(describe_inputs(0b1100'0001), "X4.9, X4.2 (counter increment), X4.1 (counter reset)");
    EXPECT_EQ(describe_inputs(0xFFFC'0000), "none") << "bits that the manual does not know";
}

TEST(InputConfiguration, shouldReadThreeOrSixFunctions) {
    const auto small = parsed_as<InputConfiguration>("^0=IC3\t4\t0\r");
    EXPECT_EQ(small.functions[1], InputFunction::print_stop);
    EXPECT_EQ(small.functions[3], std::nullopt);
    EXPECT_EQ(encoded(small), "^0=IC3\t4\t0\r");
    EXPECT_EQ(parsed_as<InputConfiguration>("^0=IC3\t4\t0\t1\t2\t99\r").functions[5], InputFunction{99});
    EXPECT_EQ(reason("^0=IC3\tx\r"), "=IC: parameter 2 is not an input function: \"x\"");
}

TEST(OutputConfiguration, shouldReadFourOrEightSignals) {
    const auto small = parsed_as<OutputConfiguration>("^0=OC1\t2\t3\t8\r");
    EXPECT_EQ(small.signals[3], OutputSignal::power_fail);
    EXPECT_EQ(small.signals[4], std::nullopt);
    EXPECT_EQ(encoded(small), "^0=OC1\t2\t3\t8\r");
}

TEST(OutputChange, shouldKeepOutputAndStateInTheirRanges) {
    EXPECT_EQ(reason("^0=CO9\t1\r"), "=CO: parameter 1 is not an output: \"9\"");
    EXPECT_EQ(reason("^0=CO1\t2\r"), "=CO: parameter 2 is not 0 or 1: \"2\"");
    EXPECT_EQ(reason("^0=CO1\r"), "=CO: parameter 2 is missing: 0 or 1");
    EXPECT_FALSE(parsed_as<OutputChange>("^0=CO8\t0\r").is_control());
}

TEST(SignalWords, shouldSayEveryNumberOfTheManual) {
    const std::array<std::string_view, 13> functions{
        "disabled",        "nozzle open",     "nozzle close",      "print start",
        "print stop",      "shutdown",        "horizontal mirror", "cutting synchronisation",
        "counter reset 1", "counter reset 2", "load job",          "ink on/off",
        "batch job reset"};
    for (std::uint32_t i = 0; i < functions.size(); ++i) {
        EXPECT_EQ(to_string(InputFunction{i}), functions[i]);
    }
    EXPECT_EQ(to_string(InputFunction{13}), "unknown");
    const std::array<std::string_view, 14> signals{"disabled",
                                                   "refill warning",
                                                   "error or print stop",
                                                   "print readiness",
                                                   "print active",
                                                   "product counter reached its end",
                                                   "PrintGo",
                                                   "encoder",
                                                   "power fail (inverted)",
                                                   "camera trigger",
                                                   "counter overflow",
                                                   "camera error",
                                                   "camera warning",
                                                   "maximum speed reached"};
    for (std::uint32_t i = 0; i < signals.size(); ++i) {
        EXPECT_EQ(to_string(OutputSignal{i}), signals[i]);
    }
    EXPECT_EQ(to_string(OutputSignal{14}), "unknown");
    EXPECT_EQ(to_string(EncoderDirection::backward), "backward");
    EXPECT_EQ(to_string(EncoderDirection::forward), "forward");
    EXPECT_EQ(to_string(EncoderDirection{2}), "unknown");
}

} // namespace
} // namespace linefeed::protocol
