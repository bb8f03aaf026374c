// Words for the states of the machine, see machine_messages.hpp.
#include "protocol/machine_messages.hpp"

#include "base/assert.hpp"

namespace linefeed::protocol {

std::string_view to_string(NozzleState state) {
    switch (state) {
    case NozzleState::invalid:
        return "invalid";
    case NozzleState::opens:
        return "opens";
    case NozzleState::open:
        return "open";
    case NozzleState::closes:
        return "closes";
    case NozzleState::closed:
        return "closed";
    case NozzleState::in_between:
        return "in between";
    }
    assertion_failed("NozzleState", __FILE__, __LINE__);
}

std::string_view to_string(MachineState state) {
    switch (state) {
    case MachineState::unknown:
        return "unknown";
    case MachineState::standby:
        return "standby";
    case MachineState::initialising:
        return "initialising";
    case MachineState::service:
        return "interval or service panel";
    case MachineState::ready:
        return "ready for action";
    case MachineState::ready_to_print:
        return "ready for print start";
    case MachineState::printing:
        return "printing";
    }
    assertion_failed("MachineState", __FILE__, __LINE__);
}

std::string_view to_string(EncoderLevel level) {
    switch (level) {
    case EncoderLevel::rs422:
        return "RS422";
    case EncoderLevel::ttl_5_v:
        return "TTL 5 V";
    case EncoderLevel::htl_24_v:
        return "HTL 24 V";
    }
    return "unknown";
}

std::string_view to_string(HeadMotor motor) {
    switch (motor) {
    case HeadMotor::opening:
        return "opening";
    case HeadMotor::opened:
        return "opened";
    case HeadMotor::closing:
        return "closing";
    case HeadMotor::closed:
        return "closed";
    case HeadMotor::in_between:
        return "in between";
    }
    return "unknown";
}

} // namespace linefeed::protocol
