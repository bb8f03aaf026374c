// The machine: printing, nozzle, power, errors, the FIFO.
#include "printer/change.hpp"
#include "printer/message_json.hpp"
#include "printer/printer_commands.hpp"
#include "printer/tasks.hpp"

#include <array>
#include <chrono>

namespace linefeed::printer {

using protocol::Action;
using protocol::MachineState;
using protocol::MachineStatus;
using protocol::Parameter;

namespace {

Result<Json> start(PrinterClient& printer, const Order& /*order*/) {
    if (!printer.send(Action::start_print)) {
        return not_confirmed(printer);
    }
    const auto status =
        asked_until<MachineStatus>(printer, Parameter::RS, std::chrono::seconds{1},
                                   [](const auto& now) { return now.machine == MachineState::printing; });
    if (!status) {
        return status.error();
    }
    return status->machine == MachineState::printing ? json_result(fields_of(protocol::Message{*status}))
                                                     : Result<Json>{not_done(*status)};
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
};

} // namespace

std::span<const Task> machine_tasks() {
    return list;
}

} // namespace linefeed::printer
