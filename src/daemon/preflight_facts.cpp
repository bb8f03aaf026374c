// The conversation of a preflight, see preflight.hpp.
#include "daemon/preflight.hpp"
#include "printer/look.hpp"

namespace linefeed::daemon {

using protocol::Parameter;

namespace {

bool is_answered(const printer::ClientSettings& settings) {
    const auto second = printer::PrinterClient::connect(settings);
    return second && (*second)->ask<protocol::MachineStatus>(Parameter::RS).has_value();
}

} // namespace

PreflightFacts gather_facts(const printer::ClientSettings& settings) {
    PreflightFacts facts;
    const auto connected = printer::PrinterClient::connect(settings);
    if (!connected) {
        facts.unreachable = connected.error().message;
        return facts;
    }
    printer::PrinterClient& printer = **connected;
    facts.machine = printer::ask_status(printer);
    const bool talks = facts.machine && facts.machine->machine != protocol::MachineState::standby;
    if (talks) { // in standby nothing else is answered
        facts.version = printer::ask_version(printer);
        facts.job = printer.ask<protocol::JobName>(Parameter::JL);
        if (printer.ask<protocol::MailStatus>(Parameter::SM)) { // may be one inquiry old
            facts.mail = printer.ask<protocol::MailStatus>(Parameter::SM);
        }
        facts.counters = printer.ask<protocol::Counters>(Parameter::CC);
        if (printer.open()) {
            facts.second_connection = is_answered(settings);
        }
    }
    facts.broke_off = !printer.open();
    facts.oddities = printer.oddities();
    return facts;
}

} // namespace linefeed::daemon
