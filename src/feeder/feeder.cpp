// Where the facts arrive: each goes to the step that waits for it.
#include "feeder/feeder.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::feeder {

using protocol::MachineState;
using protocol::Parameter;

namespace {
constexpr int max_answers_lost = 3;
} // namespace

Feeder::Feeder(const FeederSettings& settings, const FeederPlan& plan)
    : settings_(settings)
    , plan_(plan)
    , pacing_(settings.pacing)
    , numbering_(plan.numbering)
    , broken_off_(plan.open ? plan.open->broken_off : RecordNumber{}) {}

void Feeder::on_machine_status(const protocol::MachineStatus& status, Instant now, Actions& out) {
    if (status.machine == MachineState::unknown && answers_lost_ < max_answers_lost) {
        on_lost_answer(Parameter::RS, now, out); // damaged rather than new
        return;
    }
    answers_lost_ = 0;
    status_ = status;
    status_outstanding_ = false;
    switch (phase_) {
    case Phase::identifying:
        if (status_.machine == MachineState::standby || status_.machine == MachineState::unknown) {
            end(OutcomeCode::not_ready, out); // nothing else is answered in standby
            return;
        }
        identity_answers_missing_ = 2;
        identity_asked_at_ = now;
        ask(Parameter::VS, now, out);
        ask(Parameter::JL, now, out);
        return;
    case Phase::halting:
        if (status_.machine == MachineState::printing) {
            stop_again(now, out);
            return;
        }
        enter(Phase::locating, now, settings_.finish_timeout);
        ask(Parameter::SM, now, out);
        return;
    case Phase::acknowledging:
        if (status_.error.raw == acknowledged_) {
            ask_later(Parameter::RS, now);
            return;
        }
        check_ready(now, out); // acknowledged; perhaps another error stood behind it
        return;
    case Phase::opening_nozzle:
        if (status_.machine == MachineState::ready && (status_.error.none() || status_.error.raw == error_noticed_)) {
            ask_later(Parameter::RS, now);
            return;
        }
        check_ready(now, out);
        return;
    case Phase::starting:
        start_answered(now, out);
        return;
    case Phase::printing:
        print_status(now, out);
        return;
    case Phase::stopping:
        if (status_.machine == MachineState::printing) {
            stop_again(now, out);
            return;
        }
        begin_judging(now, out);
        return;
    case Phase::judging:
        judge_status(now, out);
        return;
    case Phase::clearing:
        clearing_status(now, out);
        return;
    case Phase::finishing:
        if (status_.error.raw == acknowledged_) {
            ask_later(Parameter::RS, now);
            return;
        }
        end(OutcomeCode::finished, out);
        return;
    case Phase::idle:
    case Phase::locating:
    case Phase::taking_over:
    case Phase::granting:
    case Phase::flushing:
    case Phase::setting_stop:
    case Phase::loading:
    case Phase::verifying:
    case Phase::recording:
    case Phase::ended:
        return;
    }
}

void Feeder::on_mail_status(const protocol::MailStatus& status, Instant now, Actions& out) {
    if (lacks_value(status)) {
        on_lost_answer(Parameter::SM, now, out);
        return;
    }
    mail_answered(now);
    answers_lost_ = 0;
    said_ = status;
    mail_ = numbering_.is_plain() ? status : in_places(status);
    ++mail_reads_;
    switch (phase_) {
    case Phase::locating:
    case Phase::judging:
    case Phase::clearing:
        locate_step(now, out);
        return;
    case Phase::taking_over:
        takeover_step(now, out);
        return;
    case Phase::flushing:
        flushed(now, out);
        return;
    case Phase::setting_stop:
        stop_point_answered(now, out);
        return;
    case Phase::verifying:
        verify(now, out);
        return;
    case Phase::starting:
        start_mail(now, out);
        return;
    case Phase::printing:
        print_mail(now, out);
        return;
    case Phase::idle:
    case Phase::identifying:
    case Phase::halting:
    case Phase::opening_nozzle:
    case Phase::acknowledging:
    case Phase::granting:
    case Phase::loading:
    case Phase::stopping:
    case Phase::recording:
    case Phase::finishing:
    case Phase::ended:
        return;
    }
}

/// Where `=SM` has six values (protocol, section 5), one with five has lost a TAB on a serial line: others stand in the
/// place of its values, and the count of PrintGos looks like a print that has finished. Two in a row are meant so.
bool Feeder::lacks_value(const protocol::MailStatus& status) {
    const bool lacks = mail_.print_go_count && !status.print_go_count;
    return !std::exchange(lacked_value_, lacks) && lacks;
}

/// Only the second of two answers is surely current; a print in progress gets the time to finish, and a flush the time
/// to be carried out.
void Feeder::locate_step(Instant now, Actions& out) {
    const bool stands = status_.machine != MachineState::printing;
    if (stands && std::exchange(stood_, true)) { // perhaps it is started again before it has been judged
        note_unfinished();
        note_restart();
    }
    if (mail_outstanding_ > 0) {
        mail_reads_ = 0; // an answer to an inquiry from before the stop
        return;
    }
    if (mail_reads_ < 2) {
        ask(Parameter::SM, now, out);
        return;
    }
    const bool print_in_progress = stands && !mail_.last_print_finished;
    const bool not_flushed = phase_ == Phase::clearing && mail_.entries > 0;
    if ((print_in_progress || not_flushed) && deadline_ && now < *deadline_) {
        ask_later(Parameter::SM, now);
    } else if (not_flushed) {
        end(OutcomeCode::fifo_not_flushed, out); // what lies there may still be printed: its fate stays open
    } else {
        ask(Parameter::CC, now, out);
    }
}

/// What it reports now was not in the printer when it was seen printing last: a stop has emptied the FIFO, and it has
/// printed on behind that. A counter tells this better: a line that almost starves may print what came since.
void Feeder::note_restart() {
    const std::uint64_t reported = mail_.last_printed.value();
    const std::uint64_t sent = refill_.sent_through().value() + (marker_sent_ ? std::uint64_t{1} : 0);
    const bool left_over = !left_over_passed_ && mail_.last_printed == left_over_;
    const bool came_since = held_through_ < reported && reported <= sent;
    restarted_ = restarted_ || (has_granted_records() && !total_before_ && !left_over && came_since);
}

/// The printer has been stopped, and the print in progress may be broken off. Should it print on behind it, somebody
/// has started it again.
void Feeder::note_unfinished() {
    if (mail_.last_print_finished) {
        broken_off_ = mail_.last_printed == broken_off_ ? RecordNumber{} : broken_off_;
    } else if (broken_off_ == RecordNumber{}) {
        broken_off_ = mail_.last_printed;
    }
}

void Feeder::on_counters(const protocol::Counters& counters, Instant now, Actions& out) {
    if (phase_ == Phase::ended) {
        return;
    }
    if (!counters.total) {
        counters_lost(now, out); // with a TAB less it is not in its place
        return;
    }
    if (polls()) {
        counters_outstanding_ = std::max(0, counters_outstanding_ - 1);
        facts_.total_prints = counters.total;
        print_counters(*counters.total, now, out);
        return;
    }
    counted(counters.total, now, out);
}

/// `total` is absent if the printer does not tell it.
void Feeder::counted(std::optional<std::uint32_t> total, Instant now, Actions& out) {
    facts_.total_prints = total;
    counters_outstanding_ = std::max(0, counters_outstanding_ - 1);
    if (counters_outstanding_ > 0 || mail_reads_ < 2) {
        return; // asked before the printer stood
    }
    if (phase_ == Phase::locating) {
        located(now, out);
    } else if (phase_ == Phase::judging) {
        judge(now, out);
    } else if (phase_ == Phase::clearing) {
        judge_finally(now, out);
    }
}

void Feeder::on_version(const protocol::VersionInfo& version, Instant now, Actions& out) {
    time_identity(now);
    facts_.version = version;
    if (version.serial_number.empty() && asks_version_again(now, out)) {
        return; // with a TAB less it is not in its place
    }
    if (--identity_answers_missing_ == 0) {
        identified(now, out);
    }
}

/// The two are asked for at once.
void Feeder::time_identity(Instant now) {
    ++identity_answers_;
    if (identity_answers_ == 1) {
        identity_answered_at_ = now;
    } else if (identity_answers_ == 2) {
        pacing_.pair_answered_after(identity_answered_at_ - identity_asked_at_, now - identity_asked_at_);
    }
}

/// Without the serial number another printer cannot be told from this one.
bool Feeder::asks_version_again(Instant now, Actions& out) {
    const bool again = phase_ == Phase::identifying && !std::exchange(version_asked_again_, true);
    if (again) {
        ask(Parameter::VS, now, out);
    }
    return again;
}

void Feeder::on_job_name(const protocol::JobName& job, Instant now, Actions& out) {
    time_identity(now);
    facts_.job_name = job.path;
    if (--identity_answers_missing_ == 0) {
        identified(now, out);
    }
}

/// A serial line may damage an answer, or the inquiry.
void Feeder::on_lost_answer(Parameter what, Instant now, Actions& out) {
    if (phase_ == Phase::ended) {
        return;
    }
    if (what == Parameter::VS || what == Parameter::JL) {
        // A printer that says its job's name says its serial number too.
        const bool can_tell = what == Parameter::VS && facts_.job_name;
        if (!(can_tell && asks_version_again(now, out)) && --identity_answers_missing_ == 0) {
            identified(now, out);
        }
        return;
    }
    if (what == Parameter::CC) {
        counters_lost(now, out);
        return;
    }
    if (what == Parameter::SM) {
        forget_oldest_mail();
    } else {
        status_outstanding_ = false;
    }
    const bool again = what == Parameter::SM ? waits_for_mail() && mail_outstanding_ == 0 : waits_for_status();
    if (again && ++answers_lost_ > max_answers_lost) {
        on_silence(out);
    } else if (again) {
        ask(what, now, out);
    }
}

/// The counter is worth a second inquiry, and more of a printer that has told it before. While it prints, it is asked
/// for again anyway.
void Feeder::counters_lost(Instant now, Actions& out) {
    if (polls()) {
        counters_outstanding_ = std::max(0, counters_outstanding_ - 1);
        return;
    }
    const bool again =
        facts_.total_prints ? ++answers_lost_ <= max_answers_lost : !std::exchange(counter_asked_again_, true);
    if (again && counters_outstanding_ == 1) {
        --counters_outstanding_;
        ask(Parameter::CC, now, out);
    } else {
        counted(std::nullopt, now, out);
    }
}

void Feeder::on_proven_record(Instant now) {
    if (phase_ == Phase::verifying) {
        deadline_ = now + settings_.verify_timeout;
    }
}

void Feeder::on_silence(Actions& out) {
    if (phase_ == Phase::ended) {
        return;
    }
    if (phase_ == Phase::finishing) {
        end(OutcomeCode::finished, out); // printed and settled all; only the message stays on the panel
        return;
    }
    if (any_sent_) {
        out.push_back(Command{protocol::Action::stop_print}); // it may still listen
    }
    end(OutcomeCode::no_answer, out);
}

void Feeder::on_not_secured(Actions& out) {
    if (phase_ != Phase::ended) {
        end(OutcomeCode::not_secured, out);
    }
}

void Feeder::on_link_lost(Actions& out) {
    end(phase_ == Phase::finishing ? OutcomeCode::finished : OutcomeCode::link_lost, out);
}

void Feeder::on_durable(RecordNumber through, Instant now, Actions& out) {
    if (!has_granted_records()) {
        return;
    }
    refill_.durable(through);
    if (polls()) {
        refill_now(out);
    }
    try_loading(now, out);
}

void Feeder::on_supplied(RecordNumber through, Instant now, Actions& out) {
    if (!has_granted_records()) {
        return;
    }
    refill_.supplied(through);
    if (polls()) {
        refill_now(out);
    }
    try_loading(now, out);
}

} // namespace linefeed::feeder
