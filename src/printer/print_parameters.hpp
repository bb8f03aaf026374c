// `?PR` and `=PR`: print parameters by name.
#pragma once

#include "printer/task.hpp"
#include "protocol/print_messages.hpp"

#include <array>
#include <string_view>

namespace linefeed::printer {

inline constexpr std::array parameter_look_arguments{
    Argument{.name = "type",
             .help = "delay, distance, stroke-distance, height or encoder-speed; or 1 to 5. None: all of them",
             .positional = true}};
inline constexpr std::array parameter_set_arguments{
    Argument{.name = "type",
             .help = "delay, distance, stroke-distance, height or encoder-speed; or 1 to 5",
             .required = true,
             .positional = true},
    Argument{.name = "value",
             .help = "The new value: µm, of the height 30 to 100, of the speed dm/min",
             .type = Argument::Type::number,
             .required = true,
             .option = "--set"}};

[[nodiscard]] Result<Json> look_at_parameters(PrinterClient& printer, const Order& order);
/// Sets it and reads it back.
[[nodiscard]] Result<Json> set_parameter(PrinterClient& printer, const Order& order);

} // namespace linefeed::printer
