// The conversation with CRC32, both ways (protocol, section 6): what the printer says of our frames, and which of its
// own are right.
#include "protocol/crc32.hpp"
#include "session/session.hpp"

#include <utility>

namespace linefeed::session {

using feeder::Actions;
using protocol::Group;
using protocol::Parameter;
using protocol::SecuredLine;

namespace {

bool is_parameter(const protocol::Frame& frame, Parameter what) {
    return frame.group == Group::parameter && frame.payload.starts_with(protocol::code(what));
}

/// `!OK`, also with one byte damaged: of a frame that it did not check the printer says nothing, and `=FC` is longer.
/// Taken for right wrongly, a refused record is missing, and the printer stops at the gap.
bool is_right(const protocol::Frame& frame) {
    const std::string_view word = frame.payload.substr(0, frame.payload.find_last_not_of(' ') + 1);
    if (word.size() != 2) {
        return false;
    }
    const int differing = (frame.group != Group::action ? 1 : 0) + (word[0] != 'O' ? 1 : 0) + (word[1] != 'K' ? 1 : 0);
    return differing <= 1;
}

} // namespace

void Session::take_secured(const protocol::Frame& frame, Instant now, Actions& actions) {
    if (is_parameter(frame, Parameter::NR)) {
        const protocol::Message message = protocol::parse_message(frame, settings_.escapes);
        const auto* const next = std::get_if<protocol::NextCrc>(&message);
        announced_crc_ = next == nullptr ? std::nullopt : std::optional{next->crc};
        return;
    }
    const auto announced = std::exchange(announced_crc_, std::nullopt);
    if (is_right(frame)) {
        secured_once_ = true;
        settle_frame(secured_.on_right(now), now, actions);
    } else if (is_parameter(frame, Parameter::FC)) {
        settle_frame(secured_.on_refused(), now, actions);
    } else if (announced && protocol::is_announced_by(frame.raw, *announced)) {
        secured_once_ = true;
        take_proven(frame, now, actions);
    } else {
        secured_.on_echo(frame.raw);
        ++statistics_.frames_unexpected;
        if (!announced && !secured_once_) {
            take_unannounced(frame, now, actions);
        }
    }
}

/// A printer in standby answers without CRC32 (protocol, section 1), and so does one that does not know it. An answer
/// whose announcement got lost looks the same, but not several times.
void Session::take_unannounced(const protocol::Frame& frame, Instant now, Actions& actions) {
    constexpr int enough = 3;
    const auto what = protocol::parameter_from_code(frame.payload.substr(0, 2));
    if (frame.group != Group::parameter || !what) {
        return;
    }
    const protocol::Message message = protocol::parse_message(frame, settings_.escapes);
    const auto* const machine = std::get_if<protocol::MachineStatus>(&message);
    if (machine != nullptr && machine->machine == protocol::MachineState::standby) {
        static_cast<void>(answered(Parameter::RS)); // nothing else has been asked yet
        feeder_.on_machine_status(*machine, now, actions);
    } else if (secured_.is(*what) && ++unannounced_ == enough) {
        feeder_.on_not_secured(actions);
    }
}

/// An answer is the feeder's only if it belongs to the inquiry that is under way.
void Session::take_proven(const protocol::Frame& frame, Instant now, Actions& actions) {
    secured_.on_echo(frame.raw);
    const auto what = protocol::parameter_from_code(frame.payload.substr(0, 2));
    const SecuredLine::Step step = what ? secured_.on_answer(*what, now) : SecuredLine::Step::wait;
    if (step == SecuredLine::Step::next) {
        take_unsecured(frame, now, actions);
        if (answered(*what)) { // it cannot be read
            time_out(*what, now, actions);
        }
    }
    settle_frame(step, now, actions);
}

void Session::settle_frame(SecuredLine::Step step, Instant now, Actions& actions) {
    switch (step) {
    case SecuredLine::Step::wait:
        return;
    case SecuredLine::Step::next: // flush() begins with it
        if (secured_.current().kind == SecuredLine::Kind::record) {
            feeder_.on_proven_record(now);
        }
        return;
    case SecuredLine::Step::send:
        send_announced(now);
        return;
    case SecuredLine::Step::lost:
        static_cast<void>(answered(secured_.current().what));
        time_out(secured_.current().what, now, actions);
        return;
    case SecuredLine::Step::unproven:
        secured_.drop_records();
        feeder_.on_unproven_record(secured_.current().number, now, actions);
        return;
    }
}

void Session::begin_frame(Instant now) {
    const SecuredLine::Frame* const frame = secured_.begin();
    if (frame == nullptr) {
        return;
    }
    if (frame->kind == SecuredLine::Kind::record) {
        const std::string_view bytes = pages_.frame_of(frame->number);
        secured_.set_record(bytes);
        note_records({frame->number, RecordCount{1}}, bytes, bytes.size(), now);
    } else if (frame->kind == SecuredLine::Kind::inquiry) {
        inquiries_.push_back({frame->what, Instant::max()}); // the secured line keeps the time
    }
    send_announced(now);
}

void Session::send_announced(Instant now) {
    stage_command(secured_.announced(now), now);
}

} // namespace linefeed::session
