// What the feeder wants done becomes bytes for the printer and effects for the edge.
#include "protocol/frame_encoder.hpp"
#include "session/session.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace linefeed::session {

using feeder::Actions;

namespace {

/// A record of blanks. An empty text would not do: the printer shows the job's placeholder for it (Annex B, "zero
/// string").
void append_end_marker(std::string& out, RecordNumber number, const std::vector<protocol::Charset>& charsets,
                       protocol::EscapeMode escapes) {
    const std::vector<std::string_view> blanks(charsets.size(), " ");
    const auto appended = protocol::MailRecordEncoder{charsets, escapes}.append(out, number, blanks);
    LINEFEED_ASSERT(appended.has_value());
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
            session.staged_command(now);
        }
        void operator()(const feeder::Command& command) const {
            protocol::append_action(session.outbox_.command_text(), command.what);
            session.staged_command(now);
        }
        void operator()(const feeder::SetStopAt& stop) const {
            protocol::append_message(session.outbox_.command_text(), protocol::StopAt{stop.number});
            session.staged_command(now);
        }
        void operator()(const feeder::SendRecords& send) const { session.stage(send.range, now); }
        void operator()(const feeder::SendEndMarker& marker) const {
            append_end_marker(session.outbox_.command_text(), marker.number, session.settings_.charsets,
                              session.settings_.escapes);
            session.staged_command(now);
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
    std::visit(Visitor{*this, now, out}, action);
}

void Session::staged_command(Instant now) {
    const std::string_view command = outbox_.staged_command();
    if (observer_ != nullptr) {
        observer_->on_command_sent(command, now);
    }
}

void Session::stage(RecordRange records, Instant now) {
    const PageWindow::Staged staged = pages_.stage(records, outbox_);
    if (observer_ != nullptr) {
        observer_->on_records_sent(records, staged.first, staged.bytes, now);
    }
    if (staged_records_) {
        staged_records_->records = RecordRange::closed(staged_records_->records.first(), records.last());
    } else {
        staged_records_ = RecordsWritten{records, now, {}};
    }
}

void Session::flush(Effects& out) {
    if (connected_ && outbox_.begin_write()) {
        records_under_way_ = std::exchange(staged_records_, std::nullopt);
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
