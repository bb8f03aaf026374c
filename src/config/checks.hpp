// What must fit together although each value is good by itself.
#pragma once

#include "config/context.hpp"
#include "config/settings.hpp"

namespace linefeed::config {

/// References between sections, bounds in the right order, options that exclude each other, what HTTP may do.
void check_settings(const Settings& settings, Context& context);

/// The printer's policies together with the table: no more numbers to acknowledge than the feeder takes. Separate,
/// since the table is a file of its own.
void check_policies(const Settings& settings, Context& context);

/// The numbers whose policy at that printer is acknowledge, ascending.
[[nodiscard]] std::vector<std::uint32_t> acknowledged_numbers(const ErrorTable& table, const PrinterSettings& printer);

/// Whether only programs of the same machine reach a numeric address.
[[nodiscard]] bool is_loopback(std::string_view address);

} // namespace linefeed::config
