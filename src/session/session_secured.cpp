// The conversation with CRC32, both ways (protocol, section 6): what the printer says of our frames, and which of its
// own are right.
#include "session/session.hpp"

namespace linefeed::session {

using feeder::Actions;
using protocol::Parameter;
using protocol::SecuredLine;
using Word = protocol::SecuredReader::Word;

void Session::take_secured(const protocol::Frame& frame, Instant now, Actions& actions) {
    switch (secured_reader_.read(frame, secured_)) {
    case Word::announcement:
        return;
    case Word::right:
        settle_frame(secured_.on_right(now), now, actions);
        return;
    case Word::refused:
        settle_frame(secured_.on_refused(), now, actions);
        return;
    case Word::proven:
        take_proven(frame, now, actions);
        return;
    case Word::standby:
        static_cast<void>(answered(Parameter::RS)); // nothing else has been asked yet
        feeder_.on_machine_status(std::get<protocol::MachineStatus>(protocol::parse_message(frame, settings_.escapes)),
                                  now, actions);
        return;
    case Word::damaged:
    case Word::bare:
        secured_.on_echo(frame.raw);
        ++statistics_.frames_unexpected;
        if (secured_reader_.unsecured()) {
            feeder_.on_not_secured(actions);
        }
        return;
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
