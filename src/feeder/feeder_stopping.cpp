// The feeder's way from the last print, or from an interruption, to the truth: the line is stopped, the printer is
// asked where it is, the verdict goes to the ledger, and only then anything is acknowledged or flushed.
#include "feeder/feeder.hpp"
#include "feeder/mailing_error.hpp"

namespace linefeed::feeder {

using protocol::MachineState;
using protocol::Parameter;

void Feeder::on_settled(Actions& out) {
    --settles_pending_;
    if (phase_ == Phase::clearing && settles_pending_ <= 0) {
        clear(out);
    }
}

/// The ledger knows the truth: what the printer still holds is thrown away.
void Feeder::clear(Actions& out) {
    flush_owed_ = false;
    out.push_back(Command{protocol::Action::flush_fifo});
    end(*cause_, out);
}

namespace {

/// Whether the printer and the ledger are still there at such an end.
bool can_flush(OutcomeCode code) {
    return code != OutcomeCode::link_lost && code != OutcomeCode::no_answer && code != OutcomeCode::storage_failed;
}

} // namespace

/// The line is stopped and the truth is found all the same, for people; but the ledger does not take it down, so
/// nothing is acknowledged or flushed.
void Feeder::on_storage_failed(Instant now, Actions& out) {
    switch (phase_) {
    case Phase::stopping:
    case Phase::judging:
        cause_ = OutcomeCode::storage_failed;
        return;
    case Phase::finishing:
    case Phase::clearing:
        end(OutcomeCode::storage_failed, out);
        return;
    case Phase::idle:
    case Phase::identifying:
    case Phase::locating:
    case Phase::taking_over:
    case Phase::halting:
    case Phase::opening_nozzle:
    case Phase::acknowledging:
    case Phase::granting:
    case Phase::flushing:
    case Phase::setting_stop:
    case Phase::loading:
    case Phase::verifying:
    case Phase::starting:
    case Phase::printing:
    case Phase::ended:
        begin_stop(OutcomeCode::storage_failed, now, out);
        return;
    }
}

void Feeder::request_stop(Instant now, Actions& out) {
    begin_stop(OutcomeCode::stop_requested, now, out);
}

void Feeder::begin_stop(OutcomeCode cause, Instant now, Actions& out) {
    switch (phase_) {
    case Phase::taking_over:
    case Phase::granting:
        if (phase_ == Phase::taking_over || taking_over_) {
            out.push_back(Command{protocol::Action::stop_print}); // it prints; the next start finds the truth
        }
        end(cause, out);
        return;
    case Phase::idle:
    case Phase::identifying:
    case Phase::locating:
    case Phase::halting:
    case Phase::opening_nozzle:
    case Phase::acknowledging:
        end(cause, out);
        return;
    case Phase::flushing:
    case Phase::setting_stop:
    case Phase::loading:
    case Phase::verifying:
    case Phase::starting:
    case Phase::printing:
        cause_ = cause;
        send_stop(now, out);
        return;
    case Phase::stopping:
    case Phase::judging:
    case Phase::finishing:
    case Phase::clearing:
    case Phase::ended:
        return; // already on the way
    }
}

void Feeder::send_stop(Instant now, Actions& out) {
    out.push_back(Command{protocol::Action::stop_print});
    enter(Phase::stopping, now, settings_.stop_timeout);
    ask(Parameter::RS, now, out);
}

void Feeder::begin_judging(Instant now, Actions& out) {
    enter(Phase::judging, now, settings_.finish_timeout);
    ask(Parameter::RS, now, out);
}

/// `?RS` once more behind the stop: what is read from now on is the truth, as long as the printer stands.
void Feeder::judge_status(Instant now, Actions& out) {
    if (status_.machine == MachineState::printing) {
        restarted_ = true;
        send_stop(now, out);
        return;
    }
    ask(Parameter::SM, now, out);
}

OutcomeCode Feeder::cause_of_stop() const {
    if (cause_) {
        return *cause_;
    }
    if (!status_.error.none() && status_.error.raw != error_noticed_) {
        return OutcomeCode::printer_error;
    }
    return status_.cover_open ? OutcomeCode::cover_open : OutcomeCode::stopped_at_printer;
}

void Feeder::judge(Instant now, Actions& out) {
    const RecordRange range = refill_.range();
    const bool shows_end_message = is_error(status_.error, protocol::error_code::last_record_printed);
    const bool stop_point_stood = stop_point_ == StopPoint::kept || stop_point_ == StopPoint::kept_idle;
    Evidence evidence{.mail = mail_,
                      .printer = facts_,
                      .end_message = shows_end_message && stop_point_stood && refill_.all_sent() && !restarted_,
                      .uninterrupted = !memory_lost_,
                      .restarted = restarted_};
    if (marker_printed()) { // a blank product behind the last record
        evidence.mail.last_printed = range.last();
        evidence.mail.last_print_finished = true;
    }
    // Before the flush the printer may hold records of this run that an earlier one has sent.
    const bool prints_unflushed = !fifo_is_ours_ && range.contains(mail_.last_printed);
    const OpenRun run{.first = range.first(),
                      .printed_through = confirmed_through_,
                      .issued_through = prints_unflushed ? refill_.durable_through() : refill_.sent_through(),
                      .serial_number = facts_.version ? facts_.version->serial_number : std::string{},
                      .total_before = total_before_,
                      .last_printed_before = left_over_,
                      .last = marker_sent_ ? std::optional{range.last()} : std::nullopt};
    const Verdict verdict = reconcile(run, evidence);
    settled_ = true;
    out.push_back(Settle{verdict, evidence, false});
    ++settles_pending_;

    cause_ = cause_of_stop();
    const RecordNumber printed = verdict.printed.empty() ? confirmed_through_ : verdict.printed.last();
    if (*cause_ == OutcomeCode::storage_failed) {
        end(*cause_, out);
    } else if (verdict.in_doubt.empty() && printed == range.last()) {
        if (!shows_end_message) {
            end(OutcomeCode::finished, out);
            return;
        }
        acknowledged_ = status_.error.raw;
        enter(Phase::finishing, now, settings_.finish_timeout);
        out.push_back(Command{protocol::Action::acknowledge_errors});
        ask(Parameter::RS, now, out);
    } else if (any_sent_ || mail_.entries > 0) {
        // Sent and perhaps never started: nobody may print them unseen. The entries do not tell, a single record counts
        // as none (protocol, section 5); so the FIFO is flushed whatever they say.
        enter(Phase::clearing, now, settings_.stop_timeout);
    } else {
        end(*cause_, out);
    }
}

void Feeder::end(OutcomeCode code, Actions& out) {
    if (phase_ == Phase::ended) {
        return;
    }
    if (flush_owed_ && can_flush(code)) {
        // The earlier run's records are settled, and may still lie in the FIFO, where somebody could start them.
        cause_ = code;
        enter(Phase::clearing, {}, Duration::max());
        if (settles_pending_ <= 0) {
            clear(out);
        }
        return;
    }
    if (fifo_is_ours_ && !any_sent_ && !settled_) { // granted, and surely not in the printer
        out.push_back(Settle{{.basis = Basis::nothing_issued}, {.mail = mail_, .printer = facts_}, false});
        ++settles_pending_;
    }
    phase_ = Phase::ended;
    retry_at_.reset();
    deadline_.reset();
    mail_due_.reset();
    status_due_.reset();
    out.push_back(End{{code, status_.machine, status_.error, any_sent_}});
}

} // namespace linefeed::feeder
