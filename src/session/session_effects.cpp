// What the feeder wants done becomes bytes for the printer and effects for the edge.
#include "protocol/frame_encoder.hpp"
#include "session/session.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace linefeed::session {

using feeder::Actions;
using protocol::SecuredLine;

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
    flush(now, out);
    finish_if_drained(out);
}

void Session::carry_out(const feeder::Action& action, Instant now, Effects& out) {
    struct Visitor {
        Session& session;
        Instant now;
        Effects& out;

        void operator()(std::monostate) const {}
        void operator()(const feeder::Inquire& inquire) const {
            protocol::append_inquiry(session.command_, inquire.what);
            session.send_command(SecuredLine::Kind::inquiry, now, inquire.what);
        }
        void operator()(const feeder::Command& command) const {
            if (command.what == protocol::Action::stop_print) {
                session.secured_.drop_records();
                session.give_inquiries_up(now);
            }
            // Never a blind `!EQ`: repeated, it could meet an error that nobody has seen. Nor a blind `!GO`, which
            // could meet a printer that an operator has stopped.
            const bool once =
                command.what == protocol::Action::acknowledge_errors || command.what == protocol::Action::start_print;
            protocol::append_action(session.command_, command.what);
            session.send_command(once ? SecuredLine::Kind::once : SecuredLine::Kind::command, now);
        }
        void operator()(const feeder::SetStopAt& stop) const {
            protocol::append_message(session.command_, protocol::StopAt{stop.number});
            session.send_command(SecuredLine::Kind::command, now);
        }
        void operator()(const feeder::SendRecords& send) const { session.send_records(send.range, now); }
        void operator()(const feeder::SendEndMarker& marker) const {
            append_end_marker(session.command_, marker.number, session.settings_.charsets, session.settings_.escapes);
            session.send_command(SecuredLine::Kind::once, now);
        }
        void operator()(const feeder::Settle& settle) const { out.push_back(settle); }
        void operator()(const feeder::BeginRun& begin) const { out.push_back(begin); }
        void operator()(const feeder::AdoptRun& adopt) const { out.push_back(adopt); }
        void operator()(const feeder::AskIntent& intent) const { out.push_back(intent); }
        void operator()(const feeder::ConfirmPrinted& confirm) const { out.push_back(confirm); }
        void operator()(const feeder::Notice& notice) const { out.push_back(notice); }
        void operator()(const feeder::End& end) const {
            session.end_ = end;
            session.inquiries_.clear();
            while (session.secured_.drop_inquiry()) {
            }
            session.secured_.drop_records();
            if (session.secured_.asks()) {
                session.secured_.give_up();
            }
            session.farewell_deadline_ = now + session.settings_.farewell_timeout;
        }
    };
    std::visit(Visitor{*this, now, out}, action);
}

/// A stop does not wait until a printer answers that has fallen silent. What was asked is lost: on_time() tells the
/// feeder.
void Session::give_inquiries_up(Instant now) {
    if (!secured_.syncing() || !secured_.asks()) {
        return;
    }
    secured_.give_up();
    for (Inquiry& inquiry : inquiries_) {
        inquiry.deadline = now;
        inquiry.given_up = true;
    }
    while (const auto what = secured_.drop_inquiry()) {
        inquiries_.push_back({*what, now, true});
    }
}

void Session::send_command(SecuredLine::Kind kind, Instant now, protocol::Parameter what) {
    if (settings_.line.crc) {
        secured_.add({.kind = kind, .what = what, .bytes = command_});
    } else {
        stage_command(command_, now);
        if (kind == SecuredLine::Kind::inquiry) {
            inquiries_.push_back({what, line_free_at_ + settings_.reply_timeout});
        }
    }
    command_.clear();
}

void Session::send_records(RecordRange records, Instant now) {
    if (settings_.line.crc) {
        secured_.add_records(records);
    } else {
        stage_records(records, now);
    }
}

void Session::stage_command(std::string_view bytes, Instant now) {
    outbox_.command_text() += bytes;
    const std::string_view command = outbox_.staged_command();
    note_sent(command.size(), now);
    if (observer_ != nullptr) {
        observer_->on_command_sent(command, now);
    }
}

void Session::stage_records(RecordRange records, Instant now) {
    const PageWindow::Staged staged = pages_.stage(records, outbox_);
    note_sent(staged.bytes, now);
    note_records(records, staged.first, staged.bytes, now);
}

void Session::note_records(RecordRange records, std::string_view first, std::size_t bytes, Instant now) {
    if (observer_ != nullptr) {
        const feeder::Numbering& numbering = feeder_.numbering(); // those of one job
        const RecordRange numbers{numbering.number_of(records.first()), records.count()};
        observer_->on_records_sent(numbers, first, bytes, now);
    }
    if (staged_records_) {
        staged_records_->records = RecordRange::closed(staged_records_->records.first(), records.last());
    } else {
        staged_records_ = RecordsWritten{records, now, {}};
    }
}

void Session::note_sent(std::size_t bytes, Instant now) {
    line_free_at_ = std::max(line_free_at_, now) + settings_.line.time_of(bytes);
}

void Session::flush(Instant now, Effects& out) {
    if (!connected_) {
        return;
    }
    begin_frame(now);
    if (outbox_.begin_write()) {
        records_under_way_ = std::exchange(staged_records_, std::nullopt);
        out.push_back(Write{});
    }
}

/// Nothing more has to go out.
bool Session::drained() const {
    return outbox_.idle() && secured_.idle();
}

/// Records up to this one need their page no more once the outbox is idle.
RecordNumber Session::staged_through() const {
    const auto waiting = secured_.first_waiting();
    return waiting ? waiting->previous() : feeder_.refill().sent_through();
}

void Session::finish_if_drained(Effects& out) {
    if (!end_ || closed_ || !drained()) {
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
    while (const RecordPage* page = pages_.take_done(staged_through())) {
        out.push_back(ReleasePage{page});
    }
}

} // namespace linefeed::session
