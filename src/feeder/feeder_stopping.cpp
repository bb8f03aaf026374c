// The feeder's way from the last print, or from an interruption, to the end: the line is stopped, the truth is found
// (feeder_judging.cpp), and only then anything is acknowledged.
#include "feeder/feeder.hpp"
#include "feeder/mailing_error.hpp"

namespace linefeed::feeder {

using protocol::MachineState;
using protocol::Parameter;

/// The line is stopped. The ledger takes down no truth any more, so nothing is asked, acknowledged or flushed: the next
/// start finds it.
void Feeder::on_storage_failed(Instant now, Actions& out) {
    switch (phase_) {
    case Phase::stopping:
        cause_ = OutcomeCode::storage_failed;
        return;
    case Phase::judging:
    case Phase::recording:
    case Phase::clearing:
    case Phase::finishing:
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

/// Stopped at once, it lies behind all that is still printed, unless the FIFO was all but empty.
void Feeder::on_unproven_record(RecordNumber number, Instant now, Actions& out) {
    unproven_ = number;
    begin_stop(OutcomeCode::line_noise, now, out);
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
    case Phase::recording:
    case Phase::clearing:
        if (!has_granted_records()) { // the earlier run stays as open as it is
            end(cause, out);
        }
        return;
    case Phase::stopping:
    case Phase::judging:
    case Phase::finishing:
    case Phase::ended:
        return; // already on the way
    }
}

void Feeder::send_stop(Instant now, Actions& out) {
    out.push_back(Command{protocol::Action::stop_print});
    stop_sent_at_ = now;
    enter(Phase::stopping, now, settings_.stop_timeout);
    ask(Parameter::RS, now, out);
}

/// It prints on.
void Feeder::stop_again(Instant now, Actions& out) {
    if (now - stop_sent_at_ >= settings_.stop_repeat) {
        out.push_back(Command{protocol::Action::stop_print});
        stop_sent_at_ = now;
    }
    ask_later(Parameter::RS, now);
}

void Feeder::begin_judging(Instant now, Actions& out) {
    if (cause_ == OutcomeCode::storage_failed) {
        end(*cause_, out);
        return;
    }
    enter(Phase::judging, now, settings_.finish_timeout);
    ask(Parameter::RS, now, out);
}

/// `?RS` once more behind the stop: what is read from now on is the truth, as long as the printer stands.
void Feeder::judge_status(Instant now, Actions& out) {
    if (status_.machine == MachineState::printing) {
        note_unfinished(); // by the last answer: no other may tell it
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
    if (is_error(status_.error, protocol::error_code::buffer_empty) && refill_.starved()) {
        return OutcomeCode::ran_dry;
    }
    if (!status_.error.none() && status_.error.raw != error_noticed_) {
        return OutcomeCode::printer_error;
    }
    return status_.cover_open ? OutcomeCode::cover_open : OutcomeCode::stopped_at_printer;
}

/// Every record is printed, and the ledger is told so. What mailing leaves behind then (1223, or 5043 where no stop
/// point is kept) is acknowledged: the printer would switch itself off otherwise (protocol, section 2).
void Feeder::finish(Instant now, Actions& out) {
    if (!is_mailing_error(status_.error)) {
        end(OutcomeCode::finished, out);
        return;
    }
    acknowledged_ = status_.error.raw;
    enter(Phase::finishing, now, settings_.finish_timeout);
    out.push_back(Command{protocol::Action::acknowledge_errors});
    ask(Parameter::RS, now, out);
}

void Feeder::end(OutcomeCode code, Actions& out) {
    if (phase_ == Phase::ended) {
        return;
    }
    phase_ = Phase::ended;
    retry_at_.reset();
    deadline_.reset();
    go_due_.reset();
    const bool unclear = restarted_ || nobody_knows_ || (plan_.open && plan_.open->unclear);
    out.push_back(End{{code, status_.machine, status_.error, any_sent_, broken_off_, unclear}});
}

} // namespace linefeed::feeder
