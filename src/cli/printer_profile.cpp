#include "cli/printer_profile.hpp"

#include "link/printer_address.hpp"
#include "printer/printer_client.hpp"

#include <chrono>

namespace linefeed::cli {

Result<protocol::Profile> ask_profile(const PrintOptions& options) {
    const auto address = link::parse_printer_address(options.printer);
    if (!address) {
        return address.error();
    }
    auto endpoints = link::resolve(*address);
    if (!endpoints) {
        return endpoints.error();
    }
    const auto printer =
        printer::PrinterClient::connect({.address = link::to_string(*address),
                                         .endpoints = std::move(*endpoints),
                                         .escapes = options.layout.profile.escapes,
                                         .connect_timeout = std::chrono::milliseconds{options.connect_timeout_ms},
                                         .reply_timeout = std::chrono::milliseconds{options.reply_timeout_ms}});
    if (!printer) {
        return printer.error();
    }
    const auto version = (*printer)->ask<protocol::VersionInfo>(protocol::Parameter::VS);
    const auto profile = version ? protocol::profile_for(version->type, version->firmware) : std::nullopt;
    if (!profile) {
        const std::string told = version ? "says that it is a \"" + version->type + "\" with firmware \"" +
                                               version->firmware + "\", for which no profile is known"
                                         : "does not say what it is (?VS)";
        return Failure{FailureKind::unreachable,
                       options.printer + ": the printer " + told + ": name its profile with --profile"};
    }
    return *profile;
}

} // namespace linefeed::cli
