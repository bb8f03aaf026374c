// The feeder's way from a fresh connection to the first print (protocol, section 5). Nothing is flushed before the
// ledger knows the truth about earlier records, and no error is acknowledged that is not understood.
#include "feeder/feeder.hpp"
#include "feeder/mailing_error.hpp"

#include <algorithm>

namespace linefeed::feeder {

using protocol::MachineState;
using protocol::Parameter;

void Feeder::start(Instant now, Actions& out) {
    LINEFEED_ASSERT(phase_ == Phase::idle);
    enter(Phase::identifying, now, Duration::max());
    ask(Parameter::RS, now, out);
}

void Feeder::identified(Instant now, Actions& out) {
    if (phase_ == Phase::identifying) {
        enter(Phase::locating, now, settings_.finish_timeout);
        ask(Parameter::SM, now, out);
    }
}

/// The printer prints records of the open run, or has been started on it and has not yet printed the first.
bool Feeder::prints_earlier_run() const {
    if (!plan_.open || is_another_printer(*plan_.open, facts_)) {
        return false;
    }
    const OpenRun& run = *plan_.open;
    const bool ours =
        std::max(run.first, run.printed_through) <= mail_.last_printed && mail_.last_printed <= run.issued_through;
    const bool not_begun = run.printed_through < run.first && mail_.last_printed == run.last_printed_before;
    return ours || not_begun;
}

void Feeder::located(Instant now, Actions& out) {
    if (status_.machine == MachineState::printing) {
        if (!prints_earlier_run()) {
            end(OutcomeCode::busy, out);
            return;
        }
        if (may_take_over()) {
            begin_takeover(now, out);
        } else {
            halt(now, out);
        }
        return;
    }
    if (plan_.open) {
        judge(now, out);
    } else {
        check_ready(now, out);
    }
}

/// Asks once more where the printer is: time has passed since it said so.
void Feeder::locate_again(Instant now, Actions& out) {
    enter(Phase::locating, now, settings_.finish_timeout);
    ask(Parameter::SM, now, out);
}

void Feeder::check_ready(Instant now, Actions& out) {
    if (status_.machine == MachineState::printing) {
        locate_again(now, out); // started by hand meanwhile
        return;
    }
    if (status_.cover_open && status_.machine != MachineState::standby) {
        end(OutcomeCode::cover_open, out);
        return;
    }
    const bool nozzle_opens = status_.machine == MachineState::ready && settings_.open_nozzle;
    if (status_.machine != MachineState::ready_to_print && !nozzle_opens) {
        end(OutcomeCode::not_ready, out);
        return;
    }
    check_errors(now, out);
}

bool StoppingErrors::contain(const protocol::PrinterError& error) const {
    const bool listed = std::ranges::binary_search(numbers, error.code()) ||
                        std::ranges::binary_search(numbers, error.code_without_bit_24());
    return listed != all_others;
}

bool Feeder::is_allowed(const protocol::PrinterError& error) const {
    const auto allowed = [this](std::uint32_t error_code) {
        return std::find(settings_.acknowledge.begin(), settings_.acknowledge.end(), error_code) !=
               settings_.acknowledge.end();
    };
    return allowed(error.code()) || allowed(error.code_without_bit_24());
}

bool Feeder::may_acknowledge(const protocol::PrinterError& error) const {
    return is_mailing_error(error) || is_allowed(error);
}

bool Feeder::stops(const protocol::PrinterError& error) const {
    return error.display() == protocol::ErrorDisplay::error || settings_.stop_on.contain(error);
}

void Feeder::check_errors(Instant now, Actions& out) {
    if (!status_.error.none() && status_.error.raw != error_noticed_) {
        if (may_acknowledge(status_.error)) {
            acknowledged_ = status_.error.raw;
            out.push_back(Notice{NoticeCode::error_acknowledged, status_.error});
            out.push_back(Command{protocol::Action::acknowledge_errors});
            if (phase_ != Phase::acknowledging) { // one deadline, however many errors stand behind one another
                enter(Phase::acknowledging, now, settings_.finish_timeout);
            }
            ask(Parameter::RS, now, out);
            return;
        }
        if (stops(status_.error)) {
            end(OutcomeCode::error_pending, out);
            return;
        }
        out.push_back(Notice{NoticeCode::printer_warning, status_.error});
        error_noticed_ = status_.error.raw;
    }
    if (status_.machine == MachineState::ready) {
        out.push_back(Notice{NoticeCode::nozzle_opening, {}});
        out.push_back(Command{protocol::Action::nozzle_open});
        enter(Phase::opening_nozzle, now, settings_.nozzle_timeout);
        ask(Parameter::RS, now, out);
        return;
    }
    if (mail_.depth == 0) {
        end(OutcomeCode::records_not_taken, out);
        return;
    }
    enter(Phase::granting, now, Duration::max());
    out.push_back(BeginRun{facts_, mail_.last_printed});
}

void Feeder::on_granted(RecordRange range, RecordNumber durable_through, Instant now, Actions& out) {
    if (phase_ != Phase::granting) {
        return;
    }
    if (taking_over_) {
        taken_over(range, durable_through, now, out);
        return;
    }
    refill_.begin(range, std::min(RecordCount{mail_.depth}, settings_.level_at_most));
    refill_.durable(durable_through);
    confirmed_through_ = reported_through_ = range.first().previous();
    stop_number_ = range.last();
    job_first_ = range.first();
    total_before_ = facts_.total_prints;
    left_over_ = mail_.last_printed;
    broken_off_ = RecordNumber{}; // of the earlier run, which is settled
    enter(Phase::flushing, now, settings_.flush_timeout);
    out.push_back(Command{protocol::Action::flush_fifo});
    ask(Parameter::SM, now, out);
}

void Feeder::on_refused(OutcomeCode why, Actions& out) {
    if (phase_ == Phase::granting) {
        end(why, out);
    }
}

/// By the number that stood there when the ledger took the truth down. Some firmware forgets it with the flush.
bool Feeder::printed_for_another() const {
    return mail_.last_printed != left_over_ && mail_.last_printed != RecordNumber{};
}

void Feeder::flushed(Instant now, Actions& out) {
    if (printed_for_another()) {
        begin_stop(OutcomeCode::busy, now, out);
        return;
    }
    if (mail_.entries != 0) {
        ask_later(Parameter::SM, now);
        return;
    }
    left_over_ = mail_.last_printed;
    set_stop_point(now, out);
}

void Feeder::set_stop_point(Instant now, Actions& out) {
    enter(Phase::setting_stop, now, Duration::max());
    out.push_back(SetStopAt{stop_number_});
    ask(Parameter::SM, now, out);
}

void Feeder::stop_point_answered(Instant now, Actions& out) {
    if ((mail_.stop_at != stop_number_ || printed_for_another()) && mail_reads_ < 2) {
        ask(Parameter::SM, now, out);
        return;
    }
    if (printed_for_another()) {
        begin_stop(OutcomeCode::busy, now, out);
        return;
    }
    // Some firmware keeps the stop point only once it is printing: insist_on_stop_point() tries again there.
    stop_point_ = mail_.stop_at == stop_number_ ? StopPoint::kept_idle : StopPoint::unset;
    enter(Phase::loading, now, Duration::max());
    try_loading(now, out);
}

void Feeder::try_loading(Instant now, Actions& out) {
    if (phase_ != Phase::loading) {
        return;
    }
    if (!refill_.first_fill_ready()) {
        if (const auto intent = refill_.next_intent()) {
            out.push_back(AskIntent{*intent});
        }
        return;
    }
    enter(Phase::verifying, now, settings_.verify_timeout);
    refill_now(out);
    ask(Parameter::SM, now, out);
}

void Feeder::verify(Instant now, Actions& out) {
    const std::uint64_t sent = refill_.level().value();
    const bool as_expected = mail_.entries + std::uint64_t{1} == sent;
    const bool stop_point_stands = stop_point_ != StopPoint::kept_idle || mail_.stop_at == stop_number_;
    if (!(as_expected && stop_point_stands && !printed_for_another()) && mail_reads_ < 2) {
        ask(Parameter::SM, now, out);
        return;
    }
    if (printed_for_another()) {
        begin_stop(OutcomeCode::busy, now, out); // and the counter has counted that
        return;
    }
    if (!stop_point_stands) {
        begin_stop(OutcomeCode::stopped_at_printer, now, out); // with the stop point a part of the fill is gone
        return;
    }
    if (mail_.entries == 0 && sent > 1) {
        ask_later(Parameter::SM, now);
        return;
    }
    const std::uint64_t way_to_count = total_before_ ? 1 : 0; // one less may be one: the counter will tell
    if (mail_.entries + std::uint64_t{1} + way_to_count < sent) {
        begin_stop(OutcomeCode::stopped_at_printer, now, out);
        return;
    }
    const std::uint64_t excess = mail_.entries >= sent ? mail_.entries + std::uint64_t{1} - sent : 0;
    if (excess > 1) {
        begin_stop(OutcomeCode::impossible_report, now, out); // somebody else feeds the printer
        return;
    }
    excess_of_fill_ = excess;
    held_through_ = chained_through_ = refill_.sent_through().value();
    if (!as_expected) {
        out.push_back(Notice{NoticeCode::entries_differ, {}});
        doubt_number(); // a stop, or a damaged line, may have cost a part of the fill
    }
    entries_filled_ = mail_.entries;
    enter(Phase::starting, now, Duration::max());
    go_due_ = now + settings_.fill_lead;
}

void Feeder::go(Instant now, Actions& out) {
    enter(Phase::starting, now, settings_.start_timeout);
    pacing_.restart(now);
    out.push_back(Command{protocol::Action::start_print});
    go_sent_at_ = now;
    ask(Parameter::RS, now, out);
    ask(Parameter::SM, now, out);
}

/// It stands. `!GO` may be lost, or an operator may have stopped the printer already, which empties the FIFO; behind a
/// stop it must not start again. Of what is asked from now on, the second `=SM` tells.
void Feeder::stands_after_go(Instant now) {
    if (!go_again_at_read_ && now - go_sent_at_ >= settings_.go_repeat) {
        go_again_at_read_ = mail_reads_ + mail_outstanding_ + 2;
    }
    ask_later(Parameter::RS, now);
}

void Feeder::go_again(Instant now, Actions& out) {
    go_again_at_read_.reset();
    if (mail_.entries > 0 && mail_.entries == entries_filled_) {
        out.push_back(Command{protocol::Action::start_print});
        go_sent_at_ = now;
    }
}

/// The first products may be through before the answer that it prints: the refill does not wait for that.
void Feeder::start_mail(Instant now, Actions& out) {
    if (go_due_) {
        return; // asked about the fill
    }
    if (!stop_would_show() || stop_point_stands()) {
        static_cast<void>(follow(now, out));
    }
    if (phase_ == Phase::starting && go_again_at_read_ && mail_reads_ >= *go_again_at_read_) {
        go_again(now, out);
    }
    poll_on(now);
}

void Feeder::start_answered(Instant now, Actions& out) {
    if (go_due_) {
        return; // nobody asked
    }
    if (status_.machine == MachineState::printing) {
        enter(Phase::printing, now, Duration::max());
        out.push_back(Notice{NoticeCode::printing_started, {}});
        if (stop_point_ == StopPoint::unset) {
            set_stop_point_again(out);
        }
        plan_status(now);
        if (mail_outstanding_ == 0) {
            ask(Parameter::SM, now, out);
        }
        return;
    }
    if (!status_.error.none() && status_.error.raw != error_noticed_) {
        if (status_.error.display() == protocol::ErrorDisplay::error || is_mailing_error(status_.error)) {
            begin_judging(now, out); // stopped already: by an error, or behind the last record of a short run
            return;
        }
        if (stops(status_.error)) {
            begin_stop(OutcomeCode::printer_error, now, out);
            return;
        }
        out.push_back(Notice{NoticeCode::printer_warning, status_.error});
        error_noticed_ = status_.error.raw;
    }
    if (reported_through_ == refill_.range().last()) {
        begin_judging(now, out); // a short run that is over already
        return;
    }
    stands_after_go(now);
}

} // namespace linefeed::feeder
