// How what clients send reaches the printer model: addresses, standby, echo, announced CRCs, and who answers (protocol,
// sections 1, 6 and 8). What the printer does not know it ignores silently.
#include "base/assert.hpp"
#include "protocol/crc32.hpp"
#include "protocol/frame_encoder.hpp"
#include "simulator/printer_model.hpp"

#include <utility>

namespace linefeed::simulator {
namespace {

using protocol::Action;
using protocol::Group;
using protocol::MachineState;
using protocol::Message;
using protocol::Parameter;

} // namespace

void PrinterModel::receive(ConnectionId connection, const protocol::Frame& frame, Instant now) {
    advance(now);
    if (frame.address != protocol::printer_address) {
        return;
    }
    if (machine_ == MachineState::standby) {
        receive_in_standby(frame, connection, now);
        return;
    }
    if (panel_blocked()) {
        panel_blocked_until_ = now + panel_block; // whoever keeps talking holds it
    }
    if (transmitter_.echo_on() && (frame.group == Group::action || frame.group == Group::parameter)) {
        std::string echo;
        protocol::append_frame(echo, frame.group, frame.payload);
        send(connection, echo, false);
    }
    if (frame.group == Group::parameter && frame.payload.starts_with(protocol::code(Parameter::NR))) {
        // An announcement replaces one whose frame got lost: the host repeats both. A sum that cannot be read was
        // damaged on its way and agrees with no frame: the host wants the next one checked all the same.
        const Message message = protocol::parse_message(frame, settings_.profile.escapes);
        const auto* announced = std::get_if<protocol::NextCrc>(&message);
        awaited_crcs_[connection] = announced == nullptr ? std::nullopt : std::optional{announced->crc};
        return;
    }
    const bool secured = awaited_crcs_.contains(connection) && frame.group != Group::file;
    if (secured && !crc_agrees(connection, frame)) {
        return;
    }
    awaited_crcs_.erase(connection);
    execute(connection, frame, secured, now);
}

void PrinterModel::disconnected(ConnectionId connection) {
    awaited_crcs_.erase(connection);
    transfers_.forget(connection);
}

/// Only `!PO`, `!RM` and file transfer; and `?RS`, which tells that it is standby.
void PrinterModel::receive_in_standby(const protocol::Frame& frame, ConnectionId connection, Instant now) {
    const Message message = protocol::parse_message(frame, settings_.profile.escapes);
    const auto* action = std::get_if<protocol::ActionMessage>(&message);
    const auto* inquiry = std::get_if<protocol::InquiryMessage>(&message);
    if (action != nullptr && action->action == Action::power_on) {
        power_on(now);
    } else if (action != nullptr && action->action == Action::restart) {
        restart(now);
    } else if (inquiry != nullptr && inquiry->parameter == Parameter::RS && !settings_.habits.standby_silent) {
        send(connection, machine_status(), false);
    } else if (frame.group == Group::file) {
        transfer(connection, message);
    }
}

bool PrinterModel::crc_agrees(ConnectionId connection, const protocol::Frame& frame) {
    const std::optional<std::uint32_t> announced = awaited_crcs_.at(connection);
    std::uint32_t calculated = protocol::crc32(frame.raw);
    awaited_crcs_.erase(connection);
    if (calculated == announced && troubles_.take(Trouble::refused_crc)) {
        calculated = ~calculated;
    }
    if (calculated == announced) {
        send(connection, protocol::ActionMessage{Action::crc_ok}, false);
    } else {
        send(connection, protocol::CrcFailed{calculated}, false);
    }
    return calculated == announced;
}

void PrinterModel::execute(ConnectionId connection, const protocol::Frame& frame, bool secured, Instant now) {
    const Message message = protocol::parse_message(frame, settings_.profile.escapes);
    if (frame.group == Group::file) {
        transfer(connection, message);
    } else if (const auto* inquiry = std::get_if<protocol::InquiryMessage>(&message)) {
        answer(connection, *inquiry, secured, now);
    } else {
        std::visit(
            [this, now](const auto& typed) {
                if constexpr (requires { take(typed, now); }) {
                    take(typed, now);
                }
            },
            message);
    }
}

/// File transfer has checks of its own and is outside the CRC.
void PrinterModel::transfer(ConnectionId connection, const Message& message) {
    for (const Message& reply : transfers_.take(connection, message, troubles_)) {
        send(connection, reply, false);
    }
}

void PrinterModel::send(ConnectionId connection, const Message& message, bool secured) {
    auto escapes = settings_.profile.escapes;
    if (const auto* job = std::get_if<protocol::JobName>(&message)) {
        escapes = path_escapes(job->path);
    } else if (const auto* header = std::get_if<protocol::FileHeader>(&message)) {
        escapes = path_escapes(header->path);
    }
    std::string frame;
    protocol::append_any_message(frame, message, escapes);
    send(connection, frame, secured);
}

void PrinterModel::send(ConnectionId connection, std::string_view frame, bool secured) {
    if (troubles_.take(Trouble::lost_answer)) {
        return;
    }
    std::string bytes;
    transmitter_.append(bytes, frame, secured);
    if (secured && troubles_.take(Trouble::wrong_crc)) {
        char& digit = bytes[bytes.find(protocol::code(Parameter::NR)) + 2];
        digit = digit == '1' ? '2' : '1';
    }
    if (troubles_.take(Trouble::damaged_answer)) {
        char& byte = bytes[bytes.size() / 2];
        byte = static_cast<char>(byte ^ 1);
    }
    effects_.emplace_back(Reply{connection, std::move(bytes)});
}

/// The manual's examples send `\` of paths single, against its own escape rule (protocol, section 9). A path that would
/// be read differently then is escaped nevertheless.
protocol::EscapeMode PrinterModel::path_escapes(std::string_view path) const {
    const auto escapes = settings_.profile.escapes;
    const bool reads_back = path.find('^') == std::string_view::npos && protocol::unescape(path, escapes) == path;
    return reads_back && !settings_.habits.escaped_paths ? protocol::EscapeMode::none : escapes;
}

} // namespace linefeed::simulator
