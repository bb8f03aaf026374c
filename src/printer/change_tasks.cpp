// What can be done to a printer. Each sends its command and shows what the printer says then: an answer behind it
// proves that it has arrived.
#include "printer/exchange.hpp"
#include "printer/message_json.hpp"
#include "printer/tasks.hpp"

#include <array>

namespace linefeed::printer {

using protocol::Action;
using protocol::Group;
using protocol::Parameter;

namespace {

constexpr CommandId does(std::string_view code) {
    return {Group::action, code};
}

/// `!XX`, and the machine's state behind it.
template <Action action>
Result<Json> act(PrinterClient& printer, const Order& /*order*/) {
    if (!printer.send(action)) {
        return no_answer(printer, Parameter::RS);
    }
    const auto status = asked<protocol::MachineStatus>(printer, Parameter::RS);
    return status ? json_result(fields_of(*status)) : status.error();
}

constexpr std::array nozzle_open_uses{does("NO")};
constexpr std::array nozzle_close_uses{does("NC")};

constexpr std::array list{
    Task{"nozzle open", Task::Kind::change, "Open the nozzle; takes 30 to 60 s", nozzle_open_uses, {},
         act<Action::nozzle_open>},
    Task{"nozzle close", Task::Kind::change, "Close the nozzle", nozzle_close_uses, {}, act<Action::nozzle_close>},
};

} // namespace

std::span<const Task> change_tasks() {
    return list;
}

} // namespace linefeed::printer
