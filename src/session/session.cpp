// Where the facts arrive: bytes, completions, the ledger's answers, and time.
#include "session/session.hpp"

#include <algorithm>

namespace linefeed::session {

using feeder::Actions;
using protocol::Parameter;

Session::Session(const SessionSettings& settings, const feeder::FeederPlan& plan, FrameObserver* observer)
    : settings_(settings)
    , observer_(observer)
    , feeder_(settings.feeder, plan)
    , decoder_(settings.escapes)
    , secured_(settings.line) {}

void Session::on_connected(Instant now, Effects& out) {
    LINEFEED_ASSERT(!connected_ && !closed_);
    connected_ = true;
    heard_at_ = now;
    decoder_.reset();
    Actions actions;
    feeder_.start(now, actions);
    carry_out(actions, now, out);
}

void Session::on_received(std::string_view bytes, Instant now, Effects& out) {
    while (!closed_ && (!end_ || settings_.line.crc)) {
        const protocol::DecodeResult result = decoder_.next(bytes);
        if (std::holds_alternative<std::monostate>(result)) {
            return;
        }
        Actions actions;
        if (const auto* error = std::get_if<protocol::FrameError>(&result)) {
            take_damage(error->bytes, now);
        } else {
            take_frame(std::get<protocol::Frame>(result), now, actions);
        }
        carry_out(actions, now, out);
    }
}

namespace {

/// The answers a session waits for. All else is an echo (`!EM`), or nobody's question: not worth parsing.
bool may_be_answer(const protocol::Frame& frame) {
    if (frame.group != protocol::Group::parameter || frame.address != protocol::printer_address || frame.truncated) {
        return false;
    }
    switch (protocol::parameter_from_code(frame.payload.substr(0, 2)).value_or(Parameter::MR)) {
    case Parameter::RS:
    case Parameter::SM:
    case Parameter::CC:
    case Parameter::VS:
    case Parameter::JL:
        return true;
    default:
        return false;
    }
}

bool is_unknown_state(const protocol::Message& message) {
    const auto* const status = std::get_if<protocol::MachineStatus>(&message);
    return status != nullptr && status->machine == protocol::MachineState::unknown;
}

} // namespace

void Session::take_damage(std::uint64_t bytes, Instant now) {
    statistics_.bytes_damaged += bytes;
    if (observer_ != nullptr) {
        observer_->on_damage_received(bytes, now);
    }
}

void Session::take_frame(const protocol::Frame& frame, Instant now, Actions& actions) {
    if (observer_ != nullptr) {
        observer_->on_frame_received(frame.raw, now);
    }
    ++statistics_.frames_received;
    heard_at_ = now;
    if (settings_.line.crc) {
        take_secured(frame, now, actions);
    } else {
        take_unsecured(frame, now, actions);
    }
}

void Session::take_unsecured(const protocol::Frame& frame, Instant now, Actions& actions) {
    if (!may_be_answer(frame)) {
        ++statistics_.frames_unexpected;
        return;
    }
    const protocol::Message message = protocol::parse_message(frame, settings_.escapes);
    if (const auto* malformed = std::get_if<protocol::MalformedMessage>(&message)) {
        statistics_.bytes_damaged += malformed->payload.size();
    } else if (is_unknown_state(message) && feeder_.phase() != feeder::Phase::identifying) {
        ++statistics_.frames_unexpected; // nobody knows whether it prints: the inquiry is as good as lost
    } else if (!take_answer(message, now, actions)) {
        ++statistics_.frames_unexpected;
    }
}

/// False if nobody asked.
bool Session::take_answer(const protocol::Message& message, Instant now, Actions& actions) {
    if (const auto* mail = std::get_if<protocol::MailStatus>(&message)) {
        const bool asked = answered(Parameter::SM);
        if (asked) {
            feeder_.on_mail_status(*mail, now, actions);
        }
        return asked;
    }
    if (const auto* machine = std::get_if<protocol::MachineStatus>(&message)) {
        forget_mail_before_status(now, actions);
        const bool asked = answered(Parameter::RS);
        if (asked) {
            feeder_.on_machine_status(*machine, now, actions);
        }
        return asked;
    }
    if (const auto* counters = std::get_if<protocol::Counters>(&message)) {
        const bool asked = counters->product && answered(Parameter::CC); // without: an echo of what somebody sets
        if (asked) {
            feeder_.on_counters(*counters, now, actions);
        }
        return asked;
    }
    if (const auto* version = std::get_if<protocol::VersionInfo>(&message)) {
        const bool asked = answered(Parameter::VS);
        if (asked) {
            feeder_.on_version(*version, now, actions);
        }
        return asked;
    }
    const bool asked = answered(Parameter::JL);
    if (asked) {
        feeder_.on_job_name(std::get<protocol::JobName>(message), now, actions);
    }
    return asked;
}

bool Session::answered(Parameter what) {
    for (std::size_t i = 0; i < inquiries_.size(); ++i) {
        if (inquiries_[i].what == what) {
            inquiries_.erase(i);
            return true;
        }
    }
    return false;
}

/// Answers come in the order of the inquiries, so what was asked before a `?RS` that is answered now will not be
/// answered any more.
void Session::forget_mail_before_status(Instant now, Actions& actions) {
    const auto* const status = std::ranges::find(inquiries_, Parameter::RS, &Inquiry::what);
    if (status == inquiries_.end()) {
        return;
    }
    for (auto before = std::ranges::count(inquiries_.begin(), status, Parameter::SM, &Inquiry::what); before > 0;
         --before) {
        static_cast<void>(answered(Parameter::SM));
        feeder_.on_lost_answer(Parameter::SM, now, actions);
    }
}

/// Only `?RS` and `?SM` must be answered. On a serial line one answer may have fallen to noise while the line was busy
/// for long with what goes the other way: there it must have been free besides.
void Session::time_out(Parameter what, Instant now, Actions& actions) {
    const bool needed = what == Parameter::RS || what == Parameter::SM;
    const Instant quiet_since = settings_.line.bytes_per_second > 0 ? std::max(heard_at_, line_free_at_) : heard_at_;
    if (needed && now - quiet_since >= settings_.reply_timeout) {
        feeder_.on_silence(actions);
    } else {
        feeder_.on_lost_answer(what, now, actions);
    }
}

void Session::on_written(Instant now, Effects& out) {
    if (!outbox_.writing()) {
        return; // given up: the link has closed, or the farewell took too long
    }
    outbox_.write_done();
    if (records_under_way_) {
        records_under_way_->written_at = now;
        out.push_back(*records_under_way_);
        records_under_way_.reset();
    }
    release_pages(out);
    flush(now, out);
    finish_if_drained(out);
}

void Session::on_closed(Instant now, Effects& out) {
    if (closed_) {
        return;
    }
    connected_ = false;
    outbox_.clear();
    secured_.clear();
    inquiries_.clear();
    Actions actions;
    feeder_.on_link_lost(actions);
    carry_out(actions, now, out);
    finish_if_drained(out);
}

void Session::on_granted(RecordRange range, RecordNumber durable_through, Instant now, Effects& out) {
    Actions actions;
    feeder_.on_granted(range, durable_through, now, actions);
    carry_out(actions, now, out);
    if (!pages_.empty() && !end_) {
        actions.clear();
        feeder_.on_supplied(pages_.last(), now, actions); // pages may come before the grant
        carry_out(actions, now, out);
    }
}

void Session::on_end_known(RecordNumber last, Instant now, Effects& out) {
    Actions actions;
    feeder_.on_end_known(last, now, actions);
    carry_out(actions, now, out);
}

void Session::on_refused(feeder::OutcomeCode why, Instant now, Effects& out) {
    Actions actions;
    feeder_.on_refused(why, actions);
    carry_out(actions, now, out);
}

void Session::on_durable(RecordNumber through, Instant now, Effects& out) {
    Actions actions;
    feeder_.on_durable(through, now, actions);
    carry_out(actions, now, out);
}

void Session::on_settled(Instant now, Effects& out) {
    Actions actions;
    feeder_.on_settled(now, actions);
    carry_out(actions, now, out);
}

void Session::on_storage_failed(Instant now, Effects& out) {
    Actions actions;
    feeder_.on_storage_failed(now, actions);
    carry_out(actions, now, out);
}

void Session::on_follower_begun(RecordRange places, RecordNumber number, Instant now, Effects& out) {
    Actions actions;
    feeder_.on_follower_begun(places, number, actions);
    carry_out(actions, now, out);
}

void Session::on_page(const RecordPage* page, Instant now, Effects& out) {
    pages_.add(page);
    if (end_) {
        release_pages(out);
        return;
    }
    Actions actions;
    feeder_.on_supplied(pages_.last(), now, actions);
    carry_out(actions, now, out);
}

void Session::request_stop(Instant now, Effects& out) {
    Actions actions;
    feeder_.request_stop(now, actions);
    carry_out(actions, now, out);
}

void Session::on_time(Instant now, Effects& out) {
    Actions actions;
    settle_frame(secured_.on_time(now), now, actions);
    if (end_) {
        if (!closed_ && now >= farewell_deadline_) {
            outbox_.clear();
            secured_.clear();
        }
        flush(now, out);
        finish_if_drained(out);
        return;
    }
    carry_out(actions, now, out);
    for (std::size_t i = 0; i < inquiries_.size();) {
        if (now < inquiries_[i].deadline) {
            ++i;
            continue;
        }
        const Inquiry inquiry = inquiries_[i];
        inquiries_.erase(i);
        actions.clear();
        if (inquiry.given_up) {
            feeder_.on_lost_answer(inquiry.what, now, actions);
        } else {
            time_out(inquiry.what, now, actions);
        }
        carry_out(actions, now, out);
        i = 0;
    }
    actions.clear();
    feeder_.on_time(now, actions);
    carry_out(actions, now, out);
}

std::optional<Instant> Session::first_deadline() const {
    std::optional<Instant> first;
    for (const Inquiry& inquiry : inquiries_) {
        first = first ? std::min(*first, inquiry.deadline) : inquiry.deadline;
    }
    return first;
}

std::optional<Instant> Session::next_wake() const {
    if (closed_) {
        return std::nullopt;
    }
    std::optional<Instant> first = secured_.deadline();
    const auto consider = [&first](std::optional<Instant> wake) {
        first = first && wake ? std::min(first, wake) : (first ? first : wake);
    };
    if (end_) {
        consider(farewell_deadline_);
        return first;
    }
    consider(first_deadline());
    consider(feeder_.next_wake());
    return first;
}

} // namespace linefeed::session
