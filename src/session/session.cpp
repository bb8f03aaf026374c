#include "session/session.hpp"

#include "protocol/frame_encoder.hpp"

#include <algorithm>
#include <string>

namespace linefeed::session {

using feeder::Actions;
using protocol::Parameter;

Session::Session(const SessionSettings& settings, const feeder::FeederPlan& plan)
    : settings_(settings)
    , feeder_(settings.feeder, plan)
    , decoder_(settings.escapes) {}

void Session::on_connected(Instant now, Effects& out) {
    LINEFEED_ASSERT(!connected_ && !closed_);
    connected_ = true;
    decoder_.reset();
    Actions actions;
    feeder_.start(now, actions);
    carry_out(actions, now, out);
}

void Session::on_received(std::string_view bytes, Instant now, Effects& out) {
    while (!closed_ && !end_) {
        const protocol::DecodeResult result = decoder_.next(bytes);
        if (std::holds_alternative<std::monostate>(result)) {
            return;
        }
        if (const auto* error = std::get_if<protocol::FrameError>(&result)) {
            statistics_.bytes_damaged += error->bytes;
            continue;
        }
        Actions actions;
        take_frame(std::get<protocol::Frame>(result), now, actions);
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

} // namespace

void Session::take_frame(const protocol::Frame& frame, Instant now, Actions& actions) {
    ++statistics_.frames_received;
    if (!may_be_answer(frame)) {
        ++statistics_.frames_unexpected;
        return;
    }
    struct Visitor {
        Session& session;
        Instant now;
        Actions& actions;
        bool expected = true;

        void operator()(const protocol::MachineStatus& status) {
            if ((expected = session.answered(Parameter::RS))) {
                session.feeder_.on_machine_status(status, now, actions);
            }
        }
        void operator()(const protocol::MailStatus& status) {
            if ((expected = session.answered(Parameter::SM))) {
                session.feeder_.on_mail_status(status, now, actions);
            }
        }
        void operator()(const protocol::Counters& counters) {
            if ((expected = session.answered(Parameter::CC))) {
                session.feeder_.on_counters(counters, now, actions);
            }
        }
        void operator()(const protocol::VersionInfo& version) {
            if ((expected = session.answered(Parameter::VS))) {
                session.feeder_.on_version(version, now, actions);
            }
        }
        void operator()(const protocol::JobName& job) {
            if ((expected = session.answered(Parameter::JL))) {
                session.feeder_.on_job_name(job, now, actions);
            }
        }
        void operator()(const protocol::MalformedMessage& message) {
            session.statistics_.bytes_damaged += message.payload.size();
        }
        void operator()(const protocol::UnknownMessage&) { expected = false; }
        void operator()(const protocol::ActionMessage&) { expected = false; }
        void operator()(const protocol::InquiryMessage&) { expected = false; }
        void operator()(const protocol::StopAt&) { expected = false; }
        void operator()(const protocol::MailRecord&) { expected = false; }
    };
    Visitor visitor{*this, now, actions};
    std::visit(visitor, protocol::parse_message(frame, settings_.escapes));
    statistics_.frames_unexpected += visitor.expected ? 0 : 1;
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

void Session::on_written(Instant, Effects& out) {
    if (!outbox_.writing()) {
        return; // given up: the link has closed, or the farewell took too long
    }
    outbox_.write_done();
    release_pages(out);
    flush(out);
    finish_if_drained(out);
}

void Session::on_closed(Instant now, Effects& out) {
    if (closed_) {
        return;
    }
    connected_ = false;
    outbox_.clear();
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
    feeder_.on_settled(actions);
    carry_out(actions, now, out);
}

void Session::on_storage_failed(Instant now, Effects& out) {
    Actions actions;
    feeder_.on_storage_failed(now, actions);
    carry_out(actions, now, out);
}

void Session::on_page(const RecordPage* page, Instant now, Effects& out) {
    pages_.add(page);
    if (end_ || closed_) {
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
    if (end_) {
        if (!closed_ && now >= farewell_deadline_) {
            outbox_.clear();
            finish_if_drained(out);
        }
        return;
    }
    Actions actions;
    for (std::size_t i = 0; i < inquiries_.size() && !end_;) {
        if (now < inquiries_[i].deadline) {
            ++i;
            continue;
        }
        const Parameter what = inquiries_[i].what;
        inquiries_.erase(i);
        actions.clear();
        feeder_.on_no_answer(what, now, actions);
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
    if (end_) {
        return farewell_deadline_;
    }
    const auto deadline = first_deadline();
    const auto wake = feeder_.next_wake();
    return deadline && wake ? std::min(deadline, wake) : (deadline ? deadline : wake);
}

namespace {

/// A record of blanks. An empty text would not do: the printer shows the job's placeholder for it (Annex B, "zero
/// string").
void append_end_marker(std::string& out, RecordNumber number, std::size_t fields) {
    std::string payload = "MR" + std::to_string(number.value());
    for (std::size_t i = 0; i < fields; ++i) {
        payload += "\t ";
    }
    protocol::append_frame(out, protocol::Group::parameter, payload);
}

} // namespace

void Session::carry_out(const Actions& actions, Instant now, Effects& out) {
    for (const feeder::Action& action : actions) {
        carry_out(action, now, out);
    }
    flush(out);
    finish_if_drained(out);
}

void Session::carry_out(const feeder::Action& action, Instant now, Effects& out) {
    struct Visitor {
        Session& session;
        Instant now;
        Effects& out;

        void operator()(std::monostate) const {}
        void operator()(const feeder::Inquire& inquire) const {
            session.inquiries_.push_back({inquire.what, now + session.settings_.reply_timeout});
            protocol::append_inquiry(session.outbox_.command_text(), inquire.what);
            session.outbox_.staged_command();
        }
        void operator()(const feeder::Command& command) const {
            protocol::append_action(session.outbox_.command_text(), command.what);
            session.outbox_.staged_command();
        }
        void operator()(const feeder::SetStopAt& stop) const {
            protocol::append_message(session.outbox_.command_text(), protocol::StopAt{stop.number});
            session.outbox_.staged_command();
        }
        void operator()(const feeder::SendRecords& send) const { session.pages_.stage(send.range, session.outbox_); }
        void operator()(const feeder::SendEndMarker& marker) const {
            append_end_marker(session.outbox_.command_text(), marker.number, session.settings_.record_fields);
            session.outbox_.staged_command();
        }
        void operator()(const feeder::Settle& settle) const { out.push_back(settle); }
        void operator()(const feeder::BeginRun& begin) const { out.push_back(begin); }
        void operator()(const feeder::AdoptRun& adopt) const { out.push_back(adopt); }
        void operator()(const feeder::AskIntent& intent) const { out.push_back(intent); }
        void operator()(const feeder::ConfirmPrinted& confirm) const { out.push_back(confirm); }
        void operator()(const feeder::Notice& notice) const { out.push_back(notice); }
        void operator()(const feeder::End& end) const {
            session.end_ = end;
            session.farewell_deadline_ = now + session.settings_.farewell_timeout;
        }
    };
    if (!connected_ && !std::holds_alternative<feeder::End>(action)) {
        const bool for_printer =
            std::holds_alternative<feeder::Inquire>(action) || std::holds_alternative<feeder::Command>(action) ||
            std::holds_alternative<feeder::SetStopAt>(action) || std::holds_alternative<feeder::SendRecords>(action) ||
            std::holds_alternative<feeder::SendEndMarker>(action);
        if (for_printer) {
            return; // there is nobody to hear it
        }
    }
    std::visit(Visitor{*this, now, out}, action);
}

void Session::flush(Effects& out) {
    if (connected_ && outbox_.begin_write()) {
        out.push_back(Write{});
    }
}

void Session::finish_if_drained(Effects& out) {
    if (!end_ || closed_ || !outbox_.idle()) {
        return;
    }
    closed_ = true;
    connected_ = false;
    release_pages(out);
    out.push_back(*end_);
    out.push_back(CloseLink{});
}

void Session::release_pages(Effects& out) {
    if (closed_) {
        while (const RecordPage* page = pages_.take_any()) {
            out.push_back(ReleasePage{page});
        }
        return;
    }
    if (!outbox_.idle() || feeder_.refill().range().empty()) {
        return; // staged slices point into the pages
    }
    while (const RecordPage* page = pages_.take_done(feeder_.refill().sent_through())) {
        out.push_back(ReleasePage{page});
    }
}

} // namespace linefeed::session
