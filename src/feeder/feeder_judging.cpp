// The truth about the records that were issued, by the earlier run before a start and by this one behind its stop. What
// lies in the FIFO of a printer that stands can still be printed, by a key at its panel. So the printer is looked at
// twice: what is surely printed goes to the ledger, then the FIFO is flushed, and only what is seen behind the flush
// says which records are not printed. Nothing is flushed before the ledger knows all that the flush could wipe out.
#include "feeder/feeder.hpp"
#include "feeder/mailing_error.hpp"

#include <algorithm>

namespace linefeed::feeder {

using protocol::MachineState;
using protocol::Parameter;

/// Before the grant it is about the earlier run, after it about this one.
OpenRun Feeder::open_run() const {
    if (!has_granted_records()) {
        return *plan_.open;
    }
    const RecordRange range = refill_.range();
    return {.first = range.first(),
            .printed_through = confirmed_through_,
            .issued_through = refill_.sent_through(),
            .serial_number = facts_.version ? facts_.version->serial_number : std::string{},
            .total_before = total_before_,
            .last_printed_before = left_over_,
            .last = marker_sent_ ? std::optional{range.last()} : std::nullopt,
            .unclear = restarted_ || nobody_knows_};
}

Evidence Feeder::evidence() const {
    if (!has_granted_records()) {
        return with_certain_place({.mail = mail_, .printer = facts_, .broken_off = broken_off_}, *plan_.open);
    }
    // Another client may have set a stop point before the end: then the number contradicts the message.
    const bool at_the_end = mail_.last_printed == refill_.range().last() || mail_.last_printed == RecordNumber{};
    const Evidence seen{
        .mail = mail_,
        .printer = facts_,
        .end_message = is_error(status_.error, protocol::error_code::last_record_printed) && at_the_end &&
                       stop_would_show() && refill_.all_sent() && !restarted_ && !follows(),
        .uninterrupted = !memory_lost_,
        .restarted = restarted_,
        .restart_unseen = counter_proof_.doubted(),
        .fed_by_another = fed_by_another_ || is_error(status_.error, protocol::error_code::buffer_full) ||
                          (!total_before_ && breaks_numbers(status_.error)), // a counter would tell
        .broken_off = broken_off_};
    return with_certain_place(seen, open_run());
}

/// A record that is unproven is not surely printed: a product may carry a damaged text.
Verdict Feeder::verdict_on(const OpenRun& run, const Evidence& seen) const {
    Verdict verdict = reconcile(run, seen);
    if (unproven_ && verdict.printed.contains(*unproven_)) {
        const RecordNumber last = verdict.in_doubt.empty() ? verdict.printed.last() : verdict.in_doubt.last();
        verdict.in_doubt = RecordRange::closed(*unproven_, last);
        verdict.printed = verdict.printed.first() == *unproven_
                              ? RecordRange{}
                              : RecordRange::closed(verdict.printed.first(), unproven_->previous());
    }
    return verdict;
}

/// The printer stands and has been asked. Final when nothing of the run can be in its FIFO.
void Feeder::judge(Instant now, Actions& out) {
    if (has_granted_records()) {
        cause_ = cause_of_stop();
    }
    const Evidence seen = evidence();
    const OpenRun run = open_run();
    const Verdict verdict = verdict_on(run, seen);
    const bool all_printed = verdict.in_doubt.empty() && verdict.unused.empty();
    if (all_printed || is_another_printer(run, facts_)) {
        settle(verdict, seen, now, out);
    } else {
        record_printed(verdict, seen, now, out);
    }
}

void Feeder::record_printed(const Verdict& verdict, const Evidence& seen, Instant now, Actions& out) {
    first_look_ = seen;
    if (verdict.basis == Basis::none) {
        (has_granted_records() ? nobody_knows_ : plan_.open->unclear) = true;
    }
    const RecordNumber confirmed = confirmed_through_;
    if (!verdict.printed.empty()) {
        (has_granted_records() ? confirmed_through_ : plan_.open->printed_through) = verdict.printed.last();
    }
    enter(Phase::recording, now, settings_.stop_timeout);
    const Verdict surely{.printed = verdict.printed, .basis = verdict.basis};
    out.push_back(Settle{surely, as_said(seen), !has_granted_records(), true, confirmed});
    ++settles_pending_;
}

void Feeder::on_settled(Instant now, Actions& out) {
    --settles_pending_;
    if (phase_ == Phase::recording && settles_pending_ == 0) {
        clear(now, out);
    }
}

/// Started meanwhile, a printer whose FIFO is flushed prints its last record again and again if that has number 0
/// (protocol, section 5, the numbering law): such a one is stopped first.
void Feeder::clear(Instant now, Actions& out) {
    const OpenRun run = open_run();
    enter(Phase::clearing, now, settings_.flush_timeout);
    if (numbering_.has_zero(run.printed_through, run.issued_through)) {
        out.push_back(Command{protocol::Action::stop_print});
    }
    out.push_back(Command{protocol::Action::flush_fifo});
    ask(Parameter::RS, now, out);
}

/// Behind the flush nothing more of the run can be printed, unless the printer was started before it.
void Feeder::clearing_status(Instant now, Actions& out) {
    if (status_.machine != MachineState::printing) {
        ask(Parameter::SM, now, out);
    } else if (has_granted_records()) {
        restarted_ = true;
        send_stop(now, out);
    } else {
        locate_again(now, out);
    }
}

void Feeder::judge_finally(Instant now, Actions& out) {
    Evidence seen = evidence();
    if (!seen.printer.total_prints) { // not answered this time: it has not gone back since
        seen.printer.total_prints = first_look_.printer.total_prints;
    }
    const bool number_forgotten =
        seen.mail.last_printed == RecordNumber{} && seen.printer.total_prints == first_look_.printer.total_prints;
    if (number_forgotten) {
        seen.mail = first_look_.mail;
    }
    // Started between the looks, with an empty FIFO but for what had arrived since the stop.
    seen.restarted = seen.restarted || seen.mail.last_printed != first_look_.mail.last_printed;
    settle(verdict_on(open_run(), seen), seen, now, out);
}

/// The final verdict goes to the ledger, and the run ends or begins.
void Feeder::settle(const Verdict& verdict, const Evidence& seen, Instant now, Actions& out) {
    out.push_back(Settle{verdict, as_said(seen), !has_granted_records(), false, confirmed_through_});
    ++settles_pending_;
    if (!has_granted_records()) {
        plan_.open.reset();
        numbering_ = {};
        mail_ = said_;
        if (verdict.in_doubt.empty() || !plan_.doubt_blocks) {
            check_ready(now, out);
        } else {
            end(OutcomeCode::records_in_doubt, out);
        }
        return;
    }
    const RecordNumber printed = verdict.printed.empty() ? confirmed_through_ : verdict.printed.last();
    if (verdict.in_doubt.empty() && stops_by_itself_at(printed)) {
        finish(now, out);
    } else {
        end(*cause_, out);
    }
}

} // namespace linefeed::feeder
