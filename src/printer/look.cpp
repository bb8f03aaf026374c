#include "printer/look.hpp"

namespace linefeed::printer {

using protocol::Parameter;

std::optional<protocol::MachineStatus> ask_status(PrinterClient& printer) {
    const auto status = printer.ask<protocol::MachineStatus>(Parameter::RS);
    return status || !printer.open() ? status : printer.ask<protocol::MachineStatus>(Parameter::RS);
}

Look look_at(const ClientSettings& settings) {
    Look look;
    const auto connected = PrinterClient::connect(settings);
    if (!connected) {
        look.unreachable = connected.error().message;
        return look;
    }
    PrinterClient& printer = **connected;
    look.machine = printer.ask<protocol::MachineStatus>(Parameter::RS);
    if (!look.machine) {
        look.unreachable = settings.address + ": it takes the connection, but does not answer";
        return look;
    }
    if (look.machine->machine != protocol::MachineState::standby) { // there nothing else is answered
        look.version = printer.ask<protocol::VersionInfo>(Parameter::VS);
        look.counters = printer.ask<protocol::Counters>(Parameter::CC);
    }
    return look;
}

} // namespace linefeed::printer
