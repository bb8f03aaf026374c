#include "printer/told_profile.hpp"

#include "printer/look.hpp"
#include "protocol/printable.hpp"

namespace linefeed::printer {

std::optional<protocol::Profile> told_profile(PrinterClient& printer) {
    const auto machine = printer.ask<protocol::MachineStatus>(protocol::Parameter::RS);
    const bool answers = machine && machine->machine != protocol::MachineState::standby;
    const auto version = answers ? printer.ask<protocol::VersionInfo>(protocol::Parameter::VS) : std::nullopt;
    return version ? protocol::profile_for(version->type, version->firmware) : std::nullopt;
}

Result<protocol::Profile> ask_profile(const ClientSettings& settings) {
    const auto printer = PrinterClient::connect(settings);
    if (!printer) {
        return printer.error();
    }
    const auto version = ask_version(**printer);
    const auto profile = version ? protocol::profile_for(version->type, version->firmware) : std::nullopt;
    if (profile) {
        return with_own_properties(*profile, settings.profile.own);
    }
    const std::string told = version
                                 ? "says that it is a \"" + protocol::printable(version->type) + "\" with firmware \"" +
                                       protocol::printable(version->firmware) + "\", for which no profile is known"
                                 : "does not say what it is (?VS)";
    return Failure{FailureKind::unreachable,
                   settings.address + ": the printer " + told + ": name its profile with --profile"};
}

} // namespace linefeed::printer
