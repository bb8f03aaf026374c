// The feeder while the printer prints: takes its reports, refills the FIFO, and keeps an eye on the stop point, whose
// vanishing is the first sign of a stop: the printer forgets it together with the records in its FIFO (protocol,
// section 5).
#include "feeder/feeder.hpp"
#include "feeder/mailing_error.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::feeder {

using protocol::MachineState;
using protocol::Parameter;

namespace {

/// How often `=CM` is sent while it prints before the printer counts as one that ignores it.
constexpr int max_stop_point_tries = 3;
/// How long a printer may take to stop behind the stop point, or to report that it has stopped.
constexpr Duration stop_patience = std::chrono::milliseconds{500};

} // namespace

void Feeder::plan_status(Instant now) {
    status_due_ = now + (stop_would_show() ? settings_.status_interval
                                           : std::min(settings_.status_interval, settings_.unguarded_status_interval));
}

void Feeder::print_status(Instant now, Actions& out) {
    plan_status(now);
    if (status_.machine != MachineState::printing) {
        begin_judging(now, out);
        return;
    }
    if (suspected_since_) {
        stop_suspected(now, out);
    }
    if (phase_ == Phase::printing && missing_ > 1 && mail_.entries == 0) {
        begin_stop(OutcomeCode::stopped_at_printer, now, out); // nothing of it is left for the next product
        return;
    }
    if (phase_ == Phase::printing && is_error(status_.error, protocol::error_code::buffer_full)) {
        fed_by_another_ = true;
        begin_stop(OutcomeCode::impossible_report, now, out); // by our credit there was room
        return;
    }
    if (phase_ == Phase::printing) {
        print_error(now, out);
    }
}

/// Each error once, until another comes or it was acknowledged. What mailing raises is never acknowledged while records
/// are under way: it tells what has become of them.
void Feeder::print_error(Instant now, Actions& out) {
    if (status_.error.none() && acknowledged_ != 0) {
        error_noticed_ = acknowledged_ = 0; // it may come again
    }
    if (status_.error.none() || status_.error.raw == error_noticed_) {
        return;
    }
    error_noticed_ = status_.error.raw;
    if (is_allowed(status_.error) && !is_mailing_error(status_.error)) {
        acknowledged_ = status_.error.raw;
        out.push_back(Notice{NoticeCode::error_acknowledged, status_.error});
        out.push_back(Command{protocol::Action::acknowledge_errors});
    } else if (stops(status_.error)) {
        begin_stop(OutcomeCode::printer_error, now, out);
    } else {
        out.push_back(Notice{NoticeCode::printer_warning, status_.error});
    }
}

void Feeder::print_mail(Instant now, Actions& out) {
    if (!stop_point_vanished(now, out) && follow(now, out)) {
        look_for_follower(now, out);
        if (reported_through_ == refill_.range().last()) {
            all_printed(now, out);
        }
    }
    if (phase_ == Phase::printing) {
        poll_on(now);
    }
}

/// Takes the report and refills. False if the line is being stopped because of it.
bool Feeder::follow(Instant now, Actions& out) {
    if (!take_report(now, out)) {
        return false;
    }
    pacing_.printed(refill_.printed_through() - refill_.range().first().previous(), now);
    watch_for_missing(now, out);
    if (phase_ == Phase::printing) {
        stop_move_ == StopMove::none ? insist_on_stop_point(out) : follow_stop_point(now, out);
    }
    if (phase_ == Phase::stopping) {
        return false; // the FIFO was lost
    }
    refill_now(out);
    watch_supply(out);
    ask_for_proof(now, out);
    return true;
}

void Feeder::poll_on(Instant now) {
    // Nothing waits for room once all is sent: only a printer without stop point must be caught quickly then.
    const Duration least = refill_.all_sent() && stop_would_show() ? settings_.retry_interval : Duration{0};
    mail_due_ = std::max(now, std::min(mail_due_, now + pacing_.poll_interval(refill_.level()))) + least;
}

/// The printer cannot have more in its FIFO behind the reported number than was sent, and the number does not go back.
/// If it seems so, a serial line has lost a byte of the answer; or it is true, and the next answer says the same.
Feeder::Report Feeder::judge_report() {
    const std::uint64_t waiting = mail_.entries == 0 ? 0 : mail_.entries + std::uint64_t{1};
    const std::uint64_t held = mail_.last_printed.value() + waiting;
    const std::uint64_t sent = refill_.sent_through().value() + (marker_sent_ ? std::uint64_t{1} : 0);
    const std::uint64_t excess = held - std::min(held, sent);
    const bool odd =
        excess > 0 || mail_.last_printed < refill_.printed_through() || (follows() && is_first_behind_boundary());
    const bool repeated = odd_excess_ == excess;
    odd_excess_ = odd ? std::optional{excess} : std::nullopt;
    if (!odd || (repeated && excess <= excess_of_fill_)) {
        return Report::fits;
    }
    return repeated ? Report::impossible : Report::damaged;
}

/// Takes the printed number from `mail_`. False if it cannot be right: then the line is being stopped.
bool Feeder::take_report(Instant now, Actions& out) {
    const bool none_yet = refill_.printed_through() < refill_.range().first();
    const bool left_over = !left_over_passed_ && mail_.last_printed == left_over_;
    if (left_over || (none_yet && mail_.last_printed == RecordNumber{})) {
        odd_excess_.reset();
        return true; // the number was there before this run
    }
    const Report report = judge_report();
    if (report == Report::damaged) {
        return true;
    }
    if (report == Report::impossible) {
        fed_by_another_ = true;
        begin_stop(OutcomeCode::impossible_report, now, out); // there is a record of somebody else in the FIFO
        return false;
    }
    left_over_passed_ = true;
    const bool behind_last = marker_sent_ && mail_.last_printed == refill_.range().last().next();
    const RecordNumber printed = behind_last ? refill_.range().last() : mail_.last_printed;
    if (!refill_.printed(printed)) {
        memory_lost_ = printed < refill_.printed_through();
        fed_by_another_ = !memory_lost_ || printed != RecordNumber{};
        begin_stop(memory_lost_ ? OutcomeCode::printer_restarted : OutcomeCode::impossible_report, now, out);
        return false;
    }
    const bool finished = mail_.last_print_finished || behind_last;
    if (pacing_.leaps(refill_.printed_through() - refill_.range().first().previous(), now)) {
        doubt_number(); // another client may have flushed the FIFO: no stop point shows that
    }
    const bool skipped = may_have_skipped();
    note_chain();
    if (skipped) {
        doubt_number();
    }
    const RecordNumber said = finished ? printed : printed.previous();
    // Without a counter to bear it out, one damaged answer must not prove anything.
    reported_through_ = std::max(reported_through_, total_before_ ? said : std::min(said, said_before_));
    said_before_ = said;
    confirm_reported(out);
    if (skipped && !total_before_) {
        restarted_ = true; // and so no number counts
        begin_stop(OutcomeCode::stopped_at_printer, now, out);
        return false;
    }
    return true;
}

/// Where the stop point would show a stop, the number proves all records up to it; elsewhere, and behind a leap, the
/// counter has to.
void Feeder::confirm_reported(Actions& out) {
    if (!stop_would_show()) {
        doubt_number();
    }
    const bool proven = counter_proof_.reported(prints_through(mail_.last_printed));
    if (proven || !counter_proof_.doubted() || !total_before_) {
        confirm(reported_through_, out);
    }
}

/// The number that stood there before this run may be that of a record which is printed once more.
RecordNumber Feeder::printed_at_most() const {
    const bool unclear = !left_over_passed_ && mail_.last_printed == left_over_;
    const RecordNumber left_over = unclear ? std::min(left_over_, refill_.sent_through()) : RecordNumber{};
    return std::max(left_over, refill_.printed_through());
}

/// Behind an empty FIFO any number may follow (protocol, section 5): when the printer has printed all that it was seen
/// to hold, and more, a record between may have been lost on its way, and skipped.
bool Feeder::may_have_skipped() const {
    return refill_.printed_through().value() > chained_through_ + 1;
}

void Feeder::note_chain() {
    const std::uint64_t loaded = mail_.entries == 0 ? 0 : 1 - excess_of_fill_; // with 0 entries there may be none
    const std::uint64_t held = refill_.printed_through().value() + mail_.entries + loaded;
    chained_through_ = std::max(chained_through_, std::min<std::uint64_t>(held, refill_.sent_through().value()));
}

/// Fewer records are in the printer than it surely received: a serial line has lost some, or another client has flushed
/// the FIFO. The counter will tell whether it prints on behind them; without one it must not come so far. When nothing
/// is left, print_status() sees to it.
void Feeder::watch_for_missing(Instant now, Actions& out) {
    const std::uint64_t held = printed_at_most().value() + mail_.entries + std::uint64_t{1};
    held_through_ = std::min<std::uint64_t>(held, refill_.sent_through().value() + (marker_sent_ ? 1 : 0));
    missing_ = held < surely_received_.value() ? missing_ + 1 : 0;
    const std::uint64_t held_at_least = refill_.printed_through().value() + mail_.entries + std::uint64_t{1};
    if (held_at_least < surely_received_.value()) {
        doubt_number();
    }
    if (!total_before_ && missing_ > 1) { // once: it may be a damaged answer
        begin_stop(OutcomeCode::stopped_at_printer, now, out);
    }
}

void Feeder::doubt_number() {
    counter_proof_.doubt(prints_through(refill_.sent_through()));
}

void Feeder::ask_for_proof(Instant now, Actions& out) {
    const bool wanted = reported_through_ > confirmed_through_ && counter_proof_.wants_count(now);
    if (wanted && counters_outstanding_ == 0 && mail_outstanding_ <= max_mail_before_proof) {
        ask(Parameter::CC, now, out);
        ask(Parameter::SM, now, out);
        ask(Parameter::SM, now, out);
    }
}

bool Feeder::stop_would_show() const {
    return stop_point_ == StopPoint::kept || stop_point_ == StopPoint::kept_idle;
}

std::uint64_t Feeder::prints_through(RecordNumber number) const {
    const RecordNumber first = refill_.range().first();
    return number < first ? 0 : (number - first).value() + 1;
}

void Feeder::confirm(RecordNumber through, Actions& out) {
    if (through > confirmed_through_) {
        confirmed_through_ = through;
        out.push_back(ConfirmPrinted{through, said_});
    }
}

void Feeder::print_counters(std::uint32_t total, Instant now, Actions& out) {
    std::optional<std::uint32_t> prints;
    if (total_before_) {
        prints = total - *total_before_;
    }
    const std::uint64_t sent = prints_through(refill_.sent_through()) + (marker_sent_ ? 1 : 0);
    counter_moves_ = moves_with_prints(prints, sent);
    if (!counter_proof_.doubted()) {
        return;
    }
    switch (counter_proof_.counted(prints, prints_through(reported_through_), sent, stop_would_show(), now)) {
    case CounterProof::Result::consistent:
        return;
    case CounterProof::Result::no_counter:
        confirm(reported_through_, out);
        return;
    case CounterProof::Result::behind:
        restarted_ = true;
        begin_stop(OutcomeCode::stopped_at_printer, now, out);
        return;
    }
}

/// A stop point that stood and stands no more: the printer has stopped, or its firmware drops the stop point at the
/// start. `?RS` tells which. Until then nothing is sent and no number is believed: behind a stop the FIFO is empty, and
/// a refill would let the printer go on behind the records it has thrown away.
bool Feeder::stop_point_vanished(Instant now, Actions& out) {
    if (!stop_would_show()) {
        return false;
    }
    if (stop_point_stands()) {
        stop_point_ = StopPoint::kept;
        suspected_since_.reset();
        restarted_ = false;
        broken_off_ = RecordNumber{};
        return false;
    }
    note_unfinished();
    note_restart();
    if (!suspected_since_) {
        suspected_since_ = now;
        ask(Parameter::RS, now, out);
    }
    return true;
}

/// The stop point has vanished, and the printer says that it prints: it has been started again, or takes its time to
/// stop.
void Feeder::stop_suspected(Instant now, Actions& out) {
    if (stop_point_ == StopPoint::kept_idle && total_before_) { // otherwise nothing else would show that it was a stop
        stop_point_ = StopPoint::unset; // this firmware keeps it only when it is set after the start
        plan_status(now);
        stop_move_ = StopMove::none;
        old_stop_point_.reset();
        suspected_since_.reset();
        broken_off_ = RecordNumber{};
        return;
    }
    restarted_ = !stops_by_itself_at(mail_.last_printed);
    if (now - *suspected_since_ < stop_patience) {
        ask_later(Parameter::RS, now);
    } else {
        begin_stop(mail_.stop_at == RecordNumber{} ? OutcomeCode::stopped_at_printer : OutcomeCode::impossible_report,
                   now, out);
    }
}

/// Firmware that did not keep the stop point before the start gets it again while it prints, and is left alone when
/// that does not help.
void Feeder::insist_on_stop_point(Actions& out) {
    if (stop_point_ != StopPoint::unset) {
        return;
    }
    if (mail_.stop_at == stop_number_) {
        stop_point_ = StopPoint::kept;
        return;
    }
    if (old_answers_left_ > 0) {
        --old_answers_left_;
        return;
    }
    if (stop_point_tries_ < max_stop_point_tries) {
        set_stop_point_again(out);
        return;
    }
    stop_point_ = StopPoint::ignored;
    out.push_back(Notice{NoticeCode::stop_point_ignored, {}});
}

void Feeder::set_stop_point_again(Actions& out) {
    ++stop_point_tries_;
    out.push_back(SetStopAt{stop_number_});
    await_new_answers();
}

void Feeder::refill_now(Actions& out) {
    if (refill_waits()) {
        return;
    }
    if (const auto intent = refill_.next_intent()) {
        out.push_back(AskIntent{*intent});
    }
    const RecordCount most =
        phase_ == Phase::verifying ? settings_.fill_at_most : without_lone_zero(settings_.refill_at_most);
    const bool rest = refill_.sent_through() + refill_.ready() == refill_.range().last();
    if (rest || Pacing::worth_sending(refill_.ready(), refill_.level(), refill_.depth())) {
        if (const RecordRange range = refill_.take(most); !range.empty()) {
            send(range, out);
        }
    }
    const bool room = refill_.level() < refill_.depth();
    if (stop_point_ == StopPoint::ignored && refill_.all_sent() && !marker_sent_ && room &&
        numbering_.number_of(refill_.range().last()) < RecordNumber::max()) {
        marker_sent_ = true;
        out.push_back(SendEndMarker{numbering_.number_of(refill_.range().last()).next()});
    }
}

/// Those of two jobs apart.
void Feeder::send(RecordRange records, Actions& out) {
    any_sent_ = true;
    if (follows() && records.contains(boundary_) && boundary_ < records.last()) {
        out.push_back(SendRecords{RecordRange::closed(records.first(), boundary_)});
        records = RecordRange::closed(boundary_.next(), records.last());
    }
    out.push_back(SendRecords{records});
}

/// A printer that keeps the stop point stops by itself; any other is stopped, and so is one that takes too long.
void Feeder::all_printed(Instant now, Actions& out) {
    if (!all_printed_at_) {
        all_printed_at_ = now;
    }
    if (stop_point_ != StopPoint::kept || old_stop_point_ || now - *all_printed_at_ > stop_patience) {
        send_stop(now, out);
    } else if (!status_outstanding_) {
        ask(Parameter::RS, now, out);
    }
}

} // namespace linefeed::feeder
