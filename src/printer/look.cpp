#include "printer/look.hpp"

namespace linefeed::printer {

using protocol::Parameter;

namespace {

template <typename Answer>
std::optional<Answer> ask_twice(PrinterClient& printer, Parameter what) {
    auto answer = printer.ask<Answer>(what);
    return answer || !printer.open() ? answer : printer.ask<Answer>(what);
}

} // namespace

std::optional<protocol::MachineStatus> ask_status(PrinterClient& printer) {
    return ask_twice<protocol::MachineStatus>(printer, Parameter::RS);
}

std::optional<protocol::VersionInfo> ask_version(PrinterClient& printer) {
    return ask_twice<protocol::VersionInfo>(printer, Parameter::VS);
}

Look look_at(const ClientSettings& settings) {
    Look look;
    const auto connected = PrinterClient::connect(settings);
    if (!connected) {
        look.unreachable = connected.error().message;
        return look;
    }
    PrinterClient& printer = **connected;
    look.machine = ask_status(printer);
    if (!look.machine) {
        look.silent = printer.open();
        look.unreachable = look.silent ? "" : settings.address + ": it takes the connection, and closes it at once";
        return look;
    }
    if (look.machine->machine != protocol::MachineState::standby) { // there nothing else is answered
        look.version = ask_version(printer);
        look.counters = printer.ask<protocol::Counters>(Parameter::CC);
    }
    return look;
}

} // namespace linefeed::printer
