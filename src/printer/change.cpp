#include "printer/change.hpp"

#include "printer/message_json.hpp"

namespace linefeed::printer {

using protocol::MachineState;
using protocol::MachineStatus;

Failure not_done(const MachineStatus& status) {
    return not_taken("the machine says: " + std::string{to_string(status.machine)} +
                     (status.error.none() ? "" : ", " + describe(status.error)) +
                     (status.cover_open ? ", cover open" : ""));
}

Result<Json> sent(PrinterClient& printer, const protocol::Message& message) {
    if (!printer.send(message)) {
        return not_confirmed(printer);
    }
    const auto status = asked<MachineStatus>(printer, protocol::Parameter::RS);
    if (!status) {
        return Failure{status.error().kind,
                       "it is sent, but nobody knows whether it has arrived: " + status.error().message};
    }
    if (status->machine == MachineState::standby) {
        return not_done(*status);
    }
    return json_result(fields_of(protocol::Message{*status}));
}

} // namespace linefeed::printer
