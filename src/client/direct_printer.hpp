// A printer without the service: for commissioning, `linefeed printer tcp://HOST …`.
#pragma once

#include "base/failure.hpp"
#include "printer/printer_client.hpp"
#include "printer/task.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace linefeed::client {

struct DirectOptions {
    /// See protocol::parse_profile(); empty = as the printer says, and the first one where it does not tell.
    std::string profile;
    std::filesystem::path errors; ///< table of error numbers; empty = that of the plant, if there is one
};

/// What stands for PRINTER is an address, and no name.
[[nodiscard]] bool is_address(std::string_view printer);

/// The profile as far as it is named.
[[nodiscard]] Result<protocol::Profile> named_profile(const DirectOptions& options);
/// How to talk to the printer at this address, which is asked what it is if the profile is named as automatic.
/// FailureKind::usage: it is none; ::unreachable: there is no such host, or it does not say what it is.
[[nodiscard]] Result<printer::ClientSettings> direct_settings(const std::string& address, const DirectOptions& options);
/// Asks it what it is if no profile is named.
[[nodiscard]] Result<std::unique_ptr<printer::PrinterClient>> connect_directly(const std::string& address,
                                                                               const DirectOptions& options);

/// FailureKind::usage: a file that was given cannot be read, or is no table.
[[nodiscard]] Result<std::function<printer::ErrorWords(const protocol::PrinterError&)>>
read_error_words(const DirectOptions& options);

} // namespace linefeed::client
