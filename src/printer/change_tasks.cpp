// What can be done to a printer. Each sends its command and shows what the printer says then: an answer behind it
// proves that it has arrived.
#include "printer/exchange.hpp"
#include "printer/host_time.hpp"
#include "printer/message_json.hpp"
#include "printer/print_parameters.hpp"
#include "printer/printer_commands.hpp"
#include "printer/printer_path.hpp"
#include "printer/tasks.hpp"

#include <array>
#include <chrono>
#include <thread>

namespace linefeed::printer {

using protocol::Action;
using protocol::Group;
using protocol::MachineState;
using protocol::MachineStatus;
using protocol::Parameter;

namespace {

constexpr CommandId does(std::string_view code) {
    return {Group::action, code};
}
constexpr CommandId sets(std::string_view code) {
    return {Group::parameter, code};
}

Failure not_done(const MachineStatus& status) {
    return not_taken("the machine says: " + std::string{to_string(status.machine)} +
                     (status.error.none() ? "" : ", " + describe(status.error)) +
                     (status.cover_open ? ", cover open" : ""));
}

/// What the machine says behind a command. In standby it does nothing of it (protocol, section 1).
Result<Json> machine_behind(PrinterClient& printer) {
    const auto status = asked<MachineStatus>(printer, Parameter::RS);
    if (!status) {
        return Failure{status.error().kind,
                       "it is sent, but nobody knows whether it has arrived: " + status.error().message};
    }
    if (status->machine == MachineState::standby) {
        return not_done(*status);
    }
    return json_result(fields_of(protocol::Message{*status}));
}

Result<Json> sent(PrinterClient& printer, const protocol::Message& message) {
    return printer.send(message) ? machine_behind(printer) : not_confirmed(printer);
}

template <Action action>
Result<Json> act(PrinterClient& printer, const Order& /*order*/) {
    return sent(printer, protocol::ActionMessage{action});
}

Result<Json> start(PrinterClient& printer, const Order& /*order*/) {
    if (!printer.send(Action::start_print)) {
        return not_confirmed(printer);
    }
    constexpr auto longest = std::chrono::seconds{1};
    constexpr auto look_again = std::chrono::milliseconds{50};
    const auto deadline = std::chrono::steady_clock::now() + longest;
    while (true) {
        const auto status = asked<MachineStatus>(printer, Parameter::RS);
        if (!status) {
            return status.error();
        }
        if (status->machine == MachineState::printing) {
            return json_result(fields_of(protocol::Message{*status}));
        }
        if (std::chrono::steady_clock::now() >= deadline) {
            return not_done(*status);
        }
        std::this_thread::sleep_for(look_again);
    }
}

/// For what leads into standby or out of it: there the printer may be silent.
template <Action action>
Result<Json> act_unheard(PrinterClient& printer, const Order& /*order*/) {
    if (!printer.send(action)) {
        return not_confirmed(printer);
    }
    const auto status = printer.ask<MachineStatus>(Parameter::RS);
    return status ? json_result(fields_of(protocol::Message{*status}))
                  : json_result({{"machine", nullptr}, {"note", "it is sent; the printer does not answer now"}});
}

Result<Json> restart(PrinterClient& printer, const Order& order) {
    const auto status = printer.ask<MachineStatus>(Parameter::RS);
    if (status && status->machine != MachineState::standby) {
        return Failure{FailureKind::stopped, "a restart works in standby only, and the machine says: " +
                                                 std::string{to_string(status->machine)} + ". Say power off first"};
    }
    return act_unheard<Action::restart>(printer, order);
}

Result<Json> flush(PrinterClient& printer, const Order& /*order*/) {
    if (!printer.send(Action::flush_fifo)) {
        return not_confirmed(printer);
    }
    static_cast<void>(printer.ask<protocol::MailStatus>(Parameter::SM)); // the first one may be old
    const auto mail = asked<protocol::MailStatus>(printer, Parameter::SM);
    if (!mail) {
        return mail.error();
    }
    if (mail->entries != 0) {
        return not_taken("there are still " + std::to_string(mail->entries) + " entries in its FIFO");
    }
    return json_result(fields_of(*mail));
}

Result<Json> stop_at(PrinterClient& printer, const Order& order) {
    const RecordNumber number{static_cast<std::uint32_t>(*order.arguments.number("number"))};
    if (!printer.send(protocol::StopAt{number})) {
        return not_confirmed(printer);
    }
    static_cast<void>(printer.ask<protocol::MailStatus>(Parameter::SM));
    const auto mail = asked<protocol::MailStatus>(printer, Parameter::SM);
    if (!mail) {
        return mail.error();
    }
    if (mail->stop_at != number) {
        return not_taken("it stops at " + std::to_string(mail->stop_at.value()) + "; some firmware ignores =CM");
    }
    return json_result(fields_of(*mail));
}

/// The error that the printer shows, or none but the one that is named: never a blind `!EQ`.
Result<Json> acknowledge_shown(PrinterClient& printer, const Order& order) {
    const auto status = asked<MachineStatus>(printer, Parameter::RS);
    if (!status) {
        return status.error();
    }
    const auto named = order.arguments.number("error");
    if (status->error.none() && !named) {
        return Failure{FailureKind::stopped, "the printer shows no error"};
    }
    const auto left = acknowledge(printer, named ? static_cast<std::uint32_t>(*named) : status->error.code());
    if (!left) {
        return left.error();
    }
    return json_result({{"acknowledged", to_json(status->error)}, {"error", to_json(*left)}});
}

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

Result<Json> limit_counter(PrinterClient& printer, const Order& order) {
    if (!printer.settings().profile.counter_parameters) {
        return unknown_to(printer, "=CP", "counter-limits");
    }
    const std::string limit = order.arguments.text("limit");
    if (limit != "start" && limit != "end") {
        return Failure{FailureKind::usage, "limit must be start or end"};
    }
    return sent(printer, protocol::CounterParameter{static_cast<std::uint32_t>(*order.arguments.number("counter")),
                                                    limit == "start" ? protocol::CounterLimit::start
                                                                     : protocol::CounterLimit::end,
                                                    *order.arguments.number("value")});
}

Result<Json> reset_counter(PrinterClient& printer, const Order& order) {
    return sent(printer, protocol::CounterReset{static_cast<std::uint32_t>(*order.arguments.number("counter")),
                                                order.arguments.number("start")});
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
    constexpr auto look_again = std::chrono::milliseconds{50};
    const auto deadline = std::chrono::steady_clock::now() + longest;
    while (true) {
        const auto now = asked<protocol::ExternText>(printer, Parameter::ET);
        if (!now) {
            return now.error();
        }
        if (*now == wanted) {
            return json_result(fields_of(protocol::Message{*now}));
        }
        if (std::chrono::steady_clock::now() >= deadline) {
            return not_taken("it shows another text: " + protocol::printable(path_text(now->text)));
        }
        std::this_thread::sleep_for(look_again);
    }
}

Result<Json> fill_blocks(PrinterClient& printer, const Order& order) {
    return sent(printer, protocol::BlockLength{static_cast<std::uint32_t>(*order.arguments.number("bytes"))});
}

constexpr std::array start_uses{does("GO")};
constexpr std::array stop_uses{does("ST")};
constexpr std::array nozzle_open_uses{does("NO")};
constexpr std::array nozzle_close_uses{does("NC")};
constexpr std::array motor_open_uses{does("MO")};
constexpr std::array motor_close_uses{does("MC")};
constexpr std::array power_on_uses{does("PO")};
constexpr std::array power_off_uses{does("PF")};
constexpr std::array restart_uses{does("RM")};
constexpr std::array factory_uses{does("FA")};
constexpr std::array acknowledge_uses{does("EQ")};
constexpr std::array suspend_uses{does("US")};
constexpr std::array release_uses{does("UR")};
constexpr std::array flush_uses{does("FF")};
constexpr std::array stop_at_uses{sets("CM")};
constexpr std::array fonts_uses{does("LF")};
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
constexpr std::array acknowledge_arguments{
    Argument{.name = "error",
             .help = "Its number; another one is left alone. Default: the one that the printer shows",
             .type = number,
             .positional = true,
             .smallest = 1,
             .largest = (1U << 25U) - 1}};
constexpr std::array stop_at_arguments{Argument{.name = "number",
                                                .help = "The last record to print; 0: none",
                                                .type = number,
                                                .required = true,
                                                .positional = true}};
constexpr std::array counters_set_arguments{
    Argument{.name = "product", .help = "Set the product counter", .type = number},
    Argument{.name = "stop_after", .help = "Stop after so many products; 0: never", .type = number}};
constexpr std::array counter_limit_arguments{
    Argument{
        .name = "counter", .help = "Which counter of the job", .type = number, .required = true, .positional = true},
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

constexpr Task change(std::string_view name, std::string_view help, std::span<const CommandId> uses,
                      decltype(Task::run) run, std::span<const Argument> arguments = {}) {
    return {name, Task::Kind::change, help, uses, arguments, run};
}
constexpr Task option_of_look(Task task) {
    task.options_of_look = true;
    return task;
}

constexpr std::array list{
    change("print start", "Start print-ready, whatever is in the FIFO", start_uses, start),
    change("print stop", "Stop print-ready; empties the FIFO", stop_uses, act<Action::stop_print>),
    change("nozzle open", "Open the nozzle; takes 30 to 60 s", nozzle_open_uses, act<Action::nozzle_open>),
    change("nozzle close", "Close the nozzle", nozzle_close_uses, act<Action::nozzle_close>),
    change("motor open", "Open the nozzle's seal by a step", motor_open_uses, act<Action::motor_open>),
    change("motor close", "Close the nozzle's seal by a step", motor_close_uses, act<Action::motor_close>),
    change("power on", "Switch on, out of standby", power_on_uses, act_unheard<Action::power_on>),
    change("power off", "Switch off, to standby", power_off_uses, act_unheard<Action::power_off>),
    change("restart", "Restart the machine, which must be in standby", restart_uses, restart),
    change("factory-reset", "Set everything back as it left the factory", factory_uses,
           act_unheard<Action::factory_reset>),
    change("acknowledge", "Acknowledge the error that the printer shows", acknowledge_uses, acknowledge_shown,
           acknowledge_arguments),
    change("suspend", "Block the panel for 10 s", suspend_uses, act<Action::user_suspend>),
    change("release", "Give the panel back", release_uses, act<Action::user_resume>),
    change("flush", "Empty the mailing FIFO", flush_uses, flush),
    change("mailing stop-at", "Let the printer stop behind a record", stop_at_uses, stop_at, stop_at_arguments),
    change("fonts reload", "Load the fonts again; interrupts printing", fonts_uses, act<Action::reload_fonts>),
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

std::span<const Task> change_tasks() {
    return list;
}

} // namespace linefeed::printer
