#include "client/direct_printer.hpp"

#include "config/load.hpp"
#include "link/printer_address.hpp"
#include "printer/told_profile.hpp"

#include <fstream>
#include <iterator>

namespace linefeed::client {

namespace {

/// Where the package puts it.
constexpr const char* plant_errors = "/etc/linefeed/errors.yaml";

} // namespace

bool is_address(std::string_view printer) {
    return printer.find("://") != std::string_view::npos;
}

Result<protocol::Profile> named_profile(const DirectOptions& options) {
    return options.profile.empty() ? Result<protocol::Profile>{protocol::profiles.front()}
                                   : protocol::parse_profile(options.profile);
}

Result<printer::ClientSettings> direct_settings(const std::string& address, const DirectOptions& options) {
    const auto parsed = link::parse_printer_address(address);
    if (!parsed) {
        return parsed.error();
    }
    const auto profile = named_profile(options);
    if (!profile) {
        return profile.error();
    }
    auto endpoints = link::resolve(*parsed);
    if (!endpoints) {
        return endpoints.error();
    }
    printer::ClientSettings settings{
        .address = link::to_string(*parsed), .endpoints = std::move(*endpoints), .profile = *profile};
    if (protocol::is_automatic(*profile)) {
        const auto told = printer::ask_profile(settings);
        if (!told) {
            return told.error();
        }
        settings.profile = *told;
    }
    return settings;
}

Result<std::unique_ptr<printer::PrinterClient>> connect_directly(const std::string& address,
                                                                 const DirectOptions& options) {
    const auto settings = direct_settings(address, options);
    auto printer = settings ? printer::PrinterClient::connect(*settings) : settings.error();
    if (printer && options.profile.empty()) {
        if (const auto told = printer::told_profile(**printer)) {
            (*printer)->use(*told);
        }
    }
    return printer;
}

Result<std::function<printer::ErrorWords(const protocol::PrinterError&)>>
read_error_words(const DirectOptions& options) {
    const bool given = !options.errors.empty();
    const std::filesystem::path file = given ? options.errors : std::filesystem::path{plant_errors};
    std::ifstream in{file, std::ios::binary};
    const std::string text{std::istreambuf_iterator<char>{in}, {}};
    if (!in.is_open() || in.bad()) {
        if (given) {
            return Failure{FailureKind::usage, "cannot read " + file.string()};
        }
        return [](const protocol::PrinterError&) { return printer::ErrorWords{}; };
    }
    auto table = config::parse_error_table(text, file);
    if (!table) {
        return Failure{FailureKind::usage, file.string() + " is no table of error numbers: linefeed check-config says "
                                                           "what is wrong"};
    }
    return [table = *std::move(table)](const protocol::PrinterError& error) {
        const config::ErrorEntry* const entry = table.find(error);
        return entry == nullptr ? printer::ErrorWords{} : printer::ErrorWords{entry->meaning, entry->advice};
    };
}

} // namespace linefeed::client
