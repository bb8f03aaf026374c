// The settings of a printer and of its job: counters, outputs, clock, parameters, text, and the modes of its answers.
#include "printer/change.hpp"
#include "printer/host_time.hpp"
#include "printer/message_json.hpp"
#include "printer/print_parameters.hpp"
#include "printer/printer_path.hpp"
#include "printer/tasks.hpp"

#include <array>
#include <chrono>

namespace linefeed::printer {

using protocol::Action;
using protocol::Parameter;

namespace {

Result<Json> set_counters(PrinterClient& printer, const Order& order) {
    protocol::Counters wanted;
    const auto number = [&order](std::string_view name) {
        const auto value = order.arguments.number(name);
        return value ? std::optional{static_cast<std::uint32_t>(*value)} : std::nullopt;
    };
    wanted.product = number("product");
    wanted.stop_after = number("stop_after");
    if (!wanted.product && !wanted.stop_after) {
        return Failure{FailureKind::usage, "say product, stop_after or both"};
    }
    if (!printer.send(wanted)) {
        return not_confirmed(printer);
    }
    const auto now = asked<protocol::Counters>(printer, Parameter::CC);
    if (!now) {
        return now.error();
    }
    if (wanted.stop_after && now->stop_after != wanted.stop_after) {
        return not_taken("it stops after " + std::to_string(now->stop_after.value_or(0)) + " products");
    }
    return json_result(fields_of(*now));
}

/// The printer would say nothing, and do nothing.
Failure unknown_to(const PrinterClient& printer, std::string_view command, std::string_view property) {
    return {FailureKind::stopped, "firmware of the profile " + to_string(printer.settings().profile) + " knows no " +
                                      std::string{command} + "; if this one does, say so: " + std::string{property} +
                                      "=on behind the profile's name"};
}

/// Sends what is for one counter of the job, or for all (0). The printer passes over one that the job has not; it says
/// how many there are, unless its firmware does not know `?AC`.
Result<Json> sent_to_counter(PrinterClient& printer, std::uint32_t counter, const protocol::Message& message) {
    auto said = sent(printer, message);
    const auto has = said ? printer.ask<protocol::JobCounters>(Parameter::AC) : std::nullopt;
    if (has && counter > has->counters.size()) {
        return not_taken("the job has " + (has->counters.empty() ? "no" : std::to_string(has->counters.size())) +
                         (has->counters.size() == 1 ? " counter" : " counters"));
    }
    return said;
}

Result<Json> limit_counter(PrinterClient& printer, const Order& order) {
    if (!printer.settings().profile.counter_parameters) {
        return unknown_to(printer, "=CP", "counter-limits");
    }
    const std::string limit = order.arguments.text("limit");
    if (limit != "start" && limit != "end") {
        return Failure{FailureKind::usage, "limit must be start or end"};
    }
    const auto counter = static_cast<std::uint32_t>(*order.arguments.number("counter"));
    return sent_to_counter(printer, counter,
                           protocol::CounterParameter{
                               counter, limit == "start" ? protocol::CounterLimit::start : protocol::CounterLimit::end,
                               *order.arguments.number("value")});
}

Result<Json> reset_counter(PrinterClient& printer, const Order& order) {
    const auto counter = static_cast<std::uint32_t>(*order.arguments.number("counter"));
    return sent_to_counter(printer, counter, protocol::CounterReset{counter, order.arguments.number("start")});
}

Result<Json> send_output(PrinterClient& printer, const protocol::OutputChange& change) {
    return printer.settings().profile.output_control ? sent(printer, change)
                                                     : unknown_to(printer, "=CO", "output-control");
}

template <bool take>
Result<Json> control_outputs(PrinterClient& printer, const Order& /*order*/) {
    return send_output(printer, {0, take});
}

Result<Json> set_output(PrinterClient& printer, const Order& order) {
    const std::string state = order.arguments.text("state");
    if (state != "on" && state != "off") {
        return Failure{FailureKind::usage, "state must be on or off"};
    }
    return send_output(printer, {static_cast<std::uint32_t>(*order.arguments.number("output")), state == "on"});
}

Result<Json> set_clock(PrinterClient& printer, const Order& order) {
    const auto wanted = read_clock(order.arguments.text("time"));
    if (!wanted) {
        return wanted.error();
    }
    if (!printer.send(*wanted)) {
        return not_confirmed(printer);
    }
    const auto now = asked<protocol::ClockTime>(printer, Parameter::DL);
    if (!now) {
        return now.error();
    }
    constexpr std::chrono::seconds tolerance{5}; // for the way there and back
    if (std::chrono::abs(ahead_of(*now, *wanted)) > tolerance) {
        return not_taken("its clock shows " + to_string(now->time));
    }
    return json_result(clock_json(*now));
}

Result<Json> set_text(PrinterClient& printer, const Order& order) {
    const auto bytes = path_bytes(order.arguments.text("text"));
    if (!bytes) {
        return Failure{FailureKind::input,
                       "the text has a character that Windows-1252 does not have, and fonts neither"};
    }
    const protocol::ExternText wanted{*bytes};
    if (wanted.text.size() > protocol::max_extern_text || wanted.text.find('\r') != std::string::npos) {
        return Failure{FailureKind::usage, "the text must have at most " + std::to_string(protocol::max_extern_text) +
                                               " bytes, and no line end"};
    }
    if (printer.settings().profile.escapes == protocol::EscapeMode::none &&
        wanted.text.find_first_of("^\\") != std::string::npos) {
        return Failure{FailureKind::usage, "the text has ^ or \\, which firmware without escapes cannot be told"};
    }
    if (!printer.send(wanted)) {
        return not_confirmed(printer);
    }
    constexpr auto longest = std::chrono::milliseconds{500}; // it takes 20 to 150 ms
    const auto now = asked_until<protocol::ExternText>(printer, Parameter::ET, longest,
                                                       [&wanted](const auto& text) { return text == wanted; });
    if (!now) {
        return now.error();
    }
    return *now == wanted
               ? json_result(fields_of(protocol::Message{*now}))
               : Result<Json>{not_taken("it shows another text: " + protocol::printable(path_text(now->text)))};
}

Result<Json> fill_blocks(PrinterClient& printer, const Order& order) {
    return sent(printer, protocol::BlockLength{static_cast<std::uint32_t>(*order.arguments.number("bytes"))});
}

constexpr std::array counters_set_uses{sets("CC")};
constexpr std::array counters_reset_uses{does("RC")};
constexpr std::array counter_limit_uses{sets("CP")};
constexpr std::array counter_reset_uses{sets("RC")};
constexpr std::array outputs_uses{sets("CO")};
constexpr std::array clock_uses{sets("DL")};
constexpr std::array parameter_uses{sets("PR")};
constexpr std::array text_uses{sets("ET")};
constexpr std::array display_on_uses{does("W1")};
constexpr std::array display_off_uses{does("W0")};
constexpr std::array length_uses{does("LN")};
constexpr std::array echo_uses{does("EM")};
constexpr std::array fill_uses{sets("FL")};

constexpr auto number = Argument::Type::number;
constexpr std::array counters_set_arguments{
    Argument{.name = "product", .help = "Set the product counter", .type = number},
    Argument{.name = "stop_after", .help = "Stop after so many products; 0: never", .type = number}};
constexpr std::array counter_limit_arguments{
    Argument{.name = "counter",
             .help = "Which counter of the job",
             .type = number,
             .required = true,
             .positional = true,
             .smallest = 1},
    Argument{.name = "limit", .help = "start or end", .required = true, .positional = true},
    Argument{.name = "value",
             .help = "Taken when the counter reaches its end; not stored in the job",
             .type = number,
             .required = true,
             .positional = true,
             .largest = protocol::max_counter_value}};
constexpr std::array counter_reset_arguments{Argument{.name = "counter",
                                                      .help = "Which counter of the job; 0: all",
                                                      .type = number,
                                                      .required = true,
                                                      .positional = true},
                                             Argument{.name = "start",
                                                      .help = "Where it starts; default: as the job has it",
                                                      .type = number,
                                                      .positional = true,
                                                      .largest = protocol::max_counter_value}};
constexpr std::array output_arguments{
    Argument{.name = "output",
             .help = "1 to 8",
             .type = number,
             .required = true,
             .positional = true,
             .smallest = 1,
             .largest = 8},
    Argument{.name = "state", .help = "on or off", .required = true, .positional = true}};
constexpr std::array clock_arguments{Argument{.name = "time",
                                              .help = "Set it: \"2026-11-26 10:00:00\"; without it to the time of this "
                                                      "computer, or of the service's",
                                              .option = "--set",
                                              .value_optional = true}};
constexpr std::array text_arguments{
    Argument{.name = "text", .help = "The new text, up to 2048 bytes", .required = true, .option = "--set"}};
constexpr std::array fill_arguments{Argument{.name = "bytes",
                                             .help = "Length of a block",
                                             .type = number,
                                             .required = true,
                                             .positional = true,
                                             .smallest = 1,
                                             .largest = 2048}};

constexpr Task option_of_look(Task task) {
    task.options_of_look = true;
    return task;
}

constexpr std::array list{
    option_of_look(
        change("counters set", "Set the product counter", counters_set_uses, set_counters, counters_set_arguments)),
    change("counters reset", "Set the counters of the job back", counters_reset_uses, act<Action::reset_counters>),
    change("counter limit", "Set the start or end of one of the job's counters", counter_limit_uses, limit_counter,
           counter_limit_arguments),
    change("counter reset", "Set one of the job's counters back", counter_reset_uses, reset_counter,
           counter_reset_arguments),
    change("outputs take", "Take control of the outputs: the printer raises no signals on them", outputs_uses,
           control_outputs<true>),
    change("outputs give-back", "Give the outputs back to the printer", outputs_uses, control_outputs<false>),
    change("outputs set", "Switch an output that was taken", outputs_uses, set_output, output_arguments),
    option_of_look(change("clock set", "Set the printer's clock", clock_uses, set_clock, clock_arguments)),
    option_of_look(
        change("parameter set", "Set a print parameter", parameter_uses, set_parameter, parameter_set_arguments)),
    option_of_look(change("text set", "Set the extern text", text_uses, set_text, text_arguments)),
    change("display on", "Show the WYSIWYG picture on the panel", display_on_uses, act<Action::display_on>),
    change("display off", "Do not show the WYSIWYG picture", display_off_uses, act<Action::display_off>),
    change("mode length", "Let the printer send the length of each frame, until it is switched off", length_uses,
           act<Action::length_on>),
    change("mode echo", "Let the printer echo commands, until it is switched off", echo_uses, act<Action::echo_on>),
    change("mode fill", "Let the printer fill what it sends with blanks, until it is switched off", fill_uses,
           fill_blocks, fill_arguments),
};

} // namespace

std::span<const Task> setting_tasks() {
    return list;
}

} // namespace linefeed::printer
