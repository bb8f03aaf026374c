// The feeder's clockwork: what is asked now or later, the deadline of each phase, and when it wants to be woken.
#include "feeder/feeder.hpp"

#include <algorithm>

namespace linefeed::feeder {

using protocol::Parameter;

void Feeder::enter(Phase phase, Instant now, Duration timeout) {
    phase_ = phase;
    mail_reads_ = 0;
    stood_ = false;
    retry_at_.reset();
    go_due_.reset();
    go_again_at_read_.reset();
    deadline_.reset();
    if (timeout != Duration::max()) {
        deadline_ = now + timeout;
    }
}

void Feeder::ask(Parameter what, Instant now, Actions& out) {
    if (what == Parameter::SM) {
        const std::size_t newest = (mail_oldest_ + static_cast<std::size_t>(mail_outstanding_)) % mail_asked_.size();
        mail_asked_[newest] = {now, ++mail_outstanding_, refill_.sent_through()};
        mail_due_ = now + pacing_.poll_interval(refill_.level());
    }
    if (what == Parameter::RS) {
        status_outstanding_ = true;
    }
    if (what == Parameter::CC) {
        ++counters_outstanding_;
    }
    out.push_back(Inquire{what});
}

/// Answers come in the order of the inquiries.
void Feeder::mail_answered(Instant now) {
    if (mail_outstanding_ == 0) {
        return; // nobody asked
    }
    const MailAsked& asked = mail_asked_[mail_oldest_];
    pacing_.answered_after(now - asked.at, asked.under_way);
    forget_oldest_mail();
}

void Feeder::forget_oldest_mail() {
    if (mail_outstanding_ > 0) {
        surely_received_ = sent_before_inquiry_;
        sent_before_inquiry_ = mail_asked_[mail_oldest_].sent_through;
        mail_oldest_ = (mail_oldest_ + 1) % mail_asked_.size();
        --mail_outstanding_;
    }
}

/// Nothing goes on before `=SM` comes. While it prints, it is asked for again anyway.
bool Feeder::waits_for_mail() const {
    switch (phase_) {
    case Phase::locating:
    case Phase::taking_over:
    case Phase::flushing:
    case Phase::setting_stop:
    case Phase::verifying:
    case Phase::judging:
    case Phase::clearing:
        return true;
    case Phase::idle:
    case Phase::identifying:
    case Phase::halting:
    case Phase::opening_nozzle:
    case Phase::acknowledging:
    case Phase::granting:
    case Phase::loading:
    case Phase::starting:
    case Phase::printing:
    case Phase::stopping:
    case Phase::recording:
    case Phase::finishing:
    case Phase::ended:
        return false;
    }
    assertion_failed("Phase", __FILE__, __LINE__);
}

/// Nothing goes on before `=RS` comes, or it is the only sign of a stop.
bool Feeder::waits_for_status() const {
    switch (phase_) {
    case Phase::identifying:
    case Phase::halting:
    case Phase::opening_nozzle:
    case Phase::acknowledging:
    case Phase::starting:
    case Phase::printing:
    case Phase::stopping:
    case Phase::judging:
    case Phase::clearing:
    case Phase::finishing:
        return true;
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
        return false;
    }
    assertion_failed("Phase", __FILE__, __LINE__);
}

void Feeder::ask_later(Parameter what, Instant now) {
    retry_at_ = now + settings_.retry_interval;
    retry_what_ = what;
}

/// The deadline of the phase has passed.
void Feeder::on_deadline(Instant now, Actions& out) {
    switch (phase_) {
    case Phase::halting:
        end(OutcomeCode::did_not_stop, out);
        return;
    case Phase::opening_nozzle:
        end(OutcomeCode::not_ready, out);
        return;
    case Phase::acknowledging:
        end(OutcomeCode::error_pending, out);
        return;
    case Phase::flushing:
        begin_stop(OutcomeCode::fifo_not_flushed, now, out);
        return;
    case Phase::verifying:
        begin_stop(OutcomeCode::records_not_taken, now, out);
        return;
    case Phase::starting:
        begin_stop(OutcomeCode::did_not_start, now, out);
        return;
    case Phase::stopping:
        end(OutcomeCode::did_not_stop, out);
        return;
    case Phase::finishing:
        end(OutcomeCode::finished, out);
        return; // as in on_silence()
    case Phase::recording:
        end(OutcomeCode::storage_failed, out); // the ledger does not answer: nothing is flushed
        return;
    case Phase::locating:
    case Phase::judging:
    case Phase::clearing:
        deadline_.reset();
        return; // the print in progress, or the flush, had its time: locate_step() goes on without
    case Phase::idle:
    case Phase::identifying:
    case Phase::taking_over:
    case Phase::granting:
    case Phase::setting_stop:
    case Phase::loading:
    case Phase::printing:
    case Phase::ended:
        deadline_.reset();
        return;
    }
}

void Feeder::on_time(Instant now, Actions& out) {
    if (deadline_ && now >= *deadline_) {
        on_deadline(now, out);
    }
    if (retry_at_ && now >= *retry_at_) {
        retry_at_.reset();
        ask(retry_what_, now, out);
    }
    if (go_due_ && now >= *go_due_) {
        go(now, out);
    }
    if (polls() && now >= mail_due_ && mail_outstanding_ < pacing_.inquiries_at_most()) {
        ask(Parameter::SM, now, out);
    }
    if (phase_ == Phase::printing && now >= status_due_ && !status_outstanding_) {
        ask(Parameter::RS, now, out);
    }
}

std::optional<Instant> Feeder::next_wake() const {
    std::optional<Instant> wake;
    const auto consider = [&wake](const std::optional<Instant>& at) {
        if (at && (!wake || *at < *wake)) {
            wake = at;
        }
    };
    consider(deadline_);
    consider(retry_at_);
    consider(go_due_);
    if (polls() && mail_outstanding_ < pacing_.inquiries_at_most()) {
        consider(mail_due_);
    }
    if (phase_ == Phase::printing && !status_outstanding_) {
        consider(status_due_);
    }
    return wake;
}

} // namespace linefeed::feeder
