// What changes a printer. Each task sends its command and shows what the printer says then: an answer behind it proves
// that it has arrived.
#pragma once

#include "printer/exchange.hpp"
#include "printer/task.hpp"

#include <span>
#include <string_view>

namespace linefeed::printer {

[[nodiscard]] constexpr CommandId does(std::string_view code) {
    return {protocol::Group::action, code};
}
[[nodiscard]] constexpr CommandId sets(std::string_view code) {
    return {protocol::Group::parameter, code};
}
[[nodiscard]] constexpr Task change(std::string_view name, std::string_view help, std::span<const CommandId> uses,
                                    decltype(Task::run) run, std::span<const Argument> arguments = {}) {
    return {name, Task::Kind::change, help, uses, arguments, run};
}

/// FailureKind::stopped: the machine has not done what it was told, and says so.
[[nodiscard]] Failure not_done(const protocol::MachineStatus& status);
/// Sends it, and gives what the machine says behind it. In standby it does nothing of it (protocol, section 1).
[[nodiscard]] Result<Json> sent(PrinterClient& printer, const protocol::Message& message);

template <protocol::Action action>
Result<Json> act(PrinterClient& printer, const Order& /*order*/) {
    return sent(printer, protocol::ActionMessage{action});
}

} // namespace linefeed::printer
