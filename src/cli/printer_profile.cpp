#include "cli/printer_profile.hpp"

#include "link/printer_address.hpp"
#include "printer/told_profile.hpp"

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
    return printer::ask_profile({.address = link::to_string(*address),
                                 .endpoints = std::move(*endpoints),
                                 .profile = options.layout.profile,
                                 .connect_timeout = std::chrono::milliseconds{options.connect_timeout_ms},
                                 .reply_timeout = std::chrono::milliseconds{options.reply_timeout_ms}});
}

} // namespace linefeed::cli
